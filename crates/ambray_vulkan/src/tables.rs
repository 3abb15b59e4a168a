//! The scene in tables on the device: what shaders read to turn hits into surfaces.

use std::sync::Arc;

use ambray_core::shape::Shape;
use ambray_scene::{
    AlphaMode, Filter, Image, Material, Scene, Texture, TextureRef, Wrap, surface::normal_matrix,
    texture::srgb_values,
};
use ash::vk::BufferUsageFlags;
use bytemuck::Pod;
use glam::{Affine2, Affine3A, Mat3A};

use crate::{
    Buffer, Context, Placement, Result, VulkanError,
    layout::{self, NONE, SceneTables},
};

const TABLE: BufferUsageFlags = BufferUsageFlags::from_raw(
    BufferUsageFlags::STORAGE_BUFFER.as_raw() | BufferUsageFlags::SHADER_DEVICE_ADDRESS.as_raw(),
);

/// All tables of a scene, and the table of their addresses.
#[derive(Debug)]
pub(crate) struct Tables {
    /// Keeps what the addresses refer to.
    _tables: Vec<Buffer>,
    addresses: Buffer,
}

impl Tables {
    /// Uploads `scene`; `placements` and `refs` are those of its acceleration structures.
    pub(crate) fn new(
        context: &Arc<Context>,
        scene: &Scene,
        placements: &[Placement],
        refs: &[[u32; 2]],
    ) -> Result<Self> {
        let mut upload = Upload { context, tables: Vec::new() };
        let vertices = Vertices::of(scene)?;
        let images = Images::of(&scene.images)?;
        let fields = (scene.shapes.iter())
            .map(|shape| match shape {
                Shape::Field(field) => upload.table("samples of a field", field.distances()),
                _ => Ok(0),
            })
            .collect::<Result<Vec<_>>>()?;
        let shapes: Vec<_> = scene.shapes.iter().zip(fields).map(|(s, field)| shape(s, field)).collect();
        let textures: Vec<_> = scene.textures.iter().map(|t| texture(t, scene, &images.first)).collect();
        let tables = SceneTables {
            placements: upload.table("placements", &placements.iter().map(placement).collect::<Vec<_>>())?,
            refs: upload.table("triangle references", refs)?,
            instances: upload.table("instances", &instances(scene))?,
            meshes: upload.table("meshes", &vertices.meshes)?,
            materials: upload
                .table("materials", &scene.materials.iter().map(material).collect::<Vec<_>>())?,
            textures: upload.table("textures", &textures)?,
            levels: upload.table("image levels", &images.levels)?,
            texels: upload.table("texels", &images.texels)?,
            srgb: upload.table("sRGB values", srgb_values())?,
            positions: upload.table("positions", &vertices.positions)?,
            normals: upload.table("normals", &vertices.normals)?,
            tangents: upload.table("tangents", &vertices.tangents)?,
            uvs: upload.table("texture coordinates", &vertices.uvs)?,
            colors: upload.table("vertex colours", &vertices.colors)?,
            triangles: upload.table("triangles", &vertices.triangles)?,
            shapes: upload.table("shapes", &shapes)?,
            shape_instances: upload.table("placed shapes", &shape_instances(scene))?,
            mesh_instances: scene.instances.len() as u32,
            padding: 0,
        };
        upload.table("tables", &[tables])?;
        let addresses = upload.tables.pop().expect("just made");
        Ok(Self { _tables: upload.tables, addresses })
    }

    /// Device address of the [`SceneTables`].
    pub(crate) const fn address(&self) -> u64 {
        self.addresses.address()
    }
}

/// Tables on their way.
struct Upload<'a> {
    context: &'a Arc<Context>,
    tables: Vec<Buffer>,
}

impl Upload<'_> {
    /// Uploads a table and returns its address.
    fn table<T: Pod>(&mut self, name: &str, content: &[T]) -> Result<u64> {
        let buffer = self.context.upload(name, TABLE, content)?;
        let address = buffer.address();
        self.tables.push(buffer);
        Ok(address)
    }
}

