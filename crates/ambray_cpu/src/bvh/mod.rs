//! Trees: how they are built, collapsed and laid out.

mod binary;
pub(crate) mod build;
mod collapse;
mod forest;
pub(crate) mod layout;
pub(crate) mod names;
mod ploc;
pub(crate) mod refit;
mod reinsert;
#[cfg(test)]
mod tests;
