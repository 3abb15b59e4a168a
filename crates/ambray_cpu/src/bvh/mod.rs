//! Trees: how they are built, collapsed and laid out.

pub(crate) mod build;
mod collapse;
pub(crate) mod layout;
mod places;
pub(crate) mod refit;
