//! From a hit to the attributes of the surface there.

mod albedo;
mod alpha;
mod at;

use std::sync::{Arc, OnceLock};

use ambray_core::trace::{Diffuse, Hit, Ray, alpha_threshold};
use glam::{Affine3A, Mat3A, Vec2, Vec3};

use crate::implicit::{ShapeFrame, ShapePoint};
use crate::{AlphaMode, Instance, Material, MaterialKind, Mesh, Motion, Scene, ShapeInstance, TextureRef};

use albedo::Albedos;
use alpha::{Cutout, cutouts};
use at::{At, Face};

/// Answers questions about points on the surfaces of a scene.
///
/// Hits must come from that scene; others panic or answer about another point.
#[derive(Clone, Debug)]
pub struct Surfaces {
    scene: Arc<Scene>,
    /// One an instance of a mesh.
    frames: Vec<Frame>,
    /// One an instance of a shape.
    shape_frames: Vec<ShapeFrame>,
    /// One a mesh: whether all of it is there for all rays.
    opaque: Arc<[bool]>,
    /// One a mesh: how it is seen, where a texture decides that alone.
    cutouts: Arc<[Option<Cutout>]>,
    /// Empty until they are asked for. What does not move has the same albedos at all poses.
    albedos: Arc<OnceLock<Albedos>>,
}

/// What placing an instance does to directions.
#[derive(Clone, Copy, Debug)]
struct Frame {
    /// Turns normals; does not keep their length.
    normal_from_object: Mat3A,
    /// Magnitudes of the placement: bounds the magnitudes that a placed point is computed from.
    magnitude: Affine3A,
    /// -1 where the placement mirrors, which turns the winding of triangles around, else 1.
    side: f32,
}

impl Frame {
    fn new(instance: &Instance) -> Self {
        let m = instance.world_from_object.matrix3;
        let side = if m.determinant() < 0.0 { -1.0 } else { 1.0 };
        let magnitude = Affine3A {
            matrix3: Mat3A::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs()),
            translation: instance.world_from_object.translation.abs(),
        };
        Self { normal_from_object: normal_matrix(m), magnitude, side }
    }
}

fn shape_frames(scene: &Scene) -> Vec<ShapeFrame> {
    let frame = |i: &ShapeInstance| ShapeFrame::new(i, &scene.shapes[i.shape as usize]);
    scene.shape_instances.iter().map(frame).collect()
}

/// A point on a surface as a camera sees it. Positions and directions are in world space, colours linear RGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, interpolated from the triangle's corners; on a shape, the point of the ray moved onto it.
    pub position: Vec3,
    /// Unit normal of the triangle, on the side from which its corners run counter-clockwise before mirroring; of a shape on
    /// its outer side.
    pub geometric_normal: Vec3,
    /// Largest magnitude of the numbers that the point is computed from, those of the triangle's corners or of the whole
    /// shape: what rounding errors follow.
    pub reach: f32,
    /// Unit interpolated vertex normal; the geometric one where there is none.
    pub smooth_normal: Vec3,
    /// The smooth normal bent by the normal map, unit.
    pub shading_normal: Vec3,
    /// Base colour or checker × texture × vertex colour.
    pub albedo: Vec3,
    /// Emitted radiance.
    pub emission: Vec3,
    /// Index into [`Scene::materials`].
    pub material: u32,
    /// Whether the albedo is to be shown without light.
    pub unlit: bool,
}

/// A point on a surface as far as light bouncing off it is concerned; see [`SurfacePoint`] for the fields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffusePoint {
    /// The point.
    pub position: Vec3,
    /// Unit normal of the triangle or shape.
    pub geometric_normal: Vec3,
    /// Largest magnitude of the numbers that the point is computed from.
    pub reach: f32,
    /// Base colour or checker × texture × vertex colour.
    pub albedo: Vec3,
}

