//! Shared by the tests: scenes, rays, and a loop over all triangles as reference.
#![allow(dead_code, reason = "each test file uses its part")]
#![allow(unreachable_pub, reason = "test files are crates of their own")]

use ambray_core::trace::{Hit, Ray, Trace};
use ambray_cpu::AlphaTest;
use ambray_scene::{Instance, Mesh, Motion, Scene};
use glam::{Affine3A, DVec3, Vec3};

/// Random numbers by PCG, so that tests are the same everywhere.
pub struct Random(pub u32);

impl Random {
    pub fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9);
        ambray_core::sampling::pcg(self.0)
    }
    pub fn below(&mut self, n: u32) -> u32 {
        ((u64::from(self.bits()) * u64::from(n)) >> 32) as u32
    }
    pub fn unit(&mut self) -> f32 {
        ambray_core::sampling::unit_float(self.bits())
    }
    /// In [-1, 1)³.
    pub fn cube(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
    }
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let p = self.cube();
            if (1e-3..=1.0).contains(&p.length_squared()) {
                return p.normalize();
            }
        }
    }
}

/// Triangles of many shapes in [-1, 1]³.
pub fn random_triangles(random: &mut Random, count: usize) -> Vec<[Vec3; 3]> {
    let mut triangles: Vec<[Vec3; 3]> = Vec::new();
    while triangles.len() < count {
        let (p, q, r) = (random.cube(), random.cube(), random.cube());
        let axis = random.below(3) as usize;
        triangles.push(match random.below(10) {
            0..=3 => [p, p + q * 0.2, p + r * 0.2],
            4 => [p, q, r],
            5 => [p, p + q, p + q + r * 1e-5], // needle
            6 => {
                let flat = |mut v: Vec3| {
                    v[axis] = p[axis];
                    v
                };
                [p, flat(q), flat(r)]
            }
            7 => [p, q, p + (q - p) * 0.5], // collinear, or nearly so
            8 => [p, p, q],
            _ => triangles.get(random.below(count as u32) as usize).copied().unwrap_or([p, q, r]),
        });
    }
    triangles
}

/// Rays of many kinds about the triangles, in packets of 16 and alone.
pub fn random_rays(random: &mut Random, triangles: &[[Vec3; 3]], count: usize) -> Vec<Ray> {
    let mut rays = Vec::new();
    let on_triangle = |random: &mut Random| {
        let [a, b, c] = triangles[random.below(triangles.len() as u32) as usize];
        let (mut u, mut v) = (random.unit(), random.unit());
        match random.below(4) {
            0 => (u, v) = (0.0, 0.0),
            1 => v = 0.0,
            _ => {}
        }
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        a + (b - a) * u + (c - a) * v
    };
    let kinds = 6;
    for kind in 0..kinds * count / 16 {
        let shared = match random.below(3) {
            0 => random.direction(),
            1 => {
                let mut d = Vec3::ZERO;
                d[random.below(3) as usize] = if random.below(2) == 0 { 1.0 } else { -1.0 };
                d
            }
            _ => {
                let mut d = random.direction();
                d[random.below(3) as usize] = if random.below(2) == 0 { 0.0 } else { -0.0 };
                d.normalize_or(Vec3::X)
            }
        };
        let start = random.cube();
        for _ in 0..16 {
            let t_max = [0.1, 1.0, f32::INFINITY][random.below(3) as usize];
            let (origin, direction) = match kind % kinds {
                0 => (random.cube() * 1.5, random.direction()),
                1 => (random.cube() * 1.5, shared),
                2 => (start + random.cube() * 0.05, shared),
                3 => (on_triangle(random), random.direction()), // starts on a surface
                4 => {
                    let origin = random.cube() * 2.0;
                    (origin, (on_triangle(random) - origin).normalize_or(Vec3::Y)) // corners and edges
                }
                _ => {
                    let [a, b, _] = triangles[random.below(triangles.len() as u32) as usize];
                    (a - (b - a), (b - a).normalize_or(Vec3::Z)) // along an edge
                }
            };
            rays.push(Ray { origin, t_max, direction, seed: random.bits() });
        }
    }
    rays
}

