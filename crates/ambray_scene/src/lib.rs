//! Scenes: what is there to be lit.
#![forbid(unsafe_code)]

pub mod material;
pub mod mesh;
pub mod scene;
pub mod surface;
pub mod texture;

pub use material::{AlphaMode, Material, TextureRef};
pub use mesh::Mesh;
pub use scene::{Instance, Scene, SceneCamera};
pub use texture::{Filter, Image, Sampler, Texture, Wrap};