impl SurfacePoint {
    /// The same point seen along `direction`: the geometric normal is turned against it, the smooth one to the side of
    /// the geometric one, and the shading normal goes with the smooth one. So a normal map may bend it below the horizon
    /// of the triangle, but never jumps to the other side.
    #[must_use]
    #[inline(always)]
    pub fn facing(self, direction: Vec3) -> Self {
        let geometric_normal = towards(self.geometric_normal, -direction);
        let turned = self.smooth_normal.dot(geometric_normal) < 0.0;
        let turn = |v: Vec3| if turned { -v } else { v };
        let (smooth_normal, shading_normal) = (turn(self.smooth_normal), turn(self.shading_normal));
        Self { geometric_normal, smooth_normal, shading_normal, ..self }
    }
}

impl DiffusePoint {
    /// The same point seen along `direction`: the normal is turned against it.
    #[must_use]
    pub fn facing(self, direction: Vec3) -> Self {
        Self { geometric_normal: towards(self.geometric_normal, -direction), ..self }
    }
}

impl From<DiffusePoint> for Diffuse {
    fn from(point: DiffusePoint) -> Self {
        let DiffusePoint { position, geometric_normal, reach, albedo } = point;
        Self { position, geometric_normal, reach, albedo }
    }
}

/// `v` or `-v`, whichever is on the side of `side`.
#[inline(always)]
fn towards(v: Vec3, side: Vec3) -> Vec3 {
    if v.dot(side) < 0.0 { -v } else { v }
}

impl Surfaces {
    /// Prepares `scene`: one pass over its instances, and over the alpha of images and vertices, which is kept apart for
    /// meshes that are seen in part. Tables of albedos wait for
    /// [`prepare_albedos`](Self::prepare_albedos).
    ///
    /// # Panics
    /// If the scene's indices refer to what is not there.
    #[must_use]
    pub fn new(scene: Arc<Scene>) -> Self {
        let opaque = is_opaque_by_mesh(&scene);
        Self {
            frames: scene.instances.iter().map(Frame::new).collect(),
            shape_frames: shape_frames(&scene),
            cutouts: cutouts(&scene, &opaque),
            opaque: opaque.into(),
            albedos: Arc::default(),
            scene,
        }
    }

    /// The same surfaces where `scene` has them: the same scene at another pose. Much faster than [`new`](Self::new).
    #[must_use]
    pub fn moved_to(&self, scene: Arc<Scene>) -> Self {
        Self {
            frames: scene.instances.iter().map(Frame::new).collect(),
            shape_frames: shape_frames(&scene),
            opaque: Arc::clone(&self.opaque),
            cutouts: Arc::clone(&self.cutouts),
            albedos: Arc::clone(&self.albedos),
            scene,
        }
    }

    /// The scene that was given.
    #[must_use]
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Whether every ray sees every triangle of `mesh`: its material is opaque, or nothing of it is transparent.
    #[must_use]
    pub fn is_opaque(&self, mesh: u32) -> bool {
        self.opaque[mesh as usize]
    }

    /// Alpha at a point given by barycentrics as in [`Hit`]: base alpha × texture × vertex alpha.
    #[must_use]
    pub fn alpha(&self, instance: u32, triangle: u32, u: f32, v: f32) -> f32 {
        if let Some(shape) = self.scene.shape_instance(instance) {
            return self.scene.materials[shape.material as usize].base_color.w;
        }
        let mesh = self.mesh(instance);
        self.alpha_of(mesh, &self.scene.materials[mesh.material as usize], triangle, u, v)
    }

    /// Whether a ray with this `seed` sees the point given by barycentrics as in [`Hit`]. It sees all of a shape, or
    /// nothing of it.
    #[must_use]
    pub fn accepts(&self, instance: u32, triangle: u32, u: f32, v: f32, seed: u32) -> bool {
        let mesh = self.scene.instances.get(instance as usize).map(|instance| instance.mesh as usize);
        if let Some(cutout) = mesh.and_then(|mesh| self.cutouts[mesh].as_ref()) {
            return cutout.accepts(instance, triangle, u, v, seed);
        }
        self.accepts_by_material(instance, triangle, u, v, seed)
    }