/// Scene of meshes with one instance each, untransformed.
pub fn scene(meshes: Vec<Mesh>) -> Scene {
    let instances = (0..meshes.len() as u32)
        .map(|mesh| Instance { mesh, world_from_object: Affine3A::IDENTITY, ..Instance::default() })
        .collect();
    let meshes = meshes.into_iter().map(Into::into).collect();
    Scene { meshes, instances, materials: vec![ambray_scene::Material::default()], ..Scene::default() }
}

/// Mesh of separate triangles.
pub fn soup(triangles: &[[Vec3; 3]]) -> Mesh {
    Mesh {
        positions: triangles.iter().flatten().copied().collect(),
        triangles: (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        ..Mesh::default()
    }
}

/// The tracer's definition of a hit, in scalar arithmetic and without a tree.
pub struct BruteForce<A> {
    /// Triangles in the space in which they are tested.
    triangles: Vec<([Vec3; 3], u32, bool)>,
    groups: Vec<Group>,
    alpha: A,
}

/// Whether rays go to the space of an instance: its mesh has several that do not move, or it moves itself.
fn in_object_space(scene: &Scene, instance: &Instance) -> bool {
    let motion = |instance: &Instance| scene.rig.as_ref().map_or(Motion::Static, |_| instance.motion);
    let of_mesh = || scene.instances.iter().filter(|other| other.mesh == instance.mesh);
    motion(instance) != Motion::Static
        || of_mesh().any(|other| motion(other) == Motion::Deforming)
        || of_mesh().filter(|other| motion(other) == Motion::Static).count() > 1
}

/// Triangles of an instance.
struct Group {
    range: std::ops::Range<usize>,
    instance: u32,
    placed: Option<(Affine3A, [f32; 6])>,
}

impl<A: AlphaTest> BruteForce<A> {
    pub fn new(scene: &Scene, alpha: A) -> Self {
        let mut out = Self { triangles: Vec::new(), groups: Vec::new(), alpha };
        for (index, instance) in (0_u32..).zip(&scene.instances) {
            let to_tree = if in_object_space(scene, instance) {
                Affine3A::IDENTITY
            } else {
                instance.world_from_object
            };
            let mesh = &scene.meshes[instance.mesh as usize];
            let start = out.triangles.len();
            let mut planes = [
                f32::INFINITY,
                f32::INFINITY,
                f32::INFINITY,
                f32::NEG_INFINITY,
                f32::NEG_INFINITY,
                f32::NEG_INFINITY,
            ];
            for t in 0..mesh.triangles.len() as u32 {
                let corners = mesh.corners(t).map(|p| to_tree.transform_point3(p));
                let [a, b, c] = corners.map(|p| p.as_dvec3());
                if (b - a).cross(c - a) == glam::DVec3::ZERO
                    || !corners.iter().all(|p| p.abs().max_element() <= 1e12)
                {
                    continue;
                }
                out.triangles.push((corners, t, !out.alpha.is_opaque(instance.mesh)));
                planes = union(planes, bounds(&corners));
            }
            let placed = in_object_space(scene, instance).then(|| {
                let corners: [Vec3; 8] = std::array::from_fn(|i| {
                    instance.world_from_object.transform_point3(Vec3::new(
                        planes[3 * (i & 1)],
                        planes[1 + 3 * (i >> 1 & 1)],
                        planes[2 + 3 * (i >> 2)],
                    ))
                });
                let tight = bounds(&corners);
                let (lo, hi) = (Vec3::from_slice(&tight[..3]), Vec3::from_slice(&tight[3..]));
                let reach = lo.abs().max(hi.abs()).max_element() + (hi - lo).max_element();
                let (lo, hi) = (lo - reach / 131_072.0, hi + reach / 131_072.0);
                (instance.world_from_object.inverse(), [lo.x, lo.y, lo.z, hi.x, hi.y, hi.z])
            });
            let range = start..out.triangles.len();
            if !range.is_empty() {
                out.groups.push(Group { range, instance: index, placed });
            }
        }
        out
    }

    pub fn closest(&self, ray: &Ray) -> Hit {
        let mut best = Hit { t: ray.t_max, ..Hit::MISS };
        if ray.t_max <= 0.0 || ray.t_max.is_nan() {
            return Hit::MISS;
        }
        for group in &self.groups {
            let mut near = 0.0;
            let (mut origin, mut direction) = (ray.origin, ray.direction);
            if let Some((object_from_world, planes)) = &group.placed {
                match slab(planes, origin, direction) {
                    Some(t) => near = t,
                    None => continue,
                }
                origin = object_from_world.transform_point3(origin);
                direction = object_from_world.transform_vector3(direction);
            }
            if !origin.is_finite() || !direction.is_finite() || direction == Vec3::ZERO {
                continue;
            }
            for &(corners, triangle, masked) in &self.triangles[group.range.clone()] {
                let Some((t, u, v)) = intersect(&corners, origin, direction) else { continue };
                let t = t.max(near);
                let closer =
                    t < best.t || t == best.t && (group.instance, triangle) < (best.instance, best.triangle);
                if closer
                    && t < f32::INFINITY
                    && (!masked || self.alpha.accepts(group.instance, triangle, u, v, ray.seed))
                {
                    best = Hit { t, u, v, instance: group.instance, triangle };
                }
            }
        }
        if best.is_hit() { best } else { Hit::MISS }
    }
}

impl<A: AlphaTest> Trace for BruteForce<A> {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit]) {
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = self.closest(ray);
        }
    }
    fn any_hits(&self, rays: &[Ray], blocked: &mut [bool]) {
        for (ray, blocked) in rays.iter().zip(blocked) {
            *blocked = self.closest(ray).is_hit();
        }
    }
}

