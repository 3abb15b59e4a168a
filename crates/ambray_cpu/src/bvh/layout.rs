//! How trees lie in memory.

use super::names::Names;

/// Inner node: the boxes of up to `W` children as structure of arrays, one vector register a plane.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Node<const W: usize> {
    /// Lower x, y, z, upper x, y, z of the children. Empty slots hold the empty box (+∞, −∞), which no ray meets.
    pub(crate) planes: [[f32; W]; 6],
    /// What is in the boxes.
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

/// Reference to a node or a leaf: the top bit says leaf, the rest is its index. Leaves that are [blocks](Block) have less one
/// than the number of their triangles in the three bits below the top.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(crate) struct Child(pub(crate) u32);

impl Child {
    const LEAF: u32 = 1 << 31;
    const COUNT: u32 = 28;
    pub(crate) const ROOT: Self = Self(0);

    pub(crate) fn node(index: usize) -> Self {
        Self(Self::checked(index))
    }

    pub(crate) fn leaf(index: usize) -> Self {
        Self(Self::checked(index) | Self::LEAF)
    }

    /// A leaf block of `count` triangles, 1 to [`FAT`].
    pub(crate) fn block(index: usize, count: usize) -> Self {
        assert!(
            index < 1 << Self::COUNT && (1..=FAT).contains(&count),
            "a tree has fewer than 2^28 leaf blocks"
        );
        Self(Self::LEAF | (count as u32 - 1) << Self::COUNT | index as u32)
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

    /// Index of a leaf block, and its triangles.
    #[inline(always)]
    pub(crate) const fn in_block(self) -> (usize, u32) {
        ((self.0 & ((1 << Self::COUNT) - 1)) as usize, (self.0 >> Self::COUNT & 7) + 1)
    }
}

/// Triangles that a leaf may have. Most have six: twice as many lanes would mostly be empty, and cost time and memory.
pub(crate) const FAT: usize = 8;

/// Leaf: up to [`FAT`] triangles as structure of arrays; five cache lines. Filled lanes come first.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Block {
    /// `corners[vertex][axis][lane]`. Lanes that are empty, or of triangles that cannot be hit in this pose, hold NaN, which
    /// fails every comparison.
    pub(crate) corners: [[[f32; FAT]; 3]; 3],
    pub(crate) triangles: [Number; FAT],
}

/// Which triangle is in a lane: its index in the mesh, or, in the tree of baked triangles, what [`Names`] tells. The top bit
/// says that the alpha test decides on its hits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(crate) struct Number(u32);

impl Number {
    const MASKED: u32 = 1 << 31;
    const NONE: Self = Self(u32::MAX);

    pub(crate) fn new(index: u32, masked: bool) -> Self {
        assert!(index < Self::MASKED, "a tree has fewer than 2^31 triangles");
        Self(index | if masked { Self::MASKED } else { 0 })
    }

    #[inline(always)]
    pub(crate) const fn index(self) -> u32 {
        self.0 & !Self::MASKED
    }

    #[inline(always)]
    pub(crate) const fn is_masked(self) -> bool {
        self.0 & Self::MASKED != 0
    }
}

impl Block {
    pub(crate) const EMPTY: Self =
        Self { corners: [[[f32::NAN; FAT]; 3]; 3], triangles: [Number::NONE; FAT] };
}

/// Tree over triangles; without nodes if there are none. Node 0 is the root.
#[derive(Debug, Default)]
pub(crate) struct Blas<const W: usize> {
    pub(crate) nodes: Vec<Node<W>>,
    pub(crate) blocks: Vec<Block>,
    /// What the numbers in blocks mean; nothing in trees of one mesh.
    pub(crate) names: Names,
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