/// Vertex attributes and triangles of all meshes, one after the other.
#[derive(Default)]
struct Vertices {
    meshes: Vec<layout::Mesh>,
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    tangents: Vec<[f32; 4]>,
    uvs: Vec<[f32; 2]>,
    colors: Vec<[f32; 4]>,
    triangles: Vec<[u32; 3]>,
}

impl Vertices {
    fn of(scene: &Scene) -> Result<Self> {
        let mut all = Self::default();
        for mesh in &scene.meshes {
            all.meshes.push(layout::Mesh {
                first_triangle: place("triangles", &all.triangles)?,
                first_vertex: place("vertices", &all.positions)?,
                vertices: mesh.positions.len() as u32,
                first_normal: place_of("normals", &all.normals, mesh.normals.is_empty())?,
                first_tangent: place_of("tangents", &all.tangents, mesh.tangents.is_empty())?,
                first_color: place_of("vertex colours", &all.colors, mesh.colors.is_empty())?,
                first_uv: place("texture coordinates", &all.uvs)?,
                uv_sets: mesh.uvs.len() as u32,
                material: mesh.material,
            });
            all.positions.extend(mesh.positions.iter().map(|v| v.to_array()));
            all.normals.extend(mesh.normals.iter().map(|v| v.to_array()));
            all.tangents.extend(mesh.tangents.iter().map(|v| v.to_array()));
            all.uvs.extend(mesh.uvs.iter().flatten().map(|v| v.to_array()));
            all.colors.extend(mesh.colors.iter().map(|v| v.to_array()));
            all.triangles.extend(&mesh.triangles);
        }
        Ok(all)
    }
}

/// Levels and texels of all images, one after the other.
#[derive(Default)]
struct Images {
    levels: Vec<layout::ImageLevel>,
    texels: Vec<[u8; 4]>,
    /// First level of each image.
    first: Vec<u32>,
}

impl Images {
    fn of(images: &[Arc<Image>]) -> Result<Self> {
        let mut all = Self::default();
        for image in images {
            all.first.push(place("image levels", &all.levels)?);
            for level in &image.levels {
                let first_texel = place("texels", &all.texels)?;
                all.levels.push(layout::ImageLevel { size: [level.width, level.height], first_texel });
                all.texels.extend(&level.texels);
            }
        }
        Ok(all)
    }
}

const fn placement(placement: &Placement) -> layout::Placement {
    layout::Placement { first_ref: placement.first_ref, instance: placement.instance }
}

/// Where the next entries of a table begin.
fn place<T>(what: &str, table: &[T]) -> Result<u32> {
    // Shaders multiply indices with sign.
    let limit = i32::MAX as u64;
    let asked = table.len() as u64;
    let error = || VulkanError::Limit { what: format!("{what} of the scene"), asked, limit };
    u32::try_from(asked).ok().filter(|_| asked <= limit).ok_or_else(error)
}

/// As [`place`]; none if there are no entries.
fn place_of<T>(what: &str, table: &[T], is_empty: bool) -> Result<u32> {
    if is_empty { Ok(NONE) } else { place(what, table) }
}

fn columns(m: &Affine3A) -> [[f32; 3]; 4] {
    m.to_cols_array_2d()
}

fn instances(scene: &Scene) -> Vec<layout::Instance> {
    let instance = |instance: &ambray_scene::Instance| {
        let m = instance.world_from_object.matrix3;
        layout::Instance {
            world_from_object: columns(&instance.world_from_object),
            normal_from_object: normal_columns(m),
            side: if m.determinant() < 0.0 { -1.0 } else { 1.0 },
            mesh: instance.mesh,
        }
    };
    scene.instances.iter().map(instance).collect()
}

fn normal_columns(m: Mat3A) -> [[f32; 3]; 3] {
    normal_matrix(m).to_cols_array_2d()
}

