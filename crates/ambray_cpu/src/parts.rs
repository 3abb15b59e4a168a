//! Which triangles of a scene go into which tree.

use std::sync::atomic::{AtomicUsize, Ordering};

use ambray_scene::{Instance, Motion, Scene};
use glam::Affine3A;
use rayon::prelude::*;

use crate::AlphaTest;
use crate::bvh::build::{Triangle, is_hittable};

/// A scene's triangles, sorted by the trees they go into.
pub(crate) struct Parts {
    /// World space, in one tree.
    pub(crate) baked: Vec<Triangle>,
    /// Meshes that deform: a tree each, in object space.
    pub(crate) deforming: Vec<Deforming>,
    /// Meshes that are placed as they are: a tree each, in object space.
    pub(crate) rigid: Vec<Vec<Triangle>>,
    /// What is placed. Trees are numbered deforming ones first.
    pub(crate) placements: Vec<Placement>,
    pub(crate) dropped: usize,
    pub(crate) baked_instances: usize,
}

/// A mesh that deforms.
pub(crate) struct Deforming {
    /// Index in the scene.
    pub(crate) mesh: u32,
    /// Whether the alpha test decides on hits.
    pub(crate) masked: bool,
}

/// An instance of a mesh with a tree of its own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement {
    pub(crate) tree: u32,
    /// Index in the scene.
    pub(crate) instance: u32,
    /// Whether its box may change.
    pub(crate) moves: bool,
}

/// What a scene's rig says about its meshes; without a rig nothing moves.
struct Motions<'a> {
    scene: &'a Scene,
    /// One a mesh: whether it deforms and is to be seen.
    deforms: Vec<bool>,
}

impl<'a> Motions<'a> {
    fn of(scene: &'a Scene) -> Self {
        let mut deforms = vec![false; scene.meshes.len()];
        if let Some(rig) = &scene.rig {
            let mut bent = vec![false; scene.meshes.len()];
            for deformer in &rig.deformers {
                bent[deformer.mesh as usize] = true;
            }
            for instance in &scene.instances {
                let mesh = instance.mesh as usize;
                deforms[mesh] |= bent[mesh] || instance.motion == Motion::Deforming;
            }
        }
        Self { scene, deforms }
    }

    fn of_instance(&self, instance: &Instance) -> Motion {
        match (self.deforms[instance.mesh as usize], &self.scene.rig) {
            (true, _) => Motion::Deforming,
            (false, Some(_)) => instance.motion,
            (false, None) => Motion::Static,
        }
    }

    /// Whether each mesh is shared by its static instances, and how many of those each has.
    fn shared_meshes(&self, bake_budget: u64) -> (Vec<bool>, Vec<u64>) {
        let meshes = &self.scene.meshes;
        let mut uses = vec![0_u64; meshes.len()];
        for instance in self.scene.instances.iter().filter(|i| self.of_instance(i) == Motion::Static) {
            uses[instance.mesh as usize] += 1;
        }
        let cost = |mesh: usize| uses[mesh].saturating_mul(meshes[mesh].triangles.len() as u64);
        let mut candidates: Vec<_> = (0..uses.len()).filter(|&mesh| uses[mesh] > 1).collect();
        candidates.sort_by_key(|&mesh| (cost(mesh), mesh));
        let mut shared = vec![false; uses.len()];
        let mut spent = 0_u64;
        for mesh in candidates {
            spent = spent.saturating_add(cost(mesh));
            shared[mesh] = spent > bake_budget;
        }
        (shared, uses)
    }
}

