//! The narrow boundary between the method and whoever traces its rays: whole batches in, hits out.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use crate::sampling::{pcg, unit_float};

/// A ray segment from `origin` along the unit vector `direction`, for parameters t in (0, `t_max`].
///
/// `t_min` is always 0: origins are moved off their surface by [`RayOffset`](crate::offset::RayOffset)
/// (spec §5), since a positive `t_min` leaks light under sheets that touch the floor.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Ray {
    /// Start of the ray, world space, scene units.
    pub origin: Vec3,
    /// End of the segment, in scene units along `direction`; may be infinite.
    pub t_max: f32,
    /// Unit direction, world space. Chords use it too: their length is in `t_max`.
    pub direction: Vec3,
    /// Randomness for stochastic transparency: the low 4 bits are a stratum, the rest a hash.
    /// See [`alpha_threshold`].
    pub seed: u32,
}

/// Closest intersection of a [`Ray`] with the scene.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Hit {
    /// Distance along the ray, scene units; infinite on a miss.
    pub t: f32,
    /// Barycentric weight of the triangle's second vertex.
    pub u: f32,
    /// Barycentric weight of the triangle's third vertex.
    pub v: f32,
    /// Index of the instance in the scene, [`Hit::NONE`] on a miss.
    pub instance: u32,
    /// Index of the triangle in the instance's mesh.
    pub triangle: u32,
}

impl Hit {
    /// Instance index of a miss.
    pub const NONE: u32 = u32::MAX;
    /// The ray left the scene or reached `t_max`.
    pub const MISS: Self = Self { t: f32::INFINITY, u: 0.0, v: 0.0, instance: Self::NONE, triangle: 0 };

    /// Whether anything was hit.
    #[must_use]
    pub const fn is_hit(&self) -> bool {
        self.instance != Self::NONE
    }
}

/// Whoever traces rays: a CPU tracer, a GPU, or a brute-force loop in a test.
///
/// Both calls must be pure functions of the ray and the scene: the answer for one ray never depends on its
/// neighbours in the batch. Among hits at equal `t` the one with the smallest (instance, triangle) wins, so that
/// every tracer returns the same hit. All triangles are two-sided; alpha masks are tested on every candidate.
pub trait Trace: Sync {
    /// Writes the closest hit of `rays[i]` to `hits[i]`. The slices have equal length.
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit]);
    /// Writes to `blocked[i]` whether `rays[i]` hits anything. The slices have equal length.
    fn any_hits(&self, rays: &[Ray], blocked: &mut [bool]);
}

/// Threshold in `[0, 1)` against which a blended `triangle` of `instance` compares its alpha for a ray with this
/// `seed`: the candidate counts as a hit if `alpha > threshold`.
///
/// The stratum in the low 4 bits of the seed makes 16 neighbouring pixels cover `[0, 1)` evenly on a triangle; the
/// rotation by a hash of the rest and of the triangle makes layers independent of each other, also the two walls of one
/// bottle, so transmittance is right on average.
#[must_use]
pub fn alpha_threshold(seed: u32, instance: u32, triangle: u32) -> f32 {
    let stratum = ((seed & 15) as f32 + 0.5) / 16.0;
    let layer = pcg(pcg(pcg(seed >> 4) ^ instance) ^ triangle);
    (stratum + unit_float(layer)).fract()
}

/// Diffuse surface at the end of a ray: what the radiance of a hit depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diffuse {
    /// Position from barycentric coordinates, world space.
    pub position: Vec3,
    /// Unit geometric normal on the side that the ray came from.
    pub geometric_normal: Vec3,
    /// Reach of the triangle (see [`RayOffset::apply`](crate::offset::RayOffset::apply)), scene units.
    pub reach: f32,
    /// Albedo a, linear RGB in `[0, 1]`.
    pub albedo: Vec3,
}

/// Whether animations move an instance. Acceleration structures never mix what moves with what does not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Motion {
    /// Nothing moves it.
    #[default]
    Static,
    /// It moves, turns or scales as a whole.
    Rigid,
    /// Its vertices move against each other: by joints or morph weights.
    Deforming,
}

/// The scene as the method sees it: rays go in, hits and the surfaces there come out.
pub trait World: Trace {
    /// Whether instance `instance` can move; [`Hit::NONE`] cannot.
    fn motion(&self, instance: u32) -> Motion;
    /// Surface at the `hit` of `ray`, averaged over a footprint of `width` scene units where textures allow.
    fn diffuse_at(&self, ray: &Ray, hit: &Hit, width: f32) -> Diffuse;
    /// Albedos at the `hits` of `rays`, each averaged over a footprint of `cone` times its distance; zero for misses. The
    /// slices have equal length.
    #[inline]
    fn albedos_at(&self, rays: &[Ray], hits: &[Hit], cone: f32, albedos: &mut [Vec3]) {
        for ((ray, hit), albedo) in rays.iter().zip(hits).zip(albedos) {
            let is_hit = hit.is_hit();
            *albedo = if is_hit { self.diffuse_at(ray, hit, hit.t * cone).albedo } else { Vec3::ZERO };
        }
    }
}
