//! Scenes: what is there to be lit.
//!
//! A [`Scene`] comes from a file ([`load`](fn@load)) or from code alone ([`atrium`], [`moving`]). It is a scene at one moment; if it can
//! move, its [`Rig`](animation::Rig) says how: see [`animation`].
#![forbid(unsafe_code)]

pub mod animation;
pub mod atrium;
mod decode;
mod error;
mod files;
mod gltf;
mod implicit;
pub mod limits;
mod load;
pub mod material;
pub mod mesh;
mod mip;
mod modelling;
pub mod moving;
mod obj;
mod repair;
pub mod scene;
mod srgb;
pub mod surface;
mod tangents;
pub mod texture;
mod warnings;

pub use ambray_core::trace::Motion;
pub use error::LoadError;
pub use load::{LoadOptions, Loaded, SceneChoice, load, load_with};
pub use material::{AlphaMode, Checker, Material, MaterialKind, TextureRef};
pub use mesh::Mesh;
pub use scene::{Instance, Scene, SceneCamera, ShapeInstance};
pub use texture::{Filter, Image, Sampler, Texture, Wrap};
