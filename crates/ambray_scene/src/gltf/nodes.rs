//! The node hierarchy: world transforms of all nodes and the nodes a scene shows. Nothing here recurses.

use glam::{Affine3A, DAffine3, DMat3, DQuat, DVec3};

use crate::error::{Fault, Outcome};
use crate::load::SceneChoice;

use super::document::missing;
use super::json::{Index, Node, Root};

/// World transform of every node, in double precision so that long chains stay exact.
pub(super) fn world_transforms(root: &Root) -> Outcome<Vec<DAffine3>> {
    let parents = parents(root)?;
    let mut world = vec![DAffine3::IDENTITY; root.nodes.len()];
    let mut placed = 0;
    let mut pending: Vec<Index> = (0..root.nodes.len()).filter(|&node| parents[node].is_none()).collect();
    while let Some(index) = pending.pop() {
        let node = &root.nodes[index];
        let local = local_transform(node, index)?;
        world[index] = parents[index].map_or(local, |parent| world[parent] * local);
        placed += 1;
        pending.extend(&node.children);
    }
    // With at most one parent each, nodes that cannot be reached from a root form cycles.
    if placed < root.nodes.len() {
        let on_cycle = on_cycle(&parents);
        return Err(Fault::invalid(format!("nodes[{on_cycle}]"), "node is its own ancestor"));
    }
    Ok(world)
}

/// Parent of every node; refuses nodes that have two.
pub(super) fn parents(root: &Root) -> Outcome<Vec<Option<Index>>> {
    let mut parents = vec![None; root.nodes.len()];
    for (index, node) in root.nodes.iter().enumerate() {
        for (i, &child) in node.children.iter().enumerate() {
            let at = || format!("nodes[{index}].children[{i}]");
            let parent = parents.get_mut(child).ok_or_else(|| missing(&at(), "node", child))?;
            if let Some(other) = parent.replace(index) {
                return Err(Fault::invalid(at(), format!("node {child} is a child of node {other} already")));
            }
        }
    }
    Ok(parents)
}

/// A node of a cycle, given that there is one: climbing from any unreachable node ends up in it.
fn on_cycle(parents: &[Option<Index>]) -> Index {
    // 0: not seen, otherwise the number of the climb that saw it.
    let mut seen = vec![0_usize; parents.len()];
    for start in 0..parents.len() {
        let mut at = Some(start);
        while let Some(node) = at.filter(|&node| seen[node] == 0) {
            seen[node] = start + 1;
            at = parents[node];
        }
        if let Some(node) = at.filter(|&node| seen[node] == start + 1) {
            return node;
        }
    }
    0
}

fn local_transform(node: &Node, index: Index) -> Outcome<DAffine3> {
    if let Some(m) = node.matrix {
        let column = |i: usize| DVec3::new(m[4 * i], m[4 * i + 1], m[4 * i + 2]);
        return Ok(DAffine3 {
            matrix3: DMat3::from_cols(column(0), column(1), column(2)),
            translation: column(3),
        });
    }
    let rotation = match node.rotation.map(DQuat::from_array) {
        None => DQuat::IDENTITY,
        Some(q) if q.length_squared() > 0.0 => q.normalize(),
        Some(_) => {
            return Err(Fault::invalid(format!("nodes[{index}].rotation"), "quaternion of length zero"));
        }
    };
    let scale = node.scale.map_or(DVec3::ONE, DVec3::from_array);
    let translation = node.translation.map_or(DVec3::ZERO, DVec3::from_array);
    Ok(DAffine3::from_scale_rotation_translation(scale, rotation, translation))
}

