//! The scene in tables on the device: what shaders read to turn hits into surfaces.

mod placed;
mod previous;
mod vertices;

use std::sync::Arc;

use ambray_core::shape::Shape;
use ambray_scene::{
    AlphaMode, Filter, Image, Material, Scene, Texture, TextureRef, Wrap, texture::srgb_values,
};
use ash::vk::BufferUsageFlags;
use bytemuck::Pod;
use glam::Affine2;

use crate::{
    Buffer, Context, Placement, Result, VulkanError,
    layout::{self, NONE, SceneTables},
};

pub(crate) use placed::{Change, PlacedTable};
pub(crate) use previous::Previous;
pub(crate) use vertices::deforming_meshes;

use vertices::Vertices;

/// Usages of every table. Tables that move are copied, too.
const TABLE: BufferUsageFlags = BufferUsageFlags::from_raw(
    BufferUsageFlags::STORAGE_BUFFER.as_raw()
        | BufferUsageFlags::SHADER_DEVICE_ADDRESS.as_raw()
        | BufferUsageFlags::TRANSFER_SRC.as_raw()
        | BufferUsageFlags::TRANSFER_DST.as_raw(),
);

/// All tables of a scene, and the table of their addresses.
#[derive(Debug)]
pub(crate) struct Tables {
    /// Keeps what the addresses refer to.
    _tables: Vec<Buffer>,
    pub(crate) instances: PlacedTable<layout::Instance>,
    pub(crate) shape_instances: PlacedTable<layout::ShapeInstance>,
    /// Vertex attributes that deformation writes.
    pub(crate) positions: Buffer,
    pub(crate) normals: Buffer,
    pub(crate) tangents: Buffer,
    /// Where the attributes of each mesh are.
    pub(crate) meshes: Vec<layout::Mesh>,
    content: SceneTables,
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
        let moving_input = TABLE | BufferUsageFlags::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR;
        let positions = context.upload("positions", moving_input, &vertices.positions)?;
        let normals = context.upload("normals", TABLE, &vertices.normals)?;
        let tangents = context.upload("tangents", TABLE, &vertices.tangents)?;
        let instances = PlacedTable::new(context, "instances", placed::instances(scene))?;
        let shape_instances = PlacedTable::new(context, "placed shapes", placed::shape_instances(scene))?;
        let images = Images::of(&scene.images)?;
        let fields = (scene.shapes.iter())
            .map(|shape| match shape {
                Shape::Field(field) => upload.table("samples of a field", field.distances()),
                _ => Ok(0),
            })
            .collect::<Result<Vec<_>>>()?;
        let shapes: Vec<_> = scene.shapes.iter().zip(fields).map(|(s, field)| shape(s, field)).collect();
        let textures: Vec<_> = scene.textures.iter().map(|t| texture(t, scene, &images.first)).collect();
        let content = SceneTables {
            placements: upload.table("placements", &placements.iter().map(placement).collect::<Vec<_>>())?,
            refs: upload.table("triangle references", refs)?,
            instances: instances.address(),
            meshes: upload.table("meshes", &vertices.meshes)?,
            materials: upload
                .table("materials", &scene.materials.iter().map(material).collect::<Vec<_>>())?,
            textures: upload.table("textures", &textures)?,
            levels: upload.table("image levels", &images.levels)?,
            texels: upload.table("texels", &images.texels)?,
            srgb: upload.table("sRGB values", srgb_values())?,
            positions: positions.address(),
            normals: normals.address(),
            tangents: tangents.address(),
            uvs: upload.table("texture coordinates", &vertices.uvs)?,
            colors: upload.table("vertex colours", &vertices.colors)?,
            triangles: upload.table("triangles", &vertices.triangles)?,
            shapes: upload.table("shapes", &shapes)?,
            shape_instances: shape_instances.address(),
            // Nothing has moved: the last frame was rendered with this.
            previous_instances: instances.address(),
            previous_shape_instances: shape_instances.address(),
            previous_positions: 0,
            previous_normals: 0,
            mesh_instances: scene.instances.len() as u32,
            padding: 0,
        };
        let addresses = context.upload("tables", TABLE, &[content])?;
        Ok(Self {
            _tables: upload.tables,
            instances,
            shape_instances,
            positions,
            normals,
            tangents,
            meshes: vertices.meshes,
            content,
            addresses,
        })
    }

    /// Device address of the [`SceneTables`], in which nothing has moved since the last frame.
    pub(crate) const fn address(&self) -> u64 {
        self.addresses.address()
    }

    /// What changes in the tables of placements with those of `scene`, the scene of these tables at another pose.
    pub(crate) fn changes(&self, scene: &Scene) -> (Change<layout::Instance>, Change<layout::ShapeInstance>) {
        (self.instances.change_to(scene), self.shape_instances.change_to(scene))
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
