//! Ambray against the truth and against other methods: experiments, figures and reports.
//!
//! [`truth`] is converged light, [`experiment`] measures subjects against it, [`report`] and [`paper`] make a
//! [`document::Document`] of what was measured, and [`html`] a page of that.
#![forbid(unsafe_code)]

pub mod document;
pub mod experiment;
pub mod html;
pub mod maps;
pub mod output;
pub mod paper;
pub mod pictures;
pub mod report;
pub mod subject;
pub mod truth;