fn shape_instances(scene: &Scene) -> Vec<layout::ShapeInstance> {
    let instance = |placed: &ambray_scene::ShapeInstance| layout::ShapeInstance {
        world_from_object: columns(&placed.world_from_object),
        object_from_world: columns(&placed.world_from_object.inverse()),
        normal_from_object: normal_columns(placed.world_from_object.matrix3),
        reach: placed.reach(&scene.shapes[placed.shape as usize]),
        shape: placed.shape,
        material: placed.material,
    };
    scene.shape_instances.iter().map(instance).collect()
}

fn shape(shape: &Shape, field_address: u64) -> layout::Shape {
    let (low, high) = shape.bounds();
    let (kind, [a, b, c]) = match *shape {
        Shape::Sphere { radius } => (layout::SHAPE_SPHERE, [radius, 0.0, 0.0]),
        Shape::Box { half_extents } => (layout::SHAPE_BOX, half_extents.to_array()),
        Shape::Capsule { height, radius_bottom, radius_top } => {
            (layout::SHAPE_CAPSULE, [height, radius_bottom, radius_top])
        }
        Shape::Cylinder { height, radius_bottom, radius_top } => {
            (layout::SHAPE_CYLINDER, [height, radius_bottom, radius_top])
        }
        Shape::Field(_) => (layout::SHAPE_FIELD, [0.0; 3]),
    };
    let grid = if let Shape::Field(field) = shape { field.samples() } else { [0; 3] };
    let (box_min, box_max) = (low.to_array(), high.to_array());
    layout::Shape { kind, a, b, c, field: field_address, grid, box_min, box_max, padding: 0 }
}

fn material(material: &Material) -> layout::Material {
    let (alpha_mode, alpha_cutoff) = match material.alpha_mode {
        AlphaMode::Opaque => (layout::ALPHA_OPAQUE, 0.0),
        AlphaMode::Mask(cutoff) => (layout::ALPHA_MASK, cutoff),
        AlphaMode::Blend => (layout::ALPHA_BLEND, 0.0),
    };
    layout::Material {
        base_color: material.base_color.to_array(),
        emission: material.emission.to_array(),
        kind: material.kind() as u32,
        checker_color: material.checker.map_or([0.0; 3], |checker| checker.color.to_array()),
        checker_size: material.checker.map_or(0.0, |checker| checker.size),
        alpha_mode,
        alpha_cutoff,
        normal_scale: material.normal_scale,
        base_color_texture: texture_use(material.base_color_texture.as_ref()),
        normal_texture: texture_use(material.normal_texture.as_ref()),
        emission_texture: texture_use(material.emission_texture.as_ref()),
    }
}

fn texture_use(texture: Option<&TextureRef>) -> layout::TextureUse {
    let affine = texture.map_or(Affine2::IDENTITY, |texture| texture.transform);
    layout::TextureUse {
        transform: affine.to_cols_array_2d(),
        texture: texture.map_or(NONE, |texture| texture.texture),
        uv_set: texture.map_or(0, |texture| texture.uv_set),
    }
}

fn texture(texture: &Texture, scene: &Scene, first_levels: &[u32]) -> layout::Texture {
    let image = &scene.images[texture.image as usize];
    let wrap = texture.sampler.wrap.map(|wrap| match wrap {
        Wrap::Repeat => layout::WRAP_REPEAT,
        Wrap::Mirror => layout::WRAP_MIRROR,
        Wrap::Clamp => layout::WRAP_CLAMP,
    });
    let filter = |filter: Filter| match filter {
        Filter::Nearest => layout::TEXEL_NEAREST,
        Filter::Linear => layout::TEXEL_LINEAR,
    };
    layout::Texture {
        first_level: first_levels[texture.image as usize],
        level_count: image.levels.len() as u32,
        wrap,
        mag: filter(texture.sampler.mag),
        min: filter(texture.sampler.min),
        mip: texture.sampler.mip.map_or(NONE, filter),
        srgb: image.srgb.into(),
    }
}
