//! The scene in tables.

use super::declare::structures;

structures! {
    /// Device addresses of the tables of a scene.
    SceneTables {
        /// [`Placement`] of each custom index of the top-level structure.
        placements: u64,
        /// Instance (or none) and triangle of each primitive: `uvec2`.
        refs: u64,
        /// [`Instance`] of each instance with a mesh.
        instances: u64,
        /// [`Mesh`].
        meshes: u64,
        /// [`Material`].
        materials: u64,
        /// [`Texture`].
        textures: u64,
        /// [`ImageLevel`] of all images.
        levels: u64,
        /// RGBA texels of all levels, a byte a channel, red lowest.
        texels: u64,
        /// 256 floats: linear value of an sRGB byte.
        srgb: u64,
        /// `vec3` of each vertex, object space.
        positions: u64,
        /// `vec3` of each vertex that has a normal.
        normals: u64,
        /// `vec4` of each vertex that has a tangent.
        tangents: u64,
        /// `vec2` of each vertex and set of texture coordinates.
        uvs: u64,
        /// `vec4` of each vertex that has a colour.
        colors: u64,
        /// `uvec3` of each triangle: vertices within its mesh.
        triangles: u64,
        /// [`Shape`].
        shapes: u64,
        /// [`ShapeInstance`]; instance numbers of shapes go on where those of meshes end.
        shape_instances: u64,
        /// `instances` as they were in the last frame.
        previous_instances: u64,
        /// `shape_instances` as they were in the last frame.
        previous_shape_instances: u64,
        /// `vec3` of each vertex of a deforming mesh in the last frame; 0 if nothing has moved since.
        previous_positions: u64,
        /// `vec3` of each vertex of a deforming mesh that has a normal, in the last frame; 0 if nothing has moved since.
        previous_normals: u64,
        /// Number of instances with a mesh.
        mesh_instances: u32,
        /// Unused.
        padding: u32,
    }

    /// What an entry of the top-level structure refers to.
    Placement {
        /// First of its entries in `refs`.
        first_ref: u32,
        /// Instance of all its primitives, or none: then `refs` tells.
        instance: u32,
    }

    /// A placed mesh.
    Instance {
        /// Placement, columns.
        world_from_object: [[f32; 3]; 4],
        /// Turns normals; does not keep their length.
        normal_from_object: [[f32; 3]; 3],
        /// -1 where the placement mirrors, else 1.
        side: f32,
        /// Index of the mesh.
        mesh: u32,
        /// A `MOTION_` constant.
        motion: u32,
    }

    /// Where the attributes of a mesh begin in the tables; none where it lacks them.
    Mesh {
        /// In `triangles`.
        first_triangle: u32,
        /// In `positions`.
        first_vertex: u32,
        /// Number of vertices.
        vertices: u32,
        /// In `normals`.
        first_normal: u32,
        /// In `tangents`.
        first_tangent: u32,
        /// In `colors`.
        first_color: u32,
        /// In `uvs`: set after set.
        first_uv: u32,
        /// Number of sets of texture coordinates.
        uv_sets: u32,
        /// Index of the material.
        material: u32,
        /// In `previous_positions`; none if it does not deform.
        previous_vertex: u32,
        /// In `previous_normals`; none if it does not deform or has no normals.
        previous_normal: u32,
    }

    /// Use of a texture by a material.
    TextureUse {
        /// Maps the mesh's texture coordinates to the texture's, columns.
        transform: [[f32; 2]; 3],
        /// Index of the texture, or none.
        texture: u32,
        /// Set of texture coordinates.
        uv_set: u32,
    }

    /// Surface description, linear RGB.
    Material {
        /// Albedo and alpha.
        base_color: [f32; 4],
        /// Emitted radiance.
        emission: [f32; 3],
        /// Kind, a `MATERIAL_` constant.
        kind: u32,
        /// Second colour of a checker.
        checker_color: [f32; 3],
        /// Side of a square of a checker, object units; 0 without one.
        checker_size: f32,
        /// An `ALPHA_` constant.
        alpha_mode: u32,
        /// Cutoff of a mask.
        alpha_cutoff: f32,
        /// Scale of the x and y of the normal map.
        normal_scale: f32,
        /// sRGB base colour and alpha.
        base_color_texture: TextureUse,
        /// Tangent-space normal map.
        normal_texture: TextureUse,
        /// Multiplies the emission.
        emission_texture: TextureUse,
    }

    /// An image with a way to read it.
    Texture {
        /// Full image, in `levels`.
        first_level: u32,
        /// Number of levels.
        level_count: u32,
        /// `WRAP_` constants of u and v.
        wrap: [u32; 2],
        /// `TEXEL_` constant where magnified.
        mag: u32,
        /// `TEXEL_` constant where minified.
        min: u32,
        /// `TEXEL_` constant between levels; none reads level 0 alone.
        mip: u32,
        /// 1 where colour bytes are sRGB.
        srgb: u32,
    }

    /// One level of an image.
    ImageLevel {
        /// Size in texels.
        size: [u32; 2],
        /// In `texels`.
        first_texel: u32,
    }

    /// A procedural shape, object space (`ambray_core::shape`).
    Shape {
        /// A `SHAPE_` constant.
        kind: u32,
        /// Radius; half extent along x; height.
        a: f32,
        /// Half extent along y; radius at the bottom.
        b: f32,
        /// Half extent along z; radius at the top.
        c: f32,
        /// Address of the samples of a field.
        field: u64,
        /// Samples of a field along each axis.
        grid: [u32; 3],
        /// Low corner of a field.
        box_min: [f32; 3],
        /// High corner of a field.
        box_max: [f32; 3],
        /// Unused.
        padding: u32,
    }

    /// A placed shape.
    ShapeInstance {
        /// Placement, columns.
        world_from_object: [[f32; 3]; 4],
        /// Its inverse.
        object_from_world: [[f32; 3]; 4],
        /// Turns normals; does not keep their length.
        normal_from_object: [[f32; 3]; 3],
        /// Largest magnitude of the numbers that its points are computed from.
        reach: f32,
        /// Index of the shape.
        shape: u32,
        /// Index of the material.
        material: u32,
        /// A `MOTION_` constant.
        motion: u32,
    }

    /// A light (`ambray_core::light`).
    Light {
        /// A `LIGHT_` constant.
        kind: u32,
        /// Position, or unit vector towards the light.
        place: [f32; 3],
        /// Irradiance of directional lights, intensity of the others.
        strength: [f32; 3],
        /// Distance at which it has faded to zero.
        range: f32,
        /// Unit axis of a spot light.
        axis: [f32; 3],
        /// Cosine of the angle at which a spot light begins to fade.
        cos_inner: f32,
        /// Cosine of the angle at which it has faded to zero.
        cos_outer: f32,
    }
}
