//! The node hierarchy: the nodes of a rig and the nodes a scene shows. Nothing here recurses.

use glam::{Affine3A, DAffine3, DMat3, DQuat, DVec3};

use crate::animation::{self, Local, Trs, single};
use crate::error::{Fault, Outcome};
use crate::load::SceneChoice;

use super::document::missing;
use super::json::{Index, Node, Root};

/// The nodes in the order that a rig wants.
#[derive(Debug)]
pub(super) struct Hierarchy {
    /// Nodes of the file, parents before their children.
    order: Vec<Index>,
    /// Parent of every node of the file.
    parents: Vec<Option<Index>>,
    /// Index of every node of the file in the rig.
    pub(super) rank: Vec<u32>,
}

impl Hierarchy {
    /// Follows the children; refuses cycles and nodes with two parents.
    pub(super) fn of(root: &Root) -> Outcome<Self> {
        let parents = parents(root)?;
        let mut order = Vec::with_capacity(root.nodes.len());
        let mut rank = vec![0; root.nodes.len()];
        let mut pending: Vec<Index> =
            (0..root.nodes.len()).rev().filter(|&node| parents[node].is_none()).collect();
        while let Some(index) = pending.pop() {
            rank[index] = order.len() as u32; // each takes bytes of the file
            order.push(index);
            pending.extend(root.nodes[index].children.iter().rev());
        }
        // With at most one parent each, nodes that cannot be reached from a root form cycles.
        if order.len() < root.nodes.len() {
            let on_cycle = on_cycle(&parents);
            return Err(Fault::invalid(format!("nodes[{on_cycle}]"), "node is its own ancestor"));
        }
        Ok(Self { order, parents, rank })
    }

    /// The nodes of a rig, without morph weights.
    pub(super) fn nodes(&self, root: &Root) -> Outcome<Vec<animation::Node>> {
        let node = |&index: &Index| {
            Ok(animation::Node {
                name: root.nodes[index].name.clone().unwrap_or_default(),
                parent: self.parents[index].map(|parent| self.rank[parent]),
                local: local(&root.nodes[index], index)?,
                weights: Vec::new(),
            })
        };
        self.order.iter().map(node).collect()
    }
}

/// Parent of every node; refuses nodes that have two.
fn parents(root: &Root) -> Outcome<Vec<Option<Index>>> {
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

fn local(node: &Node, index: Index) -> Outcome<Local> {
    if let Some(m) = node.matrix {
        let column = |i: usize| DVec3::new(m[4 * i], m[4 * i + 1], m[4 * i + 2]);
        let matrix3 = DMat3::from_cols(column(0), column(1), column(2));
        return Ok(Local::Matrix(DAffine3 { matrix3, translation: column(3) }));
    }
    let rotation = match node.rotation {
        None => DQuat::IDENTITY,
        Some(q) => unit_quaternion(q)
            .ok_or_else(|| Fault::invalid(format!("nodes[{index}].rotation"), "quaternion of length zero"))?,
    };
    let scale = node.scale.map_or(DVec3::ONE, DVec3::from_array);
    let translation = node.translation.map_or(DVec3::ZERO, DVec3::from_array);
    Ok(Local::Trs(Trs { translation, rotation, scale }))
}

/// `q` scaled to length 1, unless it is zero or not finite.
fn unit_quaternion(q: [f64; 4]) -> Option<DQuat> {
    // Scaled before squaring, so that neither tiny nor huge numbers leave the range.
    let q = DQuat::from_array(q);
    let largest = q.to_array().into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let scaled = q * (1.0 / largest);
    let unit = scaled * (1.0 / scaled.length());
    unit.is_finite().then_some(unit)
}

/// Translation, rotation and scale that make up `matrix`, as far as it has them: not where it shears or is flat.
pub(super) fn decompose(matrix: &DAffine3) -> Option<Trs> {
    /// Deviation from the matrix, relative to its largest column: rounding of single precision.
    const DEVIATION: f64 = 1e-6;
    let m = matrix.matrix3;
    let lengths = DVec3::new(m.x_axis.length(), m.y_axis.length(), m.z_axis.length());
    // A mirroring is a negative scale; along which axis does not matter.
    let scale = if m.determinant() < 0.0 { lengths * DVec3::new(-1.0, 1.0, 1.0) } else { lengths };
    let axes = DMat3::from_cols(m.x_axis / scale.x, m.y_axis / scale.y, m.z_axis / scale.z);
    if !axes.is_finite() {
        return None;
    }
    let rotation = unit_quaternion(DQuat::from_mat3(&axes).to_array())?;
    let parts = Trs { translation: matrix.translation, rotation, scale };
    let again = Local::Trs(parts).matrix().matrix3;
    let tolerance = DEVIATION * lengths.max_element();
    let near = again.to_cols_array().iter().zip(m.to_cols_array()).all(|(a, b)| (a - b).abs() <= tolerance);
    near.then_some(parts)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::animation::Rig;

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
        let fault = Hierarchy::of(&root(children)).expect_err("must be refused");
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
        let nodes = Hierarchy::of(&root).and_then(|hierarchy| hierarchy.nodes(&root)).expect("a chain");
        let world = Rig { nodes, ..Rig::default() }.pose(None).world;
        assert!((world[count - 1].translation.x - 20_000.0).abs() < 1e-6);
        assert_eq!(visible(&root, None).expect("all").len(), count);
    }

    #[test]
    fn rigs_have_parents_first() {
        let root = root(&[&[], &[0, 3], &[], &[2]]);
        let hierarchy = Hierarchy::of(&root).expect("a tree");
        assert_eq!(hierarchy.rank, [1, 0, 3, 2]);
        let nodes = hierarchy.nodes(&root).expect("sound nodes");
        let parents: Vec<_> = nodes.iter().map(|node| node.parent).collect();
        assert_eq!(parents, [None, Some(0), Some(0), Some(2)]);
    }

    #[test]
    fn matrices_without_shear_fall_into_parts() {
        let parts = Trs {
            translation: DVec3::new(1.0, 2.0, 3.0),
            rotation: DQuat::from_rotation_y(2.0) * DQuat::from_rotation_x(0.3),
            scale: DVec3::new(-0.5, 2.0, 30.0),
        };
        let found = decompose(&Local::Trs(parts).matrix()).expect("no shear");
        assert!(found.translation == parts.translation && found.scale.abs_diff_eq(parts.scale, 1e-12));
        assert!(found.rotation.dot(parts.rotation).abs() > 1.0 - 1e-12);
        let mut matrix = DAffine3::IDENTITY;
        matrix.matrix3.y_axis.x = 1e-3;
        assert_eq!(decompose(&matrix), None);
        assert_eq!(decompose(&DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0))), None);
        assert_eq!(decompose(&DAffine3::from_scale(DVec3::NAN)), None);
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