    /// [`accepts`](Self::accepts) for all that is no [`Cutout`]. Seldom asked, so its code is not among the rest.
    #[inline(never)]
    fn accepts_by_material(&self, instance: u32, triangle: u32, u: f32, v: f32, seed: u32) -> bool {
        let material = match self.scene.shape_instance(instance) {
            Some(shape) => shape.material,
            None => self.mesh(instance).material,
        };
        match self.scene.materials[material as usize].alpha_mode {
            AlphaMode::Opaque => true,
            AlphaMode::Mask(cutoff) => self.alpha(instance, triangle, u, v) >= cutoff,
            AlphaMode::Blend => {
                self.alpha(instance, triangle, u, v) > alpha_threshold(seed, instance, triangle)
            }
        }
    }

    /// The surface at the `hit` of `ray`, its textures averaged over a footprint of `width` scene units; 0 reads them
    /// finest.
    #[must_use]
    pub fn surface_at(&self, ray: &Ray, hit: &Hit, width: f32) -> SurfacePoint {
        if let Some(instance) = self.scene.shape_instance(hit.instance) {
            let point = self.shape_point(instance, ray, hit);
            let material = &self.scene.materials[instance.material as usize];
            return SurfacePoint {
                position: point.position,
                geometric_normal: point.normal,
                reach: point.reach,
                smooth_normal: point.normal,
                shading_normal: point.normal,
                albedo: base_color(material, || point.object_position),
                emission: material.emission,
                material: instance.material,
                unlit: material.unlit,
            };
        }
        Face::seen(self, hit).point(hit, width)
    }

    /// Reads [`surface_at`](Self::surface_at) of many hits, of which neighbours are often on one triangle.
    #[must_use]
    pub const fn reader(&self) -> SurfaceReader<'_> {
        SurfaceReader { surfaces: self, last: None }
    }

    /// The part of [`surface_at`](Self::surface_at) that bounced light needs, for about half its cost.
    #[must_use]
    pub fn diffuse_at(&self, ray: &Ray, hit: &Hit, width: f32) -> DiffusePoint {
        if let Some(instance) = self.scene.shape_instance(hit.instance) {
            let ShapePoint { position, object_position, normal, reach } =
                self.shape_point(instance, ray, hit);
            let material = &self.scene.materials[instance.material as usize];
            let albedo = base_color(material, || object_position);
            return DiffusePoint { position, geometric_normal: normal, reach, albedo };
        }
        let face = Face::new(self, hit);
        let at = At::new(&face, hit, width);
        DiffusePoint {
            position: at.position(),
            geometric_normal: at.geometric_normal,
            reach: face.reach,
            albedo: at.albedo(),
        }
    }

    /// Whether instance `index` of a hit can move; false for what is not there.
    #[must_use]
    pub fn motion(&self, index: u32) -> Motion {
        let (i, meshes) = (index as usize, self.scene.instances.len());
        let of_shape = || self.scene.shape_instances.get(i - meshes).map(|instance| instance.motion);
        self.scene.instances.get(i).map(|instance| instance.motion).or_else(of_shape).unwrap_or_default()
    }

    /// Where the point at the `hit` of `ray` was in `earlier`, the surfaces of the same scene at another pose: its position,
    /// unit geometric and unit smooth normal there, world space, turned as in [`surface_at`](Self::surface_at).
    #[must_use]
    pub fn point_in(&self, earlier: &Self, ray: &Ray, hit: &Hit) -> (Vec3, Vec3, Vec3) {
        if let Some(instance) = self.scene.shape_instance(hit.instance) {
            let object_position = self.shape_point(instance, ray, hit).object_position;
            let index = hit.instance as usize - self.scene.instances.len();
            let then = &earlier.scene.shape_instances[index];
            let normal = self.scene.shapes[instance.shape as usize].normal(object_position);
            let normal = earlier.shape_frames[index].normal(normal);
            return (then.world_from_object.transform_point3(object_position), normal, normal);
        }
        let face = Face::new(earlier, hit);
        let at = At::new(&face, hit, 0.0);
        (at.position(), at.geometric_normal, at.smooth_normal())
    }

    fn shape_point(&self, instance: &ShapeInstance, ray: &Ray, hit: &Hit) -> ShapePoint {
        let frame = &self.shape_frames[hit.instance as usize - self.scene.instances.len()];
        frame.point(instance, &self.scene.shapes[instance.shape as usize], ray, hit)
    }

    fn mesh(&self, instance: u32) -> &Mesh {
        &self.scene.meshes[self.scene.instances[instance as usize].mesh as usize]
    }

    fn alpha_of(&self, mesh: &Mesh, material: &Material, triangle: u32, u: f32, v: f32) -> f32 {
        let corners = mesh.triangles[triangle as usize];
        let weights = [1.0 - u - v, u, v];
        let mut alpha = material.base_color.w;
        if let Some(texture) = &material.base_color_texture {
            let uv = texture.transform.transform_point2(weigh(mesh_uvs(mesh, texture, corners), weights));
            let read = self.scene.textures[texture.texture as usize];
            alpha *= read.sampler.alpha_at(&self.scene.images[read.image as usize], uv);
        }
        if !mesh.colors.is_empty() {
            let [a, b, c] = each(corners, |i| mesh.colors[i as usize].w);
            alpha *= a * weights[0] + b * weights[1] + c * weights[2];
        }
        alpha
    }
}

