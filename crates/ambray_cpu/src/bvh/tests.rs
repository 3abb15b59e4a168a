//! What holds for every tree, whoever built it.

use ambray_core::sampling::{pcg, unit_float};
use glam::Vec3;

use super::binary::{Aabb, Binary};
use super::build::{self, Triangle};
use super::collapse::{self, Costs};
use super::layout::{Blas, Bounds, Child, Number};
use super::{ploc, reinsert};
use crate::Quality;

/// Pseudo-random point in the unit cube.
fn point(seed: u32) -> Vec3 {
    Vec3::new(unit_float(pcg(3 * seed)), unit_float(pcg(3 * seed + 1)), unit_float(pcg(3 * seed + 2)))
}

/// Small triangles everywhere, of which each seventh is long.
fn soup(count: u32) -> Vec<Triangle> {
    let triangle = |i: u32| {
        let size = if i.is_multiple_of(7) { 0.7 } else { 0.02 };
        let corner = |k: u32| point(i) + size * point(count + 3 * i + k);
        Triangle { corners: [0, 1, 2].map(corner), instance: 0, triangle: i, masked: false }
    };
    (0..count).map(triangle).collect()
}

fn boxes(triangles: &[Triangle]) -> Vec<Aabb> {
    triangles.iter().map(|t| Aabb::of_points(&t.corners)).collect()
}

/// Kinds of boxes that builders find hard.
fn hard_cases() -> Vec<(&'static str, Vec<Aabb>)> {
    let cube = |lo: f32, hi: f32| Aabb { lo: Vec3::splat(lo).into(), hi: Vec3::splat(hi).into() };
    let many = 20_000;
    vec![
        ("none", Vec::new()),
        ("one", vec![cube(0.0, 1.0)]),
        ("all in one place", vec![cube(1.0, 2.0); many]),
        ("points in one place", vec![cube(1.0, 1.0); many]),
        ("one inside the other", (0..many).map(|i| cube(-(i as f32), i as f32)).collect()),
        ("along a line", (0..many).map(|i| cube(i as f32, i as f32 + 1.0)).collect()),
        ("ever larger", (0..120).map(|i| cube(1.25_f32.powi(i - 60), 1.25_f32.powi(i - 59))).collect()),
        ("far away", (0..many).map(|i| cube(1e12, 1e12 - (i % 7) as f32 * 1e8)).collect()),
        ("soup", boxes(&soup(many as u32))),
    ]
}

/// Checks that each primitive stands in one leaf and that boxes are as small as they can be. Returns the depth.
fn validate(tree: &Binary, primitives: &[Aabb]) -> usize {
    let mut seen = vec![false; primitives.len()];
    let (mut visited, mut deepest) = (0, 0);
    let mut pending: Vec<_> = (0..tree.links.len().min(1)).map(|root| (root, 1)).collect();
    while let Some((node, depth)) = pending.pop() {
        visited += 1;
        deepest = deepest.max(depth);
        let link = tree.links[node];
        if link.is_leaf() {
            assert!(!std::mem::replace(&mut seen[link.index()], true), "primitive {} again", link.index());
            assert_eq!(tree.bounds[node], primitives[link.index()]);
        } else {
            let children = tree.children(node);
            let [left, right] = children.map(|child| tree.bounds[child]);
            assert_eq!(tree.bounds[node], left.union(right));
            pending.extend(children.map(|child| (child, depth + 1)));
        }
    }
    assert!(seen.into_iter().all(|seen| seen));
    assert_eq!(visited, tree.links.len());
    deepest
}

fn surface_area_cost(tree: &Binary) -> f64 {
    let inner = (0..tree.links.len()).filter(|&node| !tree.links[node].is_leaf());
    inner.map(|node| f64::from(tree.bounds[node].half_area())).sum()
}

#[test]
fn clustering_finds_a_place_for_every_primitive() {
    for (name, boxes) in hard_cases() {
        for radius in [1, 6, 24] {
            let tree = ploc::build(boxes.clone(), radius);
            let depth = validate(&tree, &boxes);
            println!("{name}, radius {radius}: depth {depth}");
        }
    }
}

#[test]
fn boxes_in_one_place_make_a_flat_tree() {
    let boxes = vec![Bounds { lo: Vec3::ONE, hi: Vec3::splat(2.0) }.into(); 1 << 14];
    // Pairs of pairs of pairs.
    assert_eq!(validate(&ploc::build(boxes.clone(), 14), &boxes), 15);
}

#[test]
fn reinsertion_keeps_trees_whole_and_makes_them_better() {
    for (name, boxes) in hard_cases() {
        let mut tree = ploc::build(boxes.clone(), 2);
        let before = surface_area_cost(&tree);
        reinsert::optimize(&mut tree, 1.0);
        validate(&tree, &boxes);
        let after = surface_area_cost(&tree);
        assert!(after <= before * (1.0 + 1e-6), "{name}: from {before} to {after}");
        if name == "soup" {
            assert!(after < 0.95 * before, "from {before} to {after}");
        }
    }
}

