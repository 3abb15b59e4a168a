//! A sensible radius and a sensible camera for scenes that bring none.

use ambray_core::{
    camera::Projection,
    sampling::{DEFAULT_SEEDS, owen_point, unit_float},
    trace::{Hit, Ray, Trace},
};
use ambray_scene::{Scene, SceneCamera};
use glam::Vec3;

/// Share of the scene's extent that counts as near.
const RADIUS_SHARE: f32 = 0.1;
/// Extents below this share of the largest one do not limit the radius: a plane has no height.
const FLAT_SHARE: f32 = 0.1;
/// Share of the directions from the middle of the scene that must meet the front of a surface for it to be an interior.
const INTERIOR_SHARE: f32 = 0.75;

/// Radius R: a tenth of the smallest extent that is not negligible against the largest; 1 for a single point.
pub(crate) fn radius((low, high): (Vec3, Vec3)) -> f32 {
    let extents = (high - low).to_array();
    let largest = extents.iter().copied().fold(0.0, f32::max);
    let smallest =
        extents.into_iter().filter(|&extent| extent >= FLAT_SHARE * largest).fold(largest, f32::min);
    if smallest > 0.0 { RADIUS_SHARE * smallest } else { 1.0 }
}

/// How a scene without cameras is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Framing {
    /// It surrounds its middle: seen from one end of it.
    Inside {
        /// Position of the camera.
        eye: Vec3,
        /// Point that it looks at.
        target: Vec3,
    },
    /// It is an object: seen from the front, the right and above. Surfaces that turn their backs to the middle are its
    /// skin.
    Outside {
        /// Box around the scene.
        bounds: (Vec3, Vec3),
    },
}

impl Framing {
    /// Looks around within the scene.
    pub(crate) fn of(scene: &Scene, bounds: (Vec3, Vec3), trace: &impl Trace) -> Self {
        match interior(scene, bounds, trace) {
            Some((eye, target)) => Self::Inside { eye, target },
            None => Self::Outside { bounds },
        }
    }

    /// A perspective camera that shows the scene, and a word on how it was found.
    pub(crate) fn camera(&self, fov: f32, aspect: f32) -> (SceneCamera, &'static str) {
        match *self {
            Self::Inside { eye, target } => (looking(eye, target, fov), "inside, along the longest free way"),
            Self::Outside { bounds } => (outside(bounds, fov, aspect), "framed from the bounds"),
        }
    }
}

fn looking(position: Vec3, target: Vec3, vertical_fov: f32) -> SceneCamera {
    let forward = (target - position).try_normalize().unwrap_or(Vec3::NEG_Z);
    let right = forward.cross(Vec3::Y).try_normalize().unwrap_or(Vec3::X);
    let projection = Projection::Perspective { vertical_fov };
    SceneCamera { name: String::new(), position, forward, up: right.cross(forward), projection }
}

/// From the front, the right and above, at the distance from which all corners of the box are in the picture.
fn outside((low, high): (Vec3, Vec3), fov: f32, aspect: f32) -> SceneCamera {
    const MARGIN: f32 = 1.05;
    let middle = 0.5 * (low + high);
    let camera = looking(middle + Vec3::new(0.55, 0.45, 1.0), middle, fov);
    let (forward, up) = (camera.forward, camera.up);
    let right = forward.cross(up);
    let tan = libm::tanf(0.5 * fov) / MARGIN;
    let distance = (0..8).map(|corner| {
        let pick = |bit: u8, low: f32, high: f32| if corner & bit == 0 { low } else { high };
        let offset =
            Vec3::new(pick(1, low.x, high.x), pick(2, low.y, high.y), pick(4, low.z, high.z)) - middle;
        let needed = (offset.dot(up).abs() / tan).max(offset.dot(right).abs() / (tan * aspect));
        needed - offset.dot(forward)
    });
    let distance = distance.fold(f32::MIN_POSITIVE, f32::max);
    SceneCamera { position: middle - distance.max(1e-6) * forward, ..camera }
}

/// Eye and target within a scene that surrounds its middle.
fn interior(scene: &Scene, (low, high): (Vec3, Vec3), trace: &impl Trace) -> Option<(Vec3, Vec3)> {
    const DIRECTIONS: u32 = 256;
    let middle = 0.5 * (low + high);
    let extent = high - low;
    let directions: Vec<Vec3> = (0..DIRECTIONS)
        .map(|i| {
            let [u, v] = owen_point(i, DEFAULT_SEEDS).map(unit_float);
            let (sin, cos) = libm::sincosf(std::f32::consts::TAU * v);
            let y = 1.0 - 2.0 * u;
            let r = (1.0 - y * y).sqrt();
            Vec3::new(r * cos, y, r * sin)
        })
        .collect();
    let hits = closest_hits(trace, middle, &directions);
    // Near blockers mean that the middle lies within a thing, not within a room.
    let clearance = 0.05 * extent.max_element();
    let wall = |(hit, direction): (&Hit, &Vec3)| {
        hit.is_hit() && hit.t > clearance && faces(scene, hit, middle, *direction)
    };
    let around = hits.iter().zip(&directions).filter(|&pair| wall(pair)).count();
    if (around as f32) < INTERIOR_SHARE * DIRECTIONS as f32 {
        return None;
    }
    let along = if extent.x >= extent.z { Vec3::X } else { Vec3::Z };
    let ends = free_ways(trace, middle, &[along, -along, Vec3::NEG_Y]);
    let side = if ends[0] >= ends[1] { along } else { -along };
    let away = ends[0].max(ends[1]).min(extent.max_element());
    // A third of the way up from the floor to the middle: about eye height in a room of two storeys.
    let eye = middle + 0.8 * away * side - Vec3::Y * (2.0 / 3.0 * ends[2].min(extent.y));
    let target = middle - side * away - Vec3::Y * (0.5 * ends[2].min(extent.y));
    let clear = free_ways(trace, eye, &directions).into_iter().fold(f32::INFINITY, f32::min);
    // A blocked end, such as a column in the way, leaves the middle itself.
    Some(if clear > 0.02 * extent.max_element() { (eye, target) } else { (middle, middle - side) })
}