/// See [`Surfaces::reader`].
#[derive(Debug)]
pub struct SurfaceReader<'s> {
    surfaces: &'s Surfaces,
    /// What the hits of the last triangle share, with its instance and number.
    last: Option<(u32, u32, Face<'s>)>,
}

impl SurfaceReader<'_> {
    /// The bits of [`Surfaces::surface_at`].
    #[must_use]
    #[inline(always)]
    pub fn surface_at(&mut self, ray: &Ray, hit: &Hit, width: f32) -> SurfacePoint {
        if hit.instance as usize >= self.surfaces.scene.instances.len() {
            return self.surfaces.surface_at(ray, hit, width);
        }
        let known = self.last.as_ref().is_some_and(|last| (last.0, last.1) == (hit.instance, hit.triangle));
        if !known {
            self.last = Some((hit.instance, hit.triangle, Face::seen(self.surfaces, hit)));
        }
        let (.., face) = self.last.as_ref().expect("just written");
        face.point(hit, width)
    }
}

/// The base colour, or that of the checker at `object_position`.
#[inline(always)]
fn base_color(material: &Material, object_position: impl FnOnce() -> Vec3) -> Vec3 {
    let base = material.base_color.truncate();
    match &material.checker {
        Some(checker) if material.kind() == MaterialKind::Checker => checker.at(base, object_position()),
        _ => base,
    }
}

/// What `of` makes of three corners. Unlike [`array::map`](core::array), it is always inlined.
#[inline(always)]
fn each<T, U>([a, b, c]: [T; 3], of: impl Fn(T) -> U) -> [U; 3] {
    [of(a), of(b), of(c)]
}

/// Texture coordinates of the corners, zero if the mesh lacks the set.
#[inline(always)]
fn mesh_uvs(mesh: &Mesh, texture: &TextureRef, corners: [u32; 3]) -> [Vec2; 3] {
    match mesh.uvs.get(texture.uv_set as usize) {
        Some(uvs) => each(corners, |i| uvs[i as usize]),
        None => [Vec2::ZERO; 3],
    }
}

#[inline(always)]
fn weigh([a, b, c]: [Vec2; 3], weights: [f32; 3]) -> Vec2 {
    a * weights[0] + b * weights[1] + c * weights[2]
}

/// Matrix that turns normals where `m` turns points: the inverse transpose up to a positive factor, defined even where
/// `m` has no inverse.
#[must_use]
pub fn normal_matrix(m: Mat3A) -> Mat3A {
    // Scaled to unit size, since products of tiny or huge entries leave the range of numbers.
    let size = m.x_axis.abs().max(m.y_axis.abs()).max(m.z_axis.abs()).max_element();
    let m = if size > 0.0 { m * (1.0 / size) } else { m };
    let side = if m.determinant() < 0.0 { -1.0 } else { 1.0 };
    Mat3A::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis)) * side
}