/// What every node and leaf costs by being there.
fn storage(tree: &Binary, costs: Costs) -> f64 {
    let primitives = tree.links.iter().filter(|link| link.is_leaf()).count();
    f64::from(costs.storage * tree.bounds[0].half_area()) / primitives as f64
}

/// What a wide tree of least cost costs: by trying all ways to share out the places of a node, without tables.
fn least_cost(tree: &Binary, node: usize, costs: Costs, fat: u32, width: u32) -> f64 {
    fn forest(tree: &Binary, node: usize, roots: u32, costs: Costs, fat: u32, width: u32) -> f64 {
        if roots == 1 {
            return least_cost(tree, node, costs, fat, width);
        }
        let one = least_cost(tree, node, costs, fat, width);
        if tree.links[node].is_leaf() { one } else { one.min(split(tree, node, roots, costs, fat, width)) }
    }
    fn split(tree: &Binary, node: usize, roots: u32, costs: Costs, fat: u32, width: u32) -> f64 {
        let [left, right] = tree.children(node);
        let share = |l: u32| {
            forest(tree, left, l, costs, fat, width) + forest(tree, right, roots - l, costs, fat, width)
        };
        (1..roots).map(share).fold(f64::INFINITY, f64::min)
    }
    let area = f64::from(tree.bounds[node].half_area());
    let primitives = tree.gather(node, &mut Default::default()).len() as u32;
    let as_leaf = area * f64::from(costs.leaf + costs.primitive * primitives as f32) + storage(tree, costs);
    let as_leaf = if primitives <= fat { as_leaf } else { f64::INFINITY };
    if tree.links[node].is_leaf() {
        return as_leaf;
    }
    let below = split(tree, node, width, costs, fat, width);
    as_leaf.min(below + area * f64::from(costs.node) + storage(tree, costs))
}

/// What a wide tree costs.
fn cost_of<const W: usize>(tree: &Binary, wide: &collapse::Wide<W>, costs: Costs) -> f64 {
    let area = |node: &super::layout::Node<W>, slot: usize| {
        let [x, y, z] =
            [0, 1, 2].map(|axis| f64::from(node.planes[axis + 3][slot] - node.planes[axis][slot]));
        x * y + y * z + z * x
    };
    let mut sum = f64::from(tree.bounds[0].half_area() * costs.node) + storage(tree, costs);
    for node in &wide.nodes {
        for (slot, child) in node.children.iter().enumerate().filter(|(_, child)| **child != Child::ROOT) {
            let cost = if child.is_leaf() {
                let leaf = wide.leaves[child.index()] as usize;
                costs.leaf + costs.primitive * tree.gather(leaf, &mut Default::default()).len() as f32
            } else {
                costs.node
            };
            sum += area(node, slot) * f64::from(cost) + storage(tree, costs);
        }
    }
    sum
}

#[test]
fn no_wide_tree_is_cheaper_than_the_chosen_one() {
    for count in [2, 5, 9, 12] {
        let tree = ploc::build(boxes(&soup(count)), 3);
        for costs in [Costs::TRIANGLES, Costs { node: 1.0, leaf: 0.2, primitive: 0.5, storage: 0.0 }] {
            // A root stands even where a leaf would be cheaper; a fat of 1 leaves no doubt.
            for fat in [1, 3] {
                let least = least_cost(&tree, 0, costs, fat.min(count - 1), 4);
                let chosen =
                    cost_of(&tree, &collapse::collapse::<4>(&tree, costs, fat.min(count - 1)), costs);
                assert!((chosen - least).abs() < 1e-5 * least, "{count}, {costs:?}: {chosen}, {least}");
            }
        }
    }
}

