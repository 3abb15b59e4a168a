//! A mesh that deforms: the tree in use, and those kept for other poses.

use ambray_scene::{
    Mesh,
    animation::{UpdatePolicy, Updates},
};

use super::sample::Sample;
use crate::Quality;
use crate::bvh::layout::Blas;
use crate::bvh::{build, refit::refit};
use crate::parts;

/// What happens to the trees of one mesh. The tree in use lies apart, where the kernels find it.
#[derive(Debug)]
pub(crate) struct Deforming<const W: usize> {
    /// Index in the scene.
    mesh: u32,
    /// Whether the alpha test decides on hits.
    masked: bool,
    /// Poses seen.
    clock: u64,
    /// Of the tree in use.
    origin: Origin,
    /// Built in other poses.
    kept: Vec<(Origin, Blas<W>)>,
}

/// How a tree came to be.
#[derive(Debug)]
struct Origin {
    /// Surface-area cost when it was built.
    cost: f64,
    /// The pose in which it was built; `None` unless trees are chosen by it.
    pose: Option<Sample>,
    /// When a pose last ended up with it.
    used: u64,
}

/// What became of the tree in use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fate {
    /// It was refitted.
    Refitted {
        /// Surface-area cost over that of its build.
        decay: f64,
    },
    /// It was built in this pose.
    Rebuilt,
}

impl<const W: usize> Deforming<W> {
    /// Builds the first tree.
    pub(crate) fn build(
        part: &parts::Deforming,
        mesh: &Mesh,
        updates: Updates,
        quality: Quality,
    ) -> (Self, Blas<W>) {
        let (tree, origin) = build_in_pose(mesh, part.masked, updates.policy, quality);
        (Self { mesh: part.mesh, masked: part.masked, clock: 0, origin, kept: Vec::new() }, tree)
    }

    /// Index of the mesh in the scene.
    pub(crate) const fn mesh(&self) -> u32 {
        self.mesh
    }

    /// Trees that are kept and not in use.
    pub(crate) fn others(&self) -> impl Iterator<Item = &Blas<W>> {
        self.kept.iter().map(|(_, tree)| tree)
    }

    /// Makes `tree`, the one in use, one for the vertices that `mesh` has now.
    pub(crate) fn update(
        &mut self,
        tree: &mut Blas<W>,
        mesh: &Mesh,
        updates: Updates,
        quality: Quality,
    ) -> Fate {
        self.clock += 1;
        let fate = self.follow(tree, mesh, updates, quality);
        self.origin.used = self.clock;
        fate
    }

    fn follow(&mut self, tree: &mut Blas<W>, mesh: &Mesh, updates: Updates, quality: Quality) -> Fate {
        let Updates { policy, poor, poses } = updates;
        if policy != UpdatePolicy::Rebuild {
            if policy == UpdatePolicy::Cache {
                self.take_nearest(tree, &Sample::of(mesh));
            }
            let decay = refit(tree, mesh) / self.origin.cost;
            if policy == UpdatePolicy::Refit || decay <= f64::from(poor) {
                return Fate::Refitted { decay };
            }
        }
        if policy == UpdatePolicy::Cache {
            self.make_room(tree, poses);
        }
        (*tree, self.origin) = build_in_pose(mesh, self.masked, policy, quality);
        Fate::Rebuilt
    }

    /// Takes into use the tree that was built nearest to `pose`.
    fn take_nearest(&mut self, tree: &mut Blas<W>, pose: &Sample) {
        let distance =
            |origin: &Origin| origin.pose.as_ref().map_or(f64::INFINITY, |built| built.distance(pose));
        let mut least = distance(&self.origin);
        let mut nearest = None;
        for (i, (origin, _)) in self.kept.iter().enumerate() {
            let distance = distance(origin);
            if distance < least {
                (least, nearest) = (distance, Some(i));
            }
        }
        if let Some(i) = nearest {
            self.swap(tree, i);
        }
    }

    /// Sees to it that the tree in use can be overwritten: puts it among the kept ones or, if those are `poses` already with it,
    /// takes the one into use that was not for the longest time.
    fn make_room(&mut self, tree: &mut Blas<W>, poses: u32) {
        if self.kept.len() + 1 < poses as usize {
            let origin = Origin { cost: 0.0, pose: None, used: 0 };
            self.kept.push((std::mem::replace(&mut self.origin, origin), std::mem::take(tree)));
            return;
        }
        let oldest = (0..self.kept.len()).min_by_key(|&i| self.kept[i].0.used);
        if let Some(i) = oldest.filter(|&i| self.kept[i].0.used < self.origin.used) {
            self.swap(tree, i);
        }
    }

    fn swap(&mut self, tree: &mut Blas<W>, i: usize) {
        let (origin, other) = &mut self.kept[i];
        std::mem::swap(origin, &mut self.origin);
        std::mem::swap(other, tree);
    }
}

fn build_in_pose<const W: usize>(
    mesh: &Mesh,
    masked: bool,
    policy: UpdatePolicy,
    quality: Quality,
) -> (Blas<W>, Origin) {
    let mut tree = build::deforming(mesh, masked, quality);
    let cost = refit(&mut tree, mesh);
    let pose = (policy == UpdatePolicy::Cache).then(|| Sample::of(mesh));
    (tree, Origin { cost, pose, used: 0 })
}