fn is_opaque_by_mesh(scene: &Scene) -> Vec<bool> {
    // Least alpha of each material without vertex colours; infinite for those that ignore alpha.
    let least = |material: &Material| {
        let texture = material.base_color_texture.as_ref().map_or(1.0, |texture| {
            let image = scene.textures[texture.texture as usize].image;
            scene.images[image as usize].least_alpha()
        });
        if material.alpha_mode == AlphaMode::Opaque { f32::INFINITY } else { material.base_color.w * texture }
    };
    let least: Vec<f32> = scene.materials.iter().map(least).collect();
    let is_opaque = |mesh: &Arc<Mesh>| {
        let of_vertices = || mesh.colors.iter().map(|color| color.w).fold(1.0, f32::min);
        let alpha = || least[mesh.material as usize] * of_vertices();
        match scene.materials[mesh.material as usize].alpha_mode {
            AlphaMode::Opaque => true,
            AlphaMode::Mask(cutoff) => alpha() >= cutoff.max(ROUNDING),
            // The threshold is below 1.
            AlphaMode::Blend => alpha() >= 1.0,
        }
    };
    scene.meshes.iter().map(is_opaque).collect()
}

/// Interpolation may round an alpha of zero below zero, so a cutoff of zero is decided point by point.
const ROUNDING: f32 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Image, Sampler, Texture, Wrap};
    use glam::{Affine2, Quat, Vec4};

    /// One triangle (0,0,0), (1,0,0), (0,1,0) with upright texture coordinates.
    fn mesh() -> Mesh {
        Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            uvs: vec![vec![Vec2::new(0.0, 1.0), Vec2::ONE, Vec2::ZERO]],
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        }
    }

    fn surfaces(mesh: Mesh, material: Material, images: Vec<Image>, placement: Affine3A) -> Surfaces {
        let sampler = Sampler { wrap: [Wrap::Clamp; 2], ..Sampler::default() };
        let textures = (0..images.len() as u32).map(|image| Texture { image, sampler }).collect();
        let instances = vec![Instance { mesh: 0, world_from_object: placement, ..Instance::default() }];
        let materials = vec![material];
        Surfaces::new(Arc::new(Scene {
            meshes: vec![Arc::new(mesh)],
            instances,
            materials,
            textures,
            images: images.into_iter().map(Arc::new).collect(),
            ..Scene::default()
        }))
    }

    /// Surfaces of triangles do not depend on the ray.
    const RAY: Ray = Ray { origin: Vec3::ZERO, t_max: 1.0, direction: Vec3::NEG_Z, seed: 0 };
    const HIT: Hit = Hit { t: 1.0, u: 0.25, v: 0.5, instance: 0, triangle: 0 };

    fn texture() -> Option<TextureRef> {
        Some(TextureRef { texture: 0, uv_set: 0, transform: Affine2::IDENTITY })
    }

    #[track_caller]
    fn assert_near(a: Vec3, b: Vec3) {
        assert!(a.abs_diff_eq(b, 1e-5), "{a} is not {b}");
    }

    #[test]
    fn position_and_normals_follow_the_placement() {
        let mesh = Mesh { normals: vec![Vec3::new(0.6, 0.0, 0.8); 3], ..mesh() };
        let plain = surfaces(mesh.clone(), Material::default(), vec![], Affine3A::IDENTITY)
            .surface_at(&RAY, &HIT, 0.0);
        assert_near(plain.position, Vec3::new(0.25, 0.5, 0.0));
        assert_near(plain.geometric_normal, Vec3::Z);
        assert_near(plain.smooth_normal, Vec3::new(0.6, 0.0, 0.8));
        assert_eq!(plain.shading_normal, plain.smooth_normal);

        // Normals of a surface stretched along x lean away from x.
        let stretch = Affine3A::from_scale(Vec3::new(2.0, 1.0, 1.0));
        let point = surfaces(mesh.clone(), Material::default(), vec![], stretch).surface_at(&RAY, &HIT, 0.0);
        assert_near(point.smooth_normal, Vec3::new(0.3, 0.0, 0.8).normalize());

        // A mirror keeps the front in front.
        let mirror = Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
        let point = surfaces(mesh, Material::default(), vec![], mirror).surface_at(&RAY, &HIT, 0.0);
        assert_near(point.position, Vec3::new(-0.25, 0.5, 0.0));
        assert_near(point.geometric_normal, Vec3::Z);
        assert_near(point.smooth_normal, Vec3::new(-0.6, 0.0, 0.8));
    }

    #[test]
    fn scale_does_not_matter() {
        let mesh = Mesh { normals: vec![Vec3::Z; 3], ..mesh() };
        for scale in [1e-12, 1e-6, 1e6, 1e12] {
            let m = Affine3A::from_scale(Vec3::splat(scale));
            let point = surfaces(mesh.clone(), Material::default(), vec![], m).surface_at(&RAY, &HIT, 0.0);
            assert_near(point.geometric_normal, Vec3::Z);
            assert_near(point.smooth_normal, Vec3::Z);
        }
    }

    #[test]
    fn normals_turn_towards_the_viewer() {
        let mesh = Mesh { normals: vec![Vec3::new(0.0, 0.6, 0.8); 3], ..mesh() };
        let point =
            surfaces(mesh, Material::default(), vec![], Affine3A::IDENTITY).surface_at(&RAY, &HIT, 0.0);
        assert_eq!(point.facing(Vec3::NEG_Z), point);
        let behind = point.facing(Vec3::Z);
        assert_eq!(behind.geometric_normal, -point.geometric_normal);
        assert_eq!(behind.smooth_normal, -point.smooth_normal);
        // A normal map may bend the shading normal below the horizon; it must not be turned around there.
        let bent = SurfacePoint { shading_normal: Vec3::new(0.996, 0.0, -0.089), ..point };
        assert_eq!(bent.facing(Vec3::NEG_Z), bent);
    }

    #[test]
    fn reach_bounds_what_corners_are_computed_from() {
        let moved = Affine3A::from_scale_rotation_translation(
            Vec3::splat(2.0),
            Quat::IDENTITY,
            Vec3::new(-1.0, 5.0, 0.0),
        );
        for (placement, reach) in [(Affine3A::IDENTITY, 1.0), (moved, 7.0)] {
            let point = surfaces(mesh(), Material::default(), vec![], placement).surface_at(&RAY, &HIT, 0.0);
            assert_eq!(point.reach, reach);
        }
    }

    #[test]
    fn degenerate_triangles_have_normals() {
        let mut mesh = mesh();
        mesh.positions[2] = Vec3::X;
        let point =
            surfaces(mesh, Material::default(), vec![], Affine3A::IDENTITY).surface_at(&RAY, &HIT, 1.0);
        assert_eq!((point.geometric_normal, point.smooth_normal), (Vec3::Y, Vec3::Y));
    }

    #[track_caller]
    fn check_normal_map(mesh: Mesh, placement: Affine3A, expected: Vec3) {
        // Red 0.2, green 0.4, blue up.
        let image = Image::new(String::new(), 1, 1, vec![[153, 178, 242, 255]], false);
        let material = Material { normal_texture: texture(), ..Material::default() };
        let point = surfaces(mesh, material, vec![image], placement).surface_at(&RAY, &HIT, 0.0);
        let error = (point.shading_normal - expected).abs().max_element();
        assert!(error < 5e-3, "{} is not {expected}", point.shading_normal);
    }

    #[test]
    fn normal_maps_with_and_without_tangents() {
        let up = Vec3::new(0.2, 0.396, 0.898).normalize();
        let with_tangents =
            Mesh { normals: vec![Vec3::Z; 3], tangents: vec![Vec4::new(1.0, 0.0, 0.0, 1.0); 3], ..mesh() };
        let turned = Affine3A::from_quat(Quat::from_rotation_y(0.7));
        let mirror = Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
        for mesh in [mesh(), with_tangents] {
            check_normal_map(mesh.clone(), Affine3A::IDENTITY, up);
            check_normal_map(mesh.clone(), turned, turned.transform_vector3(up));
            check_normal_map(mesh.clone(), mirror, mirror.transform_vector3(up));
        }
        // Texture coordinates that run backwards turn red around.
        let mut backwards = mesh();
        backwards.uvs[0].iter_mut().for_each(|uv| uv.x = -uv.x);
        check_normal_map(backwards, Affine3A::IDENTITY, up * Vec3::new(-1.0, 1.0, 1.0));
    }

    #[test]
    fn albedo_is_a_product_and_coarsens_with_the_footprint() {
        let texels = vec![[255, 0, 0, 255], [0, 0, 255, 255], [255, 0, 0, 255], [0, 0, 255, 255]];
        let image = Image::new(String::new(), 4, 1, texels, true);
        let material = Material {
            base_color: Vec4::new(0.5, 1.0, 1.0, 1.0),
            base_color_texture: texture(),
            emission: Vec3::ONE,
            emission_texture: texture(),
            ..Material::default()
        };
        let mesh = Mesh { colors: vec![Vec4::new(0.5, 1.0, 0.25, 1.0); 3], ..mesh() };
        let surfaces = surfaces(mesh, material, vec![image], Affine3A::from_scale(Vec3::splat(8.0)));
        let hit = Hit { u: 0.125, v: 0.2, ..HIT }; // centre of the first texel
        let fine = surfaces.diffuse_at(&RAY, &hit, 0.0);
        assert_near(fine.albedo, Vec3::new(0.25, 0.0, 0.0));
        assert_near(surfaces.surface_at(&RAY, &hit, 0.0).emission, Vec3::X);
        // The triangle's texture spans 8 units: a footprint of 8 averages all of it.
        let coarse = surfaces.surface_at(&RAY, &hit, 8.0);
        let error = (coarse.emission - Vec3::new(0.5, 0.0, 0.5)).abs().max_element();
        assert!(error < 5e-3, "{}", coarse.emission);
        assert_eq!(coarse.albedo, surfaces.diffuse_at(&RAY, &hit, 8.0).albedo);
    }

    #[test]
    fn alpha_modes() {
        let sheer = Image::new(String::new(), 1, 1, vec![[255, 255, 255, 128]], true);
        let make = |alpha_mode, base: f32, image: Option<Image>| {
            let base_color = Vec4::new(1.0, 1.0, 1.0, base);
            let base_color_texture = image.as_ref().and(texture());
            let material = Material { alpha_mode, base_color, base_color_texture, ..Material::default() };
            surfaces(mesh(), material, image.into_iter().collect(), Affine3A::IDENTITY)
        };
        let share = |surfaces: &Surfaces| {
            (0..4096).filter(|&seed| surfaces.accepts(0, 0, 0.2, 0.2, seed)).count() as f32 / 4096.0
        };
        let opaque = make(AlphaMode::Opaque, 0.0, Some(sheer.clone()));
        assert!(opaque.is_opaque(0) && share(&opaque) == 1.0);
        let mask = make(AlphaMode::Mask(0.5), 1.0, Some(sheer.clone()));
        assert!((mask.alpha(0, 0, 0.2, 0.2) - 128.0 / 255.0).abs() < 1e-6);
        assert!(mask.is_opaque(0) && share(&mask) == 1.0);
        let cut = make(AlphaMode::Mask(0.6), 1.0, Some(sheer.clone()));
        assert!(!cut.is_opaque(0) && share(&cut) == 0.0);
        let blend = make(AlphaMode::Blend, 0.5, Some(sheer));
        assert!(!blend.is_opaque(0) && (share(&blend) - 0.251).abs() < 0.02, "{}", share(&blend));
        assert!(make(AlphaMode::Blend, 1.0, None).is_opaque(0));
    }
}