/// Checks that each triangle stands in one block, that nodes lie in depth-first order and that boxes contain.
fn validate_wide<const W: usize>(tree: &Blas<W>, triangles: &[Triangle]) {
    let mut seen = vec![false; triangles.len()];
    let (mut next_node, mut next_block) = (1, 0);
    let mut pending = if tree.nodes.is_empty() { Vec::new() } else { vec![(Child::ROOT, tree.bounds)] };
    while let Some((child, bounds)) = pending.pop() {
        if child.is_leaf() {
            let (index, count) = child.in_block();
            assert_eq!(index, next_block);
            next_block += 1;
            let block = &tree.blocks[index];
            for lane in 0..count as usize {
                let index = block.triangles[lane].index() as usize;
                assert!(!std::mem::replace(&mut seen[index], true));
                for (k, corner) in triangles[index].corners.iter().enumerate() {
                    assert_eq!(block.corners[k].map(|axis| axis[lane]), corner.to_array());
                    assert!(corner.cmpge(bounds.lo).all() && corner.cmple(bounds.hi).all());
                }
            }
            continue;
        }
        if child != Child::ROOT {
            assert_eq!(child.index(), next_node);
            next_node += 1;
        }
        let node = &tree.nodes[child.index()];
        let bounds_of = |slot: usize| Bounds {
            lo: Vec3::from_array([0, 1, 2].map(|plane: usize| node.planes[plane][slot])),
            hi: Vec3::from_array([3, 4, 5].map(|plane: usize| node.planes[plane][slot])),
        };
        let all = (0..W).map(bounds_of).fold(Bounds::EMPTY, Bounds::union);
        assert_eq!(all, bounds);
        let used = node.children.iter().take_while(|&&child| child != Child::ROOT).count();
        pending.extend((0..used).rev().map(|slot| (node.children[slot], bounds_of(slot))));
    }
    assert_eq!((next_node, next_block), (tree.nodes.len().max(1), tree.blocks.len()));
    assert!(seen.into_iter().all(|seen| seen));
}

#[test]
fn wide_trees_hold_every_triangle_once() {
    for count in [0, 1, 2, 7, 8, 9, 16, 17, 300, 20_000] {
        for quality in Quality::ALL {
            let triangles = soup(count);
            validate_wide(&build::blas::<8>(&triangles, quality), &triangles);
            validate_wide(&build::blas::<16>(&triangles, quality), &triangles);
        }
    }
}

/// All that is in a tree, as bits.
fn fingerprint(tree: &Blas<8>) -> Vec<u32> {
    let nodes = tree.nodes.iter().flat_map(|node| {
        let planes = node.planes.as_flattened().iter().map(|plane| plane.to_bits());
        planes.chain(node.children.iter().map(|child| child.0)).collect::<Vec<_>>()
    });
    nodes.chain(tree.blocks.iter().flat_map(|block| block.triangles.map(Number::index))).collect()
}

#[test]
fn trees_do_not_depend_on_the_number_of_threads() {
    // Enough for several chunks, and many of equal size, so that ties are broken.
    let mut triangles = soup(30_000);
    triangles.extend_from_within(..);
    for quality in Quality::ALL {
        let build = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
            pool.install(|| fingerprint(&build::blas(&triangles, quality)))
        };
        let one = build(1);
        for threads in [2, 3, 16] {
            assert!(build(threads) == one, "{quality:?}, {threads} threads");
        }
    }
}

#[test]
fn the_tree_of_a_surface_stays_small() {
    // Full nodes and blocks of 16 would have 55 bytes a triangle; leaves are to be filled by a third at least.
    let height =
        |x: u32, y: u32| Vec3::new(x as f32, (x as f32 * 0.1).sin() * (y as f32 * 0.07).sin(), y as f32);
    let corners = (0..100_u32 * 100).map(|i| (i % 100, i / 100)).flat_map(|(x, y)| {
        let [a, b, c, d] = [height(x, y), height(x + 1, y), height(x, y + 1), height(x + 1, y + 1)];
        [[a, b, c], [b, d, c]]
    });
    let triangles: Vec<_> = (0..)
        .zip(corners)
        .map(|(triangle, corners)| Triangle { corners, instance: 0, triangle, masked: false })
        .collect();
    let tree = build::blas::<16>(&triangles, Quality::Balanced);
    let bytes = size_of_val(&tree.nodes[..]) + size_of_val(&tree.blocks[..]);
    assert!(bytes < 3 * 55 * triangles.len(), "{bytes} bytes for {} triangles", triangles.len());
}

#[test]
fn the_quick_test_of_areas_never_errs() {
    let mut quick = 0;
    for i in 0..100_000 {
        // From whole triangles down to slivers that rounding makes lines of, near and far, large and tiny.
        let (a, p, scale) = (point(i) * 8.0, point(i + 1), 2_f32.powi((i % 200) as i32 - 100));
        let along = 3.0 * unit_float(pcg(i));
        let off = Vec3::splat(0.1_f32.powi((i % 13) as i32)) * point(i + 2);
        let corners = [a, a + p, a + p * along + off].map(|corner| corner * scale);
        if build::has_much_area(&corners) {
            assert!(build::has_area(&corners), "{corners:?}");
            quick += 1;
        }
    }
    assert!(quick > 20_000, "it says yes {quick} times");
    for corners in
        [[Vec3::ONE; 3], [Vec3::ZERO, Vec3::ONE, 2.0 * Vec3::ONE], [Vec3::ZERO, Vec3::NAN, Vec3::X]]
    {
        assert!(!build::has_much_area(&corners));
    }
}
