//! Which structures there are, and what is in them.

use ambray_scene::{AlphaMode, Motion, Scene};
use glam::Affine3A;

use super::geometry::{self, Placed};
use super::grouping::{self, Item};
use super::{AccelerationOptions, GeometryKind, Grouping};
use crate::tables::deforming_meshes;

/// A bottom-level structure to be.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Group {
    pub(super) kind: GeometryKind,
    /// Whether every ray sees all of it.
    pub(super) opaque: bool,
    /// Whether its vertices will move against each other.
    pub(super) deforms: bool,
    pub(super) content: Content,
}

/// What a structure consists of. Instances are numbered as in hits: shapes after all meshes.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Content {
    /// The triangles or boxes of several instances, in world space.
    World(Vec<u32>),
    /// A mesh or shape in its own space, and the instances that place it.
    Object(Vec<u32>),
}

/// The structures of a scene.
pub(super) struct Plan {
    pub(super) groups: Vec<Group>,
    /// Overlap of the boxes if each instance were a structure of its own.
    pub(super) overlap: f64,
}

/// Plans the structures of `scene`. Opaque and transparent never share one, nor static and moving, nor meshes and shapes:
/// flags hold for a whole structure, and moving a part would mean to build all of it.
pub(super) fn plan(scene: &Scene, opaque: &[bool], options: &AccelerationOptions) -> Plan {
    let shared = shared_meshes(scene, options);
    let mut groups = Vec::new();
    // The statics, by whether they are opaque; each with its box, and all boxes for the report.
    let mut baked: [Vec<(u32, Item)>; 2] = Default::default();
    let mut shapes: [Vec<(u32, Item)>; 2] = Default::default();
    let mut boxes = Vec::new();

    let mut users: Vec<Vec<u32>> = vec![Vec::new(); scene.meshes.len()];
    let deforming = deforming_meshes(scene);
    for (index, instance) in (0_u32..).zip(&scene.instances) {
        let mesh = instance.mesh as usize;
        if shared[mesh] || deforming[mesh] || instance.motion == Motion::Rigid {
            users[mesh].push(index);
        } else {
            let placed = Placed::new(&scene.meshes[mesh], &instance.world_from_object);
            let (bounds, primitives) = placed.bounds();
            if primitives > 0 {
                baked[usize::from(opaque[mesh])].push((index, Item { bounds, primitives }));
                boxes.push(bounds);
            }
        }
    }
    for (mesh, mut users) in users.into_iter().enumerate().filter(|(_, users)| !users.is_empty()) {
        let deforms = deforming[mesh];
        let (bounds, _) = Placed::new(&scene.meshes[mesh], &Affine3A::IDENTITY).bounds();
        let world = |i: u32| geometry::place(bounds, &scene.instances[i as usize].world_from_object);
        // What cannot be placed now may be placed in another frame; what never can has no structure.
        boxes.extend(users.iter().filter_map(|&i| world(i)));
        let may_show =
            |i: u32| deforms || scene.instances[i as usize].motion != Motion::Static || world(i).is_some();
        users.retain(|&i| may_show(i));
        let is_area = |t: &[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
        let has_triangles =
            if deforms { scene.meshes[mesh].triangles.iter().any(is_area) } else { !bounds.is_empty() };
        if has_triangles && !users.is_empty() {
            let kind = if opaque[mesh] { GeometryKind::Opaque } else { GeometryKind::Masked };
            groups.push(Group { kind, opaque: opaque[mesh], deforms, content: Content::Object(users) });
        }
    }

    let first_shape = scene.instances.len() as u32;
    let mut moving: Vec<Vec<u32>> = vec![Vec::new(); 2 * scene.shapes.len()];
    for (index, instance) in (first_shape..).zip(&scene.shape_instances) {
        let is_opaque = scene.materials[instance.material as usize].alpha_mode == AlphaMode::Opaque;
        let shape = &scene.shapes[instance.shape as usize];
        let bounds = geometry::shape_bounds(shape, instance);
        boxes.extend(bounds);
        if instance.motion != Motion::Static {
            moving[2 * instance.shape as usize + usize::from(is_opaque)].push(index);
        } else if let Some(bounds) = bounds {
            shapes[usize::from(is_opaque)].push((index, Item { bounds, primitives: 1 }));
        }
    }
    for (i, users) in moving.into_iter().enumerate().filter(|(_, users)| !users.is_empty()) {
        let (kind, opaque) = (GeometryKind::Shape, i % 2 == 1);
        groups.push(Group { kind, opaque, deforms: false, content: Content::Object(users) });
    }

    for (opaque, items) in [false, true].into_iter().zip(&baked) {
        let kind = if opaque { GeometryKind::Opaque } else { GeometryKind::Masked };
        groups.extend(world_groups(items, kind, opaque, options.grouping));
    }
    for (opaque, items) in [false, true].into_iter().zip(&shapes) {
        groups.extend(world_groups(items, GeometryKind::Shape, opaque, options.grouping));
    }
    Plan { groups, overlap: super::overlap::overlap(&boxes) }
}

/// Groups in world space of instances with their boxes.
fn world_groups(
    items: &[(u32, Item)],
    kind: GeometryKind,
    opaque: bool,
    grouping: Grouping,
) -> impl Iterator<Item = Group> {
    let parts: Vec<Vec<usize>> = match grouping {
        _ if items.is_empty() => Vec::new(),
        Grouping::Single => vec![(0..items.len()).collect()],
        Grouping::PerMesh if kind != GeometryKind::Shape => (0..items.len()).map(|i| vec![i]).collect(),
        Grouping::Auto | Grouping::PerMesh => {
            grouping::group(&items.iter().map(|(_, item)| *item).collect::<Vec<_>>())
        }
    };
    let members = |part: Vec<usize>| Content::World(part.into_iter().map(|i| items[i].0).collect());
    let groups: Vec<_> = parts
        .into_iter()
        .map(|part| Group { kind, opaque, deforms: false, content: members(part) })
        .collect();
    groups.into_iter()
}

/// Whether the static instances of each mesh share one structure in object space, as those that move rigidly always do.
///
/// They do where there are several, unless the copies are cheap: meshes with the fewest triangles over all static
/// instances are copied, as far as the budget goes. It is the policy of the CPU backend, so that both round the same way.
fn shared_meshes(scene: &Scene, options: &AccelerationOptions) -> Vec<bool> {
    let mut uses = vec![0_u64; scene.meshes.len()];
    for instance in scene.instances.iter().filter(|i| i.motion == Motion::Static) {
        uses[instance.mesh as usize] += 1;
    }
    let mut shared = vec![false; scene.meshes.len()];
    let budget = match options.grouping {
        Grouping::Auto => options.copy_budget,
        Grouping::PerMesh => 0,
        Grouping::Single => u64::MAX,
    };
    let cost = |mesh: usize| uses[mesh].saturating_mul(scene.meshes[mesh].triangles.len() as u64);
    let mut candidates: Vec<_> = (0..uses.len()).filter(|&mesh| uses[mesh] > 1).collect();
    candidates.sort_by_key(|&mesh| (cost(mesh), mesh));
    let mut spent = 0_u64;
    for mesh in candidates {
        spent = spent.saturating_add(cost(mesh));
        shared[mesh] = spent > budget;
    }
    shared
}
