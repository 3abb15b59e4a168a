//! What deforms meshes, and what tells how well their structures still fit.

use super::declare::structures;

structures! {
    /// A deforming mesh at one pose (`ambray_scene::animation::Deformer`). Addresses of what it lacks are 0.
    Deformation {
        /// `vec3` of each vertex at rest.
        rest_positions: u64,
        /// `vec3` of each vertex at rest.
        rest_normals: u64,
        /// `vec4` of each vertex at rest.
        rest_tangents: u64,
        /// [`Target`]s whose weight is not 0.
        targets: u64,
        /// [`Influence`]s of each vertex, one vertex after the other.
        influences: u64,
        /// `mat4x3` of each joint of its skin.
        joints: u64,
        /// `vec3` of each vertex: written.
        positions: u64,
        /// `vec3` of each vertex: written.
        normals: u64,
        /// `vec4` of each vertex: written.
        tangents: u64,
        /// Box of the vertices, [`BOX_WORDS`](super::BOX_WORDS) words that are ordered as the numbers are: lowered.
        bounds: u64,
        /// Number of vertices.
        vertices: u32,
        /// Number of targets.
        target_count: u32,
        /// Influences of a vertex; 0 without a skin.
        influences_per_vertex: u32,
        /// Unused.
        padding: u32,
    }

    /// A morph target with its weight. Addresses of attributes that it leaves alone are 0.
    Target {
        /// `vec3` of each vertex.
        positions: u64,
        /// `vec3` of each vertex.
        normals: u64,
        /// `vec3` of each vertex.
        tangents: u64,
        /// Weight, not 0.
        weight: f32,
        /// Unused.
        padding: u32,
    }

    /// Pull of a joint on a vertex.
    Influence {
        /// Joint within the skin.
        joint: u32,
        /// Weight.
        weight: f32,
    }

    /// The triangles of a deforming mesh in clusters, which stand for the inner nodes of its structure.
    Clusters {
        /// `vec3` of each vertex.
        positions: u64,
        /// `uvec3` of each triangle: vertices.
        triangles: u64,
        /// `uint` of each triangle: its cluster.
        clusters: u64,
        /// Box and number of triangles less 1 of each cluster: [`CLUSTER_WORDS`](super::CLUSTER_WORDS) words.
        boxes: u64,
        /// Box of all vertices, [`BOX_WORDS`](super::BOX_WORDS) words.
        bounds: u64,
        /// `float`: where the cost goes.
        cost: u64,
        /// Number of triangles.
        triangle_count: u32,
        /// Clusters along each axis.
        side: u32,
    }
}

/// Bits by which floats are ordered as unsigned numbers: what atomic minima need.
pub(crate) const fn ordered(x: f32) -> u32 {
    let bits = x.to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}

/// The float of these bits.
pub(crate) const fn unordered(bits: u32) -> f32 {
    f32::from_bits(if bits >> 31 == 1 { bits & !(1 << 31) } else { !bits })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_is_that_of_the_numbers() {
        let numbers = [f32::MIN, -1e12, -1.0, -1e-40, -0.0, 0.0, 1e-40, 1.0, 1e12, f32::MAX];
        assert!(numbers.windows(2).all(|pair| ordered(pair[0]) < ordered(pair[1])));
        assert!(numbers.iter().all(|&x| unordered(ordered(x)).to_bits() == x.to_bits()));
        assert!(ordered(f32::MAX) < u32::MAX, "a word with all bits set is above every number");
    }
}
