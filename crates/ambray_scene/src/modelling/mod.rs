//! What the built-in scenes are made with. All of it comes out the same on every machine, bit for bit: arithmetic is scalar,
//! functions are `libm`'s and chance is a hash.

pub(crate) mod builder;
pub(crate) mod camera;
pub(crate) mod column;
pub(crate) mod noise;
pub(crate) mod pose;
pub(crate) mod shapes;
