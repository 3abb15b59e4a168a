//! Parallel locally-ordered clustering (Meister and Bittner 2018, "Parallel Locally-Ordered Clustering for Bounding Volume
//! Hierarchy Construction"): the primitives lie along a Morton curve; each cluster looks for the neighbour with which it
//! would have the smallest box, pairs that choose each other become one cluster, until a single one is left.
//!
//! Trees do not depend on the number of threads: every choice has a total order, and every place is computed beforehand.

use glam::Vec3A;
use rayon::prelude::*;

use super::binary::{Aabb, Binary};
use super::layout::Child;

/// Clusters that a thread takes at a time.
const CHUNK: usize = 4096;
/// Rounds that look at the next neighbours only: there are many clusters, and most find their partner there.
const SHORT_ROUNDS: usize = 2;
/// A round that pairs fewer than one cluster in so many is replaced by one that pairs neighbours whatever their boxes, so
/// that the number of rounds is bounded even for boxes that all prefer the same one.
const SLOW: usize = 64;

/// Clusters along the curve.
struct Clusters {
    bounds: Vec<Aabb>,
    /// Their nodes, as [`Binary::links`].
    links: Vec<Child>,
}

/// Builds the tree over boxes with finite corners; each cluster looks at `radius` neighbours on each side.
pub(super) fn build(primitives: Vec<Aabb>, radius: usize) -> Binary {
    let count = primitives.len();
    if count == 0 {
        return Binary::default();
    }
    let mut clusters = Clusters::along_curve(&primitives);
    let mut next = Clusters { bounds: primitives, links: vec![Child::ROOT; count] };
    let mut tree = Binary::with_nodes(2 * count - 1);
    let mut preferences = vec![0; count];
    // Nodes are filled from the last to the first, so that the root is in front.
    let (mut unused, mut live, mut round) = (2 * count - 1, count, 0);
    while live > 1 {
        let preferences = &mut preferences[..live];
        prefer(&clusters.bounds[..live], preferences, if round < SHORT_ROUNDS { 1 } else { radius });
        let mut sizes = sizes(preferences);
        if sizes.iter().map(|size| size.pairs).sum::<usize>() * SLOW < live {
            prefer_next(preferences);
            sizes = self::sizes(preferences);
        }
        (unused, live) = merge(&clusters, preferences, &sizes, &mut next, &mut tree, unused);
        std::mem::swap(&mut clusters, &mut next);
        round += 1;
    }
    (tree.bounds[0], tree.links[0]) = (clusters.bounds[0], clusters.links[0]);
    tree
}

impl Clusters {
    /// One cluster a primitive, ordered by the Morton codes of the centres.
    fn along_curve(primitives: &[Aabb]) -> Self {
        let all = primitives
            .par_iter()
            .with_min_len(CHUNK)
            .map(|b| {
                let centre = b.lo + b.hi;
                Aabb { lo: centre, hi: centre }
            })
            .reduce(|| Aabb::EMPTY, Aabb::union);
        // Index and code share a word, so that all keys differ; what the index leaves is for the code.
        let index_bits = usize::BITS - primitives.len().leading_zeros();
        let axis_bits = ((u64::BITS - index_bits) / 3).min(21);
        let cells = ((1_u64 << axis_bits) - 1) as f32;
        let scale = Vec3A::splat(cells) / (all.hi - all.lo).max(Vec3A::splat(f32::MIN_POSITIVE));
        let key = |(index, b): (usize, &Aabb)| {
            // A curve through fewer cells is no error: rounding may take a centre out of its cell.
            let cell = ((b.lo + b.hi - all.lo) * scale).min(Vec3A::splat(cells)).max(Vec3A::ZERO);
            let [x, y, z] = cell.to_array().map(|c| spread(c as u64));
            (x << 2 | y << 1 | z) << index_bits | index as u64
        };
        let mut keys: Vec<_> = primitives.par_iter().with_min_len(CHUNK).enumerate().map(key).collect();
        keys.par_sort_unstable();
        let index = |key: &u64| (key & ((1 << index_bits) - 1)) as usize;
        let sorted = keys.par_iter().with_min_len(CHUNK);
        Self {
            bounds: sorted.clone().map(|key| primitives[index(key)]).collect(),
            links: sorted.map(|key| Child::leaf(index(key))).collect(),
        }
    }
}

