//! How trees lie in memory.

/// Inner node: the boxes of up to `W` children as structure of arrays, one vector register a plane.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Node<const W: usize> {
    /// Lower x, y, z, upper x, y, z of the children. Empty slots hold the empty box (+∞, −∞), which no ray meets.
    pub(crate) planes: [[f32; W]; 6],
    /// What is in the boxes, see [`Child`].
    pub(crate) children: [Child; W],
}

impl<const W: usize> Node<W> {
    pub(crate) const EMPTY: Self = Self {
        planes: [
            [f32::INFINITY; W],
            [f32::INFINITY; W],
            [f32::INFINITY; W],
            [f32::NEG_INFINITY; W],
            [f32::NEG_INFINITY; W],
            [f32::NEG_INFINITY; W],
        ],
        children: [Child(0); W],
    };
}

/// Reference to a node or a leaf: the top bit says leaf, the rest is its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(crate) struct Child(pub(crate) u32);

impl Child {
    const LEAF: u32 = 1 << 31;
    pub(crate) const ROOT: Self = Self(0);

    pub(crate) fn node(index: usize) -> Self {
        Self(Self::checked(index))
    }

    pub(crate) fn leaf(index: usize) -> Self {
        Self(Self::checked(index) | Self::LEAF)
    }

    fn checked(index: usize) -> u32 {
        u32::try_from(index)
            .ok()
            .filter(|&i| i < Self::LEAF)
            .expect("a tree has fewer than 2^31 nodes and leaves")
    }

    #[inline(always)]
    pub(crate) const fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    #[inline(always)]
    pub(crate) const fn index(self) -> usize {
        (self.0 & !Self::LEAF) as usize
    }
}

/// Triangles that a leaf may have. Most have six: twice as many lanes would mostly be empty, and cost time and memory.
pub(crate) const FAT: usize = 8;

/// Leaf: up to [`FAT`] triangles as structure of arrays.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Block {
    /// `corners[vertex][axis][lane]`. Lanes that are empty, or of triangles that cannot be hit in this pose, hold NaN, which
    /// fails every comparison.
    pub(crate) corners: [[[f32; FAT]; 3]; 3],
    /// Instances of the triangles; unused in trees of meshes that are placed.
    pub(crate) instances: [u32; FAT],
    /// Indices of the triangles in their meshes.
    pub(crate) triangles: [u32; FAT],
    /// Lanes whose candidates the alpha test decides.
    pub(crate) masked: u32,
    /// Filled lanes; they come first.
    pub(crate) count: u32,
}

impl Block {
    pub(crate) const EMPTY: Self = Self {
        corners: [[[f32::NAN; FAT]; 3]; 3],
        instances: [u32::MAX; FAT],
        triangles: [u32::MAX; FAT],
        masked: 0,
        count: 0,
    };
}

/// Tree over triangles; without nodes if there are none. Node 0 is the root.
#[derive(Debug, Default)]
pub(crate) struct Blas<const W: usize> {
    pub(crate) nodes: Vec<Node<W>>,
    pub(crate) blocks: Vec<Block>,
    /// Smallest box around the triangles.
    pub(crate) bounds: Bounds,
    /// In the leaf blocks.
    pub(crate) triangles: usize,
    pub(crate) depth: usize,
    pub(crate) sah_cost: f32,
}

/// Tree over placed meshes, or over shapes; leaves are indices into `instances`.
#[derive(Debug, Default)]
pub(crate) struct Tlas<const W: usize> {
    pub(crate) nodes: Vec<Node<W>>,
    pub(crate) instances: Vec<Placed>,
    pub(crate) depth: usize,
}

/// Instance of a mesh with a tree of its own, or of a shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    pub(crate) object_from_world: glam::Affine3A,
    /// Index among the trees of placed meshes, or among the shapes.
    pub(crate) blas: u32,
    /// Index in the scene.
    pub(crate) instance: u32,
}

/// Axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) lo: glam::Vec3,
    pub(crate) hi: glam::Vec3,
}

impl Bounds {
    pub(crate) const EMPTY: Self = Self { lo: glam::Vec3::INFINITY, hi: glam::Vec3::NEG_INFINITY };

    pub(crate) fn of_points(points: &[glam::Vec3]) -> Self {
        points.iter().fold(Self::EMPTY, |b, &p| Self { lo: b.lo.min(p), hi: b.hi.max(p) })
    }

    pub(crate) fn union(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// Half of the surface area, in f64 so that large scenes do not overflow.
    pub(crate) fn half_area(self) -> f64 {
        let d = (self.hi - self.lo).max(glam::Vec3::ZERO).as_dvec3();
        d.x * d.y + d.y * d.z + d.z * d.x
    }
}

impl Default for Bounds {
    fn default() -> Self {
        Self::EMPTY
    }
}
