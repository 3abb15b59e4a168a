//! The method of Ambray as pure mathematics: no input or output, no threads, no unsafe code, no GPU.
//!
//! Ambient light at a surface point s with normal n is split into what the far environment sends through the open
//! directions, and what near surfaces send (L. Fridvalszky and B. Tóth, *Real-time ambient lighting with raytracing*):
//!
//! ```text
//! L = emission + a (L_a O + I) + direct light                              compose
//! O = (1/N) Σ μ(d_i)                  openness                             gather, openness
//! I = (1/N) Σ (1 - μ(d_i)) L_r(o_i)   near-field radiance                  gather, direct
//! w_i = cosine-weighted, from 16 interleaved sample sets                   sampling, basis
//! O' = low-pass over one 4 × 4 pattern, stopping at edges                  filter
//! ```
//!
//! Start with [`gather`]: points and sample directions go in, O and I come out. It never learns who traces the rays:
//! that is the trait [`trace::World`]. [`settings`] is what a person sets, [`view`] the same with every `auto`
//! replaced, [`frame`] and [`query`] what comes out, [`display`] how it is shown.
//!
//! `docs/method.md` of the project lists each equation with its function and its test.
#![forbid(unsafe_code)]

pub mod aov;
pub mod basis;
pub mod camera;
pub mod compose;
pub mod control;
pub mod direct;
pub mod display;
pub mod filter;
pub mod frame;
pub mod gather;
pub mod inspect;
pub mod light;
pub mod offset;
pub mod openness;
pub mod query;
pub mod sampling;
pub mod settings;
pub mod shape;
pub mod temporal;
pub mod trace;
pub mod view;
