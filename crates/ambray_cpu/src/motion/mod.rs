//! Trees of meshes that deform, and what becomes of them at each pose.

mod deforming;
mod sample;

pub(crate) use deforming::{Deforming, Fate};
