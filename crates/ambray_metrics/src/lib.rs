//! Measures of error between maps and between pictures (spec §10).
//!
//! A [`Map`] is one number a pixel; a picture is three maps. The functions are the measures one by one, [`Measures`] all of
//! them for a pair, and [`Measure`] is the list of their names and meanings, from which tables and options are made.
//!
//! | measure | function | source |
//! |---|---|---|
//! | RMSE, PSNR, bias, p99, largest error | [`rmse`], [`psnr`], [`bias`], [`percentile`], [`largest`] | definitions |
//! | FLIP | [`flip`], [`flip_rgb`] | Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images" |
//! | SSIM | [`ssim`] | Wang et al. 2004, "Image Quality Assessment: From Error Visibility to Structural Similarity" |
//! | RMSE at edges and outside | [`edges`], [`masked_rmse`] | spec §10 |
//! | sampling part, filter loss, grain, pattern left | [`rmse`], [`grain`], [`pattern_left`] | spec §10 |
//! | flicker, ghosting of sequences | [`flicker`], [`ghosting`] | spec §12, and defined here |
//!
//! All pixels count, also those that see no surface: their openness is 1 in the estimate and in the truth, as in the numbers
//! of spec §11. Values are held in single precision and summed in double precision. Every function panics if its maps
//! differ in size, and expects finite values: what to do with others only the caller can know.
#![forbid(unsafe_code)]

mod edges;
mod errors;
mod flip;
mod grain;
mod map;
mod measure;
mod measures;
mod pattern;
mod sequence;
mod ssim;

pub use edges::edges;
pub use errors::{bias, changed, largest, masked_rmse, percentile, psnr, psnr_of, rmse};
pub use flip::{PIXELS_PER_DEGREE, flip, flip_map, flip_rgb, flip_rgb_map};
pub use grain::grain;
pub use map::Map;
pub use measure::{Better, Measure};
pub use measures::Measures;
pub use pattern::pattern_left;
pub use sequence::{Ghosting, flicker, flicker_of, ghosting};
pub use ssim::ssim;
