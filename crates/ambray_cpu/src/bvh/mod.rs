//! Trees: how they are built, collapsed and laid out.

pub(crate) mod build;
mod collapse;
pub(crate) mod layout;
pub(crate) mod refit;
