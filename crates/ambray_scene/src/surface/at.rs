//! A hit on a triangle, and what all hits of a triangle share.

use ambray_core::trace::Hit;
use glam::{Vec2, Vec3, Vec3A, Vec4};

use super::{Frame, SurfacePoint, Surfaces, base_color, each, mesh_uvs, weigh};
use crate::{Instance, Material, Mesh, Scene, TextureRef};

/// A triangle in the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    /// World space.
    points: [Vec3A; 3],
    /// Largest magnitude of a component of an edge.
    scale: f32,
    /// Normal of the triangle whose edges are those over `scale`, as long as twice its area.
    scaled_normal: Vec3A,
    length: f32,
}

impl Placed {
    #[inline(always)]
    pub(super) fn new(instance: &Instance, mesh: &Mesh, corners: [u32; 3]) -> Self {
        let point = |i: u32| instance.world_from_object.transform_point3a(mesh.positions[i as usize].into());
        let points = each(corners, point);
        let (e1, e2) = (points[1] - points[0], points[2] - points[0]);
        // Edges of tiny triangles would vanish when multiplied; scaled to unit size they do not.
        let scale = e1.abs().max(e2.abs()).max_element();
        let scaled_normal = (e1 / scale).cross(e2 / scale);
        Self { points, scale, scaled_normal, length: scaled_normal.length() }
    }

    /// Unit normal on the `side` of the winding; not finite where the triangle has no area.
    #[inline]
    pub(super) fn normal(&self, side: f32) -> Vec3 {
        (self.scaled_normal * (side / self.length)).into()
    }

    /// Root of twice the area.
    #[inline]
    pub(super) fn edge(&self) -> f32 {
        self.scale * self.length.sqrt()
    }
}

/// What all hits of a triangle share.
#[derive(Debug)]
pub(super) struct Face<'s> {
    scene: &'s Scene,
    frame: &'s Frame,
    instance: &'s Instance,
    mesh: &'s Mesh,
    material: &'s Material,
    /// Vertex indices.
    corners: [u32; 3],
    /// World space.
    points: [Vec3A; 3],
    /// Not finite where the triangle has no area.
    normal: Vec3,
    edge: f32,
    /// Largest magnitude of the numbers that its points are computed from.
    pub(super) reach: f32,
    /// In the base colour texture, if there is one.
    base: Mapping,
    /// In the normal map, if there is one and the face is [`seen`](Self::seen).
    bump: Mapping,
}

/// A triangle in a texture.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(32))]
pub(super) struct Mapping {
    /// Texture coordinates of the corners.
    pub(super) uvs: [Vec2; 3],
    /// Root of twice its area: lengths grow from a surface to its texture by the root of what areas grow by.
    pub(super) edge: f32,
}

impl Mapping {
    #[inline(always)]
    pub(super) fn new(mesh: &Mesh, texture: &TextureRef, corners: [u32; 3]) -> Self {
        let uvs = each(mesh_uvs(mesh, texture, corners), |uv| texture.transform.transform_point2(uv));
        let [a, b, c] = uvs;
        Self { uvs, edge: (b - a).perp_dot(c - a).abs().sqrt() }
    }
}

impl<'s> Face<'s> {
    /// What bounced light needs of the triangle of `hit`.
    #[inline(always)]
    pub(super) fn new(surfaces: &'s Surfaces, hit: &Hit) -> Self {
        let scene = &*surfaces.scene;
        let (instance, frame) =
            (&scene.instances[hit.instance as usize], &surfaces.frames[hit.instance as usize]);
        let mesh = &*scene.meshes[instance.mesh as usize];
        let material = &scene.materials[mesh.material as usize];
        let corners = mesh.triangles[hit.triangle as usize];
        let placed = Placed::new(instance, mesh, corners);
        let reach = |i: u32| {
            let magnitude = Vec3A::from(mesh.positions[i as usize]).abs();
            frame.magnitude.transform_point3a(magnitude).max_element()
        };
        let [a, b, c] = each(corners, reach);
        let mapping = |texture: &TextureRef| Mapping::new(mesh, texture, corners);
        Self {
            scene,
            frame,
            instance,
            mesh,
            material,
            corners,
            points: placed.points,
            normal: placed.normal(frame.side),
            edge: placed.edge(),
            reach: 0.0_f32.max(a).max(b).max(c),
            base: material.base_color_texture.as_ref().map_or_else(Mapping::default, mapping),
            bump: Mapping::default(),
        }
    }