/// Puts two zeros above each of the lower 21 bits.
const fn spread(x: u64) -> u64 {
    let x = (x | x << 32) & 0x001f_0000_0000_ffff;
    let x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    let x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    let x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

/// Writes to each cluster what it prefers: the area of the common box in the upper half, and in the lower half i ⊕ j of the
/// partners' indices. This is the same number for both, so two prefer each other if their numbers are equal, and of equal
/// areas those are preferred that find each other.
fn prefer(bounds: &[Aabb], preferences: &mut [u64], radius: usize) {
    preferences.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, preferences)| {
        let start = chunk * CHUNK;
        // Neighbours outside of the chunk get places too, which are thrown away.
        let first = start.saturating_sub(radius);
        let last = (start + preferences.len() + radius).min(bounds.len());
        let mut best = vec![u64::MAX; last - first];
        for i in first..start + preferences.len() {
            let end = (i + radius + 1).min(bounds.len());
            let mut mine = best[i - first];
            for (j, other) in (i + 1..end).zip(&bounds[i + 1..end]) {
                let area = bounds[i].union(*other).half_area();
                let preference = u64::from(area.to_bits()) << 32 | (i ^ j) as u64;
                mine = mine.min(preference);
                let theirs = &mut best[j - first];
                *theirs = preference.min(*theirs);
            }
            best[i - first] = mine;
        }
        preferences.copy_from_slice(&best[start - first..][..preferences.len()]);
    });
}

/// Makes each cluster prefer its neighbour.
fn prefer_next(preferences: &mut [u64]) {
    for pair in preferences.chunks_mut(2) {
        // A single one at the end finds nobody.
        pair.fill(if pair.len() == 2 { 1 } else { u64::MAX });
    }
}

/// Whom cluster `i` becomes one with.
#[inline]
fn partner(preferences: &[u64], i: usize) -> Option<usize> {
    let j = i ^ (preferences[i] as u32) as usize;
    (preferences.get(j) == Some(&preferences[i])).then_some(j)
}

/// What a chunk leaves.
struct Size {
    clusters: usize,
    pairs: usize,
}

fn sizes(preferences: &[u64]) -> Vec<Size> {
    let chunks = (0..preferences.len()).into_par_iter().step_by(CHUNK);
    let size = |start: usize| {
        let end = (start + CHUNK).min(preferences.len());
        let (mut left, mut right) = (0, 0);
        for i in start..end {
            if let Some(j) = partner(preferences, i) {
                left += usize::from(i < j);
                right += usize::from(i > j);
            }
        }
        Size { clusters: end - start - right, pairs: left }
    };
    chunks.map(size).collect()
}

/// Makes pairs one cluster each, at the place of the left one, and puts their nodes in front of the `unused`-th. Returns
/// what is unused now, and how many clusters there are.
fn merge(
    clusters: &Clusters,
    preferences: &[u64],
    sizes: &[Size],
    next: &mut Clusters,
    tree: &mut Binary,
    mut unused: usize,
) -> (usize, usize) {
    let pairs: usize = sizes.iter().map(|size| size.pairs).sum();
    let live = preferences.len() - pairs;
    let mut next = (&mut next.bounds[..live], &mut next.links[..live]);
    let mut nodes = (&mut tree.bounds[..unused], &mut tree.links[..unused]);
    let mut chunks = Vec::with_capacity(sizes.len());
    for (chunk, size) in sizes.iter().enumerate() {
        unused -= 2 * size.pairs;
        chunks.push(Merge {
            start: chunk * CHUNK,
            bounds: take(&mut next.0, size.clusters),
            links: take(&mut next.1, size.clusters),
            node: unused,
            node_bounds: take_from(&mut nodes.0, unused),
            node_links: take_from(&mut nodes.1, unused),
        });
    }
    chunks.into_par_iter().for_each(|chunk| chunk.run(clusters, preferences));
    (unused, live)
}

/// Cuts the first `count` off a slice.
fn take<'a, T>(slice: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    slice.split_off_mut(..count).expect("chunks fill what is there")
}

/// Cuts all from `start` off a slice.
fn take_from<'a, T>(slice: &mut &'a mut [T], start: usize) -> &'a mut [T] {
    slice.split_off_mut(start..).expect("chunks fill what is there")
}

/// What becomes of a chunk of clusters.
struct Merge<'a> {
    start: usize,
    bounds: &'a mut [Aabb],
    links: &'a mut [Child],
    /// Index of the first of the nodes.
    node: usize,
    node_bounds: &'a mut [Aabb],
    node_links: &'a mut [Child],
}

impl Merge<'_> {
    fn run(self, clusters: &Clusters, preferences: &[u64]) {
        let (mut i, mut pair) = (self.start, 0);
        for (bounds, link) in self.bounds.iter_mut().zip(self.links) {
            // Right ones are where their left ones are.
            while partner(preferences, i).is_some_and(|j| j < i) {
                i += 1;
            }
            (*bounds, *link) = (clusters.bounds[i], clusters.links[i]);
            if let Some(j) = partner(preferences, i) {
                self.node_bounds[pair..pair + 2].copy_from_slice(&[*bounds, clusters.bounds[j]]);
                self.node_links[pair..pair + 2].copy_from_slice(&[*link, clusters.links[j]]);
                (*bounds, *link) = (bounds.union(clusters.bounds[j]), Child::node(self.node + pair));
                pair += 2;
            }
            i += 1;
        }
    }
}
