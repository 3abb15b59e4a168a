//! Animations: what is read, how poses come out, and what is refused.

#[path = "../common/mod.rs"]
mod common;

mod at_rest;
mod by_hand;
mod files;
mod malformed;
mod poses;
mod reference;
