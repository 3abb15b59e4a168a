//! Files of triangles, rays and hits, by which tracers are compared on the same work. All numbers are little-endian.
//!
//! - Triangles: `TRIS`, then u32 version 1, vertices V, triangles T; V × 3 f32 positions; T × 3 u32 indices.
//! - Rays: `RAYS`, then u32 version 1, rays N, kind (0 closest hit, 1 any hit), width, height, rays a pixel P, 0; N × 8 f32
//!   (origin, t_min, direction, t_max); N × u32 tag = (y · width + x) · P + number of the ray in its pixel.
//! - Hits: `HITS`, then u32 version 1, rays N; N × f32 distance; N × u32 triangle, 2³² − 1 for none. A missed ray has its
//!   t_max as the distance. Where any hit was asked for, a blocked ray has the distance −∞ and the triangle 0.

mod batch;
mod hits;
mod triangles;
mod words;

pub use batch::{read_batch, write_batch};
pub use hits::{Agreement, Hits};
pub use triangles::{read_triangles, write_triangles};