/// Whether what `hit` is on turns its front to a ray: triangles run counter-clockwise there, unless mirrored (glTF 2.0,
/// §3.7.2.1), and the front of a shape is its outer side.
fn faces(scene: &Scene, hit: &Hit, origin: Vec3, direction: Vec3) -> bool {
    if let Some(instance) = scene.shape_instance(hit.instance) {
        let object_from_world = instance.world_from_object.inverse();
        let point = object_from_world.transform_point3(origin + hit.t * direction);
        let normal = scene.shapes[instance.shape as usize].normal(point);
        return normal.dot(object_from_world.transform_vector3(direction)) < 0.0;
    }
    let instance = &scene.instances[hit.instance as usize];
    let world = &instance.world_from_object;
    let [a, b, c] =
        scene.meshes[instance.mesh as usize].corners(hit.triangle).map(|p| world.transform_point3(p));
    (b - a).cross(c - a).dot(direction) * world.matrix3.determinant().signum() < 0.0
}

/// Distance to the first hit from `origin` along each of the unit `directions`.
fn free_ways(trace: &impl Trace, origin: Vec3, directions: &[Vec3]) -> Vec<f32> {
    closest_hits(trace, origin, directions).iter().map(|hit| hit.t).collect()
}

fn closest_hits(trace: &impl Trace, origin: Vec3, directions: &[Vec3]) -> Vec<Hit> {
    let ray = |&direction: &Vec3| Ray { origin, t_max: f32::INFINITY, direction, seed: 0 };
    let rays: Vec<Ray> = directions.iter().map(ray).collect();
    let mut hits = vec![Hit::MISS; rays.len()];
    trace.closest_hits(&rays, &mut hits);
    hits
}

#[cfg(test)]
mod tests {
    use ambray_cpu::{BuildOptions, Opaque, Tracer};
    use ambray_scene::{Instance, Material, Mesh};
    use glam::Affine3A;

    use super::*;

    /// A box of half size 3 around the origin whose front is inside, or outside if it is turned.
    fn room(turned: bool) -> (Scene, Tracer) {
        let corner = |i: u32| Vec3::new(sign(i & 1), sign(i & 2), sign(i & 4)) * 3.0;
        let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
        let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        let triangles = triangles.map(|[a, b, c]| if turned { [a, c, b] } else { [a, b, c] }).collect();
        let mesh = Mesh { positions: (0..8).map(corner).collect(), triangles, ..Mesh::default() };
        let scene = Scene {
            meshes: vec![mesh.into()],
            instances: vec![Instance {
                mesh: 0,
                world_from_object: Affine3A::IDENTITY,
                ..Instance::default()
            }],
            materials: vec![Material::default()],
            ..Scene::default()
        };
        let tracer = Tracer::build(&scene, Opaque, BuildOptions::default());
        (scene, tracer)
    }

    fn sign(bit: u32) -> f32 {
        if bit == 0 { -1.0 } else { 1.0 }
    }

    /// Nothing at all.
    struct Void;

    impl Trace for Void {
        fn closest_hits(&self, _rays: &[Ray], hits: &mut [Hit]) {
            hits.fill(Hit::MISS);
        }

        fn any_hits(&self, _rays: &[Ray], _blocked: &mut [bool]) {}
    }

    const BOX: (Vec3, Vec3) = (Vec3::splat(-3.0), Vec3::splat(3.0));

    #[test]
    fn radius_ignores_flat_sides() {
        assert_eq!(radius((Vec3::ZERO, Vec3::new(20.0, 10.0, 15.0))), 1.0);
        assert_eq!(radius((Vec3::ZERO, Vec3::new(20.0, 0.0, 10.0))), 1.0);
        assert_eq!(radius((Vec3::ONE, Vec3::ONE)), 1.0);
    }

    #[test]
    fn rooms_are_seen_from_within_and_things_from_without() {
        let (scene, tracer) = room(false);
        let (inside, _) = Framing::of(&scene, BOX, &tracer).camera(0.9, 1.5);
        assert!(inside.position.abs().max_element() < 3.0, "{inside:?}");
        let (scene, tracer) = room(true);
        let (outside, _) = Framing::of(&scene, BOX, &tracer).camera(0.9, 1.5);
        assert!(outside.position.max_element() > 3.0, "{outside:?}");
    }

    #[test]
    fn the_whole_box_is_in_the_picture() {
        let (fov, aspect) = (0.9_f32, 1.5_f32);
        for high in [Vec3::splat(3.0), Vec3::new(30.0, 0.0, 1.0), Vec3::new(0.1, 50.0, 0.1)] {
            let (camera, _) = Framing::of(&Scene::default(), (-high, high), &Void).camera(fov, aspect);
            let right = camera.forward.cross(camera.up);
            for i in 0..8 {
                let seen = high * Vec3::new(sign(i & 1), sign(i & 2), sign(i & 4)) - camera.position;
                let reach = seen.dot(camera.forward) * (0.5 * fov).tan();
                assert!(
                    seen.dot(camera.up).abs() <= reach && seen.dot(right).abs() <= reach * aspect,
                    "{high}"
                );
            }
        }
    }
}
