//! Single GLSL functions on the device against their twins in Rust, over thousands of arguments each.
//!
//! Integers and what decides sample sets must agree in all bits. So must, on software devices, what is computed by +, −, ×,
//! ÷ and square roots in an order that the shaders keep (`precise`): those round as the standard says, while Vulkan lets
//! hardware be off by 2.5 units of the last place in ÷ and 3 in square roots, and fuse products and sums where the shader
//! allows. Each test says what it tolerates and why.

mod calls;
#[path = "../common/mod.rs"]
mod common;
mod compare;
mod composition;
mod deform;
mod openness;
mod random;
mod sampling;
mod shapes;
mod textures;
mod tone_map;
mod views;