    /// What cameras need of the triangle of `hit`.
    #[inline(always)]
    pub(super) fn seen(surfaces: &'s Surfaces, hit: &Hit) -> Self {
        let mut face = Self::new(surfaces, hit);
        let Material { base_color_texture: base, normal_texture: bump, .. } = face.material;
        if let Some(bump) = bump {
            // Most materials place all their textures alike.
            let alike = |base: &TextureRef| (base.uv_set, base.transform) == (bump.uv_set, bump.transform);
            let is_known = base.as_ref().is_some_and(alike);
            face.bump = if is_known { face.base } else { Mapping::new(face.mesh, bump, face.corners) };
        }
        face
    }

    /// The point at `hit`, of a face that is [`seen`](Self::seen).
    #[inline(always)]
    pub(super) fn point(&self, hit: &Hit, width: f32) -> SurfacePoint {
        let at = At::new(self, hit, width);
        let smooth_normal = at.smooth_normal();
        SurfacePoint {
            position: at.position(),
            geometric_normal: at.geometric_normal,
            reach: self.reach,
            smooth_normal,
            shading_normal: at.shading_normal(smooth_normal),
            albedo: at.albedo(),
            emission: at.emission(),
            material: self.mesh.material,
            unlit: self.material.unlit,
        }
    }
}

/// A hit with what all its attributes need.
pub(super) struct At<'f, 's> {
    face: &'f Face<'s>,
    /// Barycentric weights of the corners.
    weights: [f32; 3],
    pub(super) geometric_normal: Vec3,
    /// Footprint in the unit of triangle edges: its width over the square root of twice the triangle's area.
    relative_width: f32,
}

impl<'f, 's> At<'f, 's> {
    #[inline(always)]
    pub(super) fn new(face: &'f Face<'s>, hit: &Hit, width: f32) -> Self {
        let mut at = Self {
            face,
            weights: [1.0 - hit.u - hit.v, hit.u, hit.v],
            geometric_normal: face.normal,
            relative_width: width / face.edge,
        };
        // A triangle without area has no normal of its own.
        if !at.geometric_normal.is_finite() {
            at.geometric_normal = at.vertex_normal().unwrap_or(Vec3::Y);
            at.relative_width = 0.0;
        }
        at
    }

    #[inline(always)]
    pub(super) fn position(&self) -> Vec3 {
        // From the first corner along the edges: exact where edges are short and far from the origin.
        let [a, b, c] = self.face.points;
        (a + (b - a) * self.weights[1] + (c - a) * self.weights[2]).into()
    }

    #[inline(always)]
    fn vertex_normal(&self) -> Option<Vec3> {
        if self.face.mesh.normals.is_empty() {
            return None;
        }
        let [a, b, c] = each(self.face.corners, |i| Vec3A::from(self.face.mesh.normals[i as usize]));
        let object = a * self.weights[0] + b * self.weights[1] + c * self.weights[2];
        let world: Vec3 = (self.face.frame.normal_from_object * object).into();
        // The matrix may be tiny or huge; a direction is left as long as a component is.
        (world / world.abs().max_element()).try_normalize()
    }

    #[inline(always)]
    pub(super) fn smooth_normal(&self) -> Vec3 {
        self.vertex_normal().unwrap_or(self.geometric_normal)
    }

