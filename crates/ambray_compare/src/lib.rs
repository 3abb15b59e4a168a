//! Ambray against the truth and against other methods.
#![forbid(unsafe_code)]

pub mod document;
pub mod html;