/// Nodes shown by the chosen scene, parents before children, in the order of the file.
pub(super) fn visible(root: &Root, choice: Option<&SceneChoice>) -> Outcome<Vec<Index>> {
    let scene = match choice {
        None => root.scene.or(if root.scenes.is_empty() { None } else { Some(0) }),
        Some(SceneChoice::Index(index)) => Some(*index),
        Some(SceneChoice::Name(name)) => {
            let found = root.scenes.iter().position(|scene| scene.name.as_deref() == Some(name));
            Some(found.ok_or_else(|| no_such_scene(root, &crate::error::quoted(name)))?)
        }
    };
    let roots = match scene {
        Some(index) => {
            let scene = root.scenes.get(index).ok_or_else(|| no_such_scene(root, &index.to_string()))?;
            scene.nodes.clone()
        }
        None => {
            let mut is_child = vec![false; root.nodes.len()];
            root.nodes.iter().flat_map(|node| &node.children).for_each(|&child| is_child[child] = true);
            (0..root.nodes.len()).filter(|&node| !is_child[node]).collect()
        }
    };
    let (mut seen, mut order) = (vec![false; root.nodes.len()], Vec::new());
    let mut pending = roots;
    pending.reverse();
    while let Some(index) = pending.pop() {
        if std::mem::replace(&mut seen[index], true) {
            let at = format!("scenes[{}].nodes", scene.unwrap_or_default());
            return Err(Fault::invalid(at, format!("node {index} is reached twice")));
        }
        order.push(index);
        pending.extend(root.nodes[index].children.iter().rev());
    }
    Ok(order)
}

fn no_such_scene(root: &Root, wanted: &str) -> Fault {
    Fault::invalid("scenes", format!("no scene {wanted}, the file has {}", root.scenes.len()))
}

/// `world` in single precision if it can place an instance: finite and invertible.
pub(super) fn placement(world: DAffine3) -> Option<Affine3A> {
    // Volume of the unit cube's image over that of the box with the same edge lengths: scale does not matter, only shear.
    const FLAT: f64 = 1e-12;
    let m = world.matrix3;
    let edges = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
    let volume = m.determinant().abs();
    if volume.is_nan() || volume <= FLAT * edges {
        return None;
    }
    let single = single(world);
    (single.is_finite() && single.inverse().is_finite()).then_some(single)
}

/// Rounds to single precision.
pub(super) fn single(m: DAffine3) -> Affine3A {
    Affine3A { matrix3: m.matrix3.as_mat3().into(), translation: m.translation.as_vec3a() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn root(children: &[&[Index]]) -> Root {
        let node = |&children: &&[Index]| Node {
            children: children.to_vec(),
            translation: Some([1.0, 0.0, 0.0]),
            ..Node::default()
        };
        Root { nodes: children.iter().map(node).collect(), ..Root::default() }
    }

    #[track_caller]
    fn check_refused(children: &[&[Index]], expected: &str) {
        let fault = world_transforms(&root(children)).expect_err("must be refused");
        assert!(fault.in_file(std::path::Path::new("x")).to_string().contains(expected));
    }

    #[test]
    fn hierarchies_that_are_not_trees() {
        check_refused(&[&[0]], "nodes[0]: node is its own ancestor");
        check_refused(&[&[1], &[2], &[3], &[1]], "nodes[3].children[0]: node 1 is a child of node 0");
        check_refused(&[&[], &[2], &[1]], "nodes[1]: node is its own ancestor");
        check_refused(&[&[1, 1], &[]], "node 1 is a child of node 0 already");
        check_refused(&[&[7]], "nodes[0].children[0]: node 7 does not exist");
    }

    #[test]
    fn long_chains_neither_overflow_nor_drift() {
        let count = 200_000;
        let mut root = root(&[]);
        root.nodes = (0..count)
            .map(|i| Node {
                children: if i + 1 < count { vec![i + 1] } else { vec![] },
                translation: Some([0.1, 0.0, 0.0]),
                ..Node::default()
            })
            .collect();
        let world = world_transforms(&root).expect("a chain");
        assert!((world[count - 1].translation.x - 20_000.0).abs() < 1e-6);
        assert_eq!(visible(&root, None).expect("all").len(), count);
    }

    #[test]
    fn order_is_the_file_s() {
        assert_eq!(visible(&root(&[&[3, 1], &[2], &[], &[]]), None).expect("a tree"), [0, 3, 1, 2]);
    }

    #[test]
    fn singular_placements_are_told_apart_from_small_ones() {
        assert!(placement(DAffine3::from_scale(DVec3::splat(1e-6))).is_some());
        assert!(placement(DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0))).is_none());
        assert!(placement(DAffine3::from_scale(DVec3::splat(1e12))).is_some());
        assert!(placement(DAffine3::from_scale(DVec3::splat(1e30))).is_none());
        assert!(placement(DAffine3::from_scale(DVec3::splat(f64::NAN))).is_none());
    }
}