fn bounds(points: &[Vec3]) -> [f32; 6] {
    let lo = points.iter().copied().fold(Vec3::INFINITY, Vec3::min);
    let hi = points.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
    [lo.x, lo.y, lo.z, hi.x, hi.y, hi.z]
}

fn union(a: [f32; 6], b: [f32; 6]) -> [f32; 6] {
    std::array::from_fn(|i| if i < 3 { a[i].min(b[i]) } else { a[i].max(b[i]) })
}

/// Near distance of a box.
fn slab(planes: &[f32; 6], origin: Vec3, direction: Vec3) -> Option<f32> {
    let (mut near, mut far) = (0.0_f32, f32::INFINITY);
    for axis in 0..3 {
        // There is no −0, and origin · reciprocal is finite.
        let largest = 8.507_059e37 / origin[axis].abs().max(1.0);
        let reciprocal = (1.0 / (direction[axis] + 0.0)).clamp(-largest, largest);
        let ends = [axis, axis + 3].map(|plane| (planes[plane] - origin[axis]) * reciprocal);
        near = near.max(ends[0].min(ends[1]));
        far = far.min(ends[0].max(ends[1]));
    }
    (near <= far * (1.0 + 32.0 / 16_777_216.0)).then_some(near)
}

/// Coverage by Woop, Benthin and Wald 2013, zeros inside; then the distance of the plane, and the box of the triangle.
fn intersect(corners: &[Vec3; 3], origin: Vec3, direction: Vec3) -> Option<(f32, f32, f32)> {
    let a = direction.abs();
    let z = if a.x >= a.y && a.x >= a.z {
        0
    } else if a.y >= a.z {
        1
    } else {
        2
    };
    let (x, y) = ((z + 1) % 3, (z + 2) % 3);
    let shear = [direction[x] / direction[z], direction[y] / direction[z], 1.0 / direction[z]];
    let [a, b, c] = corners.map(|p| {
        let p = p - origin;
        Vec3::new(p[x] - shear[0] * p[z], p[y] - shear[1] * p[z], p[z])
    });
    let u = c.x * b.y - c.y * b.x;
    let v = a.x * c.y - a.y * c.x;
    let w = b.x * a.y - b.y * a.x;
    if !(u >= 0.0 && v >= 0.0 && w >= 0.0 || u <= 0.0 && v <= 0.0 && w <= 0.0) {
        return None;
    }
    let determinant = u + v + w;
    // Where the plane is met, in double precision.
    let permuted = |p: Vec3| DVec3::new(p[x].into(), p[y].into(), p[z].into());
    let [a, b, c] = corners.map(|p| permuted(p) - permuted(origin));
    let normal = (b - a).cross(c - a);
    let depth = normal.dot(a) / normal.dot(DVec3::new(shear[0].into(), shear[1].into(), 1.0));
    let t = (depth * f64::from(shear[2])) as f32;
    if t <= 0.0 || t.is_nan() || determinant == 0.0 || determinant.is_nan() {
        return None;
    }
    let near = slab(&bounds(corners), origin, direction)?;
    Some((t.max(near), v / determinant, w / determinant))
}