    /// `smooth` bent by the normal map (glTF 2.0 §3.9.3 and appendix B.4).
    #[inline(always)]
    fn shading_normal(&self, smooth: Vec3) -> Vec3 {
        let Some(texture) = &self.face.material.normal_texture else { return smooth };
        let Some((tangent, bitangent)) = self.tangents(smooth, texture) else { return smooth };
        let texel = self.read(texture, &self.face.bump).truncate() * 2.0 - 1.0;
        let bent = texel * Vec3::new(self.face.material.normal_scale, self.face.material.normal_scale, 1.0);
        (tangent * bent.x + bitangent * bent.y + smooth * bent.z).try_normalize().unwrap_or(smooth)
    }

    /// Unit tangent and bitangent orthogonal to `smooth`: the directions of the map's red and green.
    #[inline(always)]
    fn tangents(&self, smooth: Vec3, texture: &TextureRef) -> Option<(Vec3, Vec3)> {
        let (along, side) = if self.face.mesh.tangents.is_empty() {
            self.edge_tangent(texture)?
        } else {
            let [a, b, c] = each(self.face.corners, |i| self.face.mesh.tangents[i as usize]);
            let object = a * self.weights[0] + b * self.weights[1] + c * self.weights[2];
            let world = self.face.instance.world_from_object.transform_vector3(object.truncate());
            (world, self.face.frame.side * if object.w < 0.0 { -1.0 } else { 1.0 })
        };
        let along = along / along.abs().max_element();
        let tangent = along.reject_from_normalized(smooth).try_normalize()?;
        Some((tangent, smooth.cross(tangent) * side))
    }

    /// Direction in which u grows over the triangle, and the sign that `cross(normal, it)` needs to point against v.
    #[inline(always)]
    fn edge_tangent(&self, texture: &TextureRef) -> Option<(Vec3, f32)> {
        let [a, b, c] = mesh_uvs(self.face.mesh, texture, self.face.corners);
        let (d1, d2) = (b - a, c - a);
        let det = d1.perp_dot(d2);
        let (e1, e2) = (self.face.points[1] - self.face.points[0], self.face.points[2] - self.face.points[0]);
        let along = (e1 * d2.y - e2 * d1.y) * det.signum();
        // Upright texture coordinates run clockwise where corners run counter-clockwise, since v points down.
        let side = if det < 0.0 { self.face.frame.side } else { -self.face.frame.side };
        (det != 0.0 && along.is_finite()).then(|| (along.into(), side))
    }

    #[inline(always)]
    pub(super) fn albedo(&self) -> Vec3 {
        let mut color = base_color(self.face.material, || {
            let [a, b, c] = each(self.face.corners, |i| self.face.mesh.positions[i as usize]);
            a + (b - a) * self.weights[1] + (c - a) * self.weights[2]
        });
        if let Some(texture) = &self.face.material.base_color_texture {
            color *= self.read(texture, &self.face.base).truncate();
        }
        if !self.face.mesh.colors.is_empty() {
            let [a, b, c] = each(self.face.corners, |i| self.face.mesh.colors[i as usize].truncate());
            color *= a * self.weights[0] + b * self.weights[1] + c * self.weights[2];
        }
        color
    }

    #[inline(always)]
    fn emission(&self) -> Vec3 {
        match &self.face.material.emission_texture {
            Some(texture) if self.face.material.emission != Vec3::ZERO => {
                let mapping = Mapping::new(self.face.mesh, texture, self.face.corners);
                self.face.material.emission * self.read(texture, &mapping).truncate()
            }
            _ => self.face.material.emission,
        }
    }

    /// The value of the texture over the footprint.
    #[inline(always)]
    fn read(&self, texture: &TextureRef, mapping: &Mapping) -> Vec4 {
        let read = self.face.scene.textures[texture.texture as usize];
        let image = &self.face.scene.images[read.image as usize];
        let width = self.relative_width * mapping.edge;
        read.sampler.sample(image, weigh(mapping.uvs, self.weights), width)
    }
}