impl Parts {
    pub(crate) fn of(scene: &Scene, alpha: &dyn AlphaTest, bake_budget: u64) -> Self {
        let motions = Motions::of(scene);
        let (is_shared, uses) = motions.shared_meshes(bake_budget);
        let mut parts = Self {
            baked: Vec::new(),
            deforming: Vec::new(),
            rigid: Vec::new(),
            placements: Vec::new(),
            dropped: 0,
            baked_instances: 0,
        };
        let mut pieces = Pieces::default();
        let mut trees = vec![None; scene.meshes.len()];
        for mesh in (0_u32..).take(scene.meshes.len()).filter(|&mesh| motions.deforms[mesh as usize]) {
            trees[mesh as usize] = Some(parts.deforming.len() as u32);
            parts.deforming.push(Deforming { mesh, masked: !alpha.is_opaque(mesh) });
        }
        for (index, instance) in (0_u32..).zip(&scene.instances) {
            let mesh = instance.mesh as usize;
            let motion = motions.of_instance(instance);
            if motion == Motion::Static && !is_shared[mesh] {
                parts.baked_instances += usize::from(uses[mesh] > 1);
                pieces.add(scene, instance.mesh, index, instance.world_from_object, alpha);
                continue;
            }
            let tree = match trees[mesh] {
                Some(tree) => tree,
                None => {
                    let mut mesh_alone = Pieces::default();
                    mesh_alone.add(scene, instance.mesh, 0, Affine3A::IDENTITY, alpha);
                    parts.rigid.push(mesh_alone.triangles(scene, &mut parts.dropped));
                    *trees[mesh].insert((parts.deforming.len() + parts.rigid.len()) as u32 - 1)
                }
            };
            parts.placements.push(Placement { tree, instance: index, moves: motion != Motion::Static });
        }
        parts.baked = pieces.triangles(scene, &mut parts.dropped);
        parts
    }
}

/// Fewest triangles that are worth another thread.
const GRAIN: usize = 4096;

/// The triangles of an instance.
struct Piece {
    /// How many triangles stand before these.
    start: usize,
    mesh: u32,
    /// What its triangles say they belong to.
    instance: u32,
    tree_from_object: Affine3A,
    masked: bool,
}

/// Triangles of several instances, one behind the other.
#[derive(Default)]
struct Pieces {
    pieces: Vec<Piece>,
    triangles: usize,
}

impl Pieces {
    fn add(
        &mut self,
        scene: &Scene,
        mesh: u32,
        instance: u32,
        tree_from_object: Affine3A,
        alpha: &dyn AlphaTest,
    ) {
        let (start, masked) = (self.triangles, !alpha.is_opaque(mesh));
        self.pieces.push(Piece { start, mesh, instance, tree_from_object, masked });
        self.triangles += scene.meshes[mesh as usize].triangles.len();
    }

    /// All triangles that rays can hit, in order; the others count as dropped.
    fn triangles(&self, scene: &Scene, dropped: &mut usize) -> Vec<Triangle> {
        let all = (0..self.triangles).into_par_iter().with_min_len(GRAIN);
        let lost = AtomicUsize::new(0);
        let triangle = |current: &mut Option<_>, index: usize| {
            let triangle = self.piece_of(index, scene, current).triangle(scene, index);
            if !is_hittable(&triangle.corners) {
                lost.fetch_add(1, Ordering::Relaxed);
            }
            triangle
        };
        let mut triangles: Vec<_> = all.map_init(|| None, triangle).collect();
        let lost = lost.into_inner();
        if lost > 0 {
            triangles.retain(|triangle| is_hittable(&triangle.corners));
        }
        *dropped += lost;
        triangles
    }

    /// The piece with the triangle before which `index` others stand. Neighbours are mostly of the `current` one.
    fn piece_of<'a>(&'a self, index: usize, scene: &Scene, current: &mut Option<&'a Piece>) -> &'a Piece {
        match *current {
            Some(piece) if piece.has(scene, index) => piece,
            _ => {
                let piece = self.pieces.partition_point(|piece| piece.end(scene) <= index);
                current.insert(&self.pieces[piece])
            }
        }
    }
}

impl Piece {
    /// How many triangles stand before what follows.
    fn end(&self, scene: &Scene) -> usize {
        self.start + scene.meshes[self.mesh as usize].triangles.len()
    }

    fn has(&self, scene: &Scene, index: usize) -> bool {
        (self.start..self.end(scene)).contains(&index)
    }

    /// The triangle before which `index` triangles stand.
    fn triangle(&self, scene: &Scene, index: usize) -> Triangle {
        let (mesh, triangle) = (&scene.meshes[self.mesh as usize], index - self.start);
        let corner = |i: u32| self.tree_from_object.transform_point3(mesh.positions[i as usize]);
        Triangle {
            corners: mesh.triangles[triangle].map(corner),
            instance: self.instance,
            triangle: triangle as u32,
            masked: self.masked,
        }
    }
}
