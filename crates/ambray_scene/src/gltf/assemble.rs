//! Puts the parts together: nodes in scene order become instances, cameras and lights.

use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

use glam::{Affine3A, DAffine3, Vec3};

use crate::animation::{Attachment, Deformer, LARGEST_COORDINATE, Rig, Skin, placed};
use crate::error::{Fault, Outcome};
use crate::scene::box_corners;
use crate::warnings::Warnings;
use crate::{Instance, Material, Mesh, Motion, Scene, ShapeInstance, limits};

use super::document::Document;
use super::instancing::instances;
use super::json::{ImplicitSurface, Index, Node, Root};
use super::motion::Moved;
use super::nodes::{Hierarchy, placement};
use super::part::Part;
use super::primitives::read_primitive;
use super::shapes::read_shape;
use super::skins::read_skin;
use super::views;

/// Adds what the `visible` nodes show to `scene`, which has its materials already, as it is at rest. Adds to `rig`, which
/// has its nodes and clips already, what hangs on them.
pub(super) fn assemble(
    doc: &Document<'_>,
    hierarchy: &Hierarchy,
    visible: &[Index],
    rig: &mut Rig,
    scene: &mut Scene,
    warnings: &mut Warnings,
) -> Outcome<()> {
    let mut assembly = Assembly {
        doc,
        hierarchy,
        world: rig.pose(None).world,
        moved: Moved::by_clips(&rig.nodes, &rig.clips),
        rig,
        scene,
        warnings,
        read: HashMap::new(),
        shapes: HashMap::new(),
        skins: HashMap::new(),
        boxes: Vec::new(),
        triangles: 0,
        placed: 0,
    };
    for &index in visible {
        let node = &doc.root.nodes[index];
        if let Some(mesh) = node.mesh {
            assembly.place_mesh(node, index, mesh)?;
        }
        if let Some(surface) = &node.extensions.surface {
            assembly.place_shape(surface, index)?;
        }
        assembly.place_views(node, index)?;
    }
    Ok(())
}

/// A primitive of a mesh.
struct Primitive {
    part: Part,
    /// Scene mesh of the rest shape once it is needed.
    shared: Option<u32>,
}

/// A skin in use.
struct PosedSkin {
    skin: Skin,
    /// Its joint matrices at rest.
    matrices: Vec<Affine3A>,
    /// Index into the rig's skins once a deformer needs it.
    in_rig: std::cell::Cell<Option<u32>>,
}

struct Assembly<'a, 'd> {
    doc: &'a Document<'d>,
    hierarchy: &'a Hierarchy,
    /// World transforms of the rig's nodes at rest.
    world: Vec<DAffine3>,
    moved: Moved,
    rig: &'a mut Rig,
    scene: &'a mut Scene,
    warnings: &'a mut Warnings,
    /// Primitives by glTF mesh.
    read: HashMap<Index, Vec<Primitive>>,
    /// Scene shapes by shape of the file.
    shapes: HashMap<Index, u32>,
    /// Skins by skin of the file.
    skins: HashMap<Index, Rc<PosedSkin>>,
    /// Boxes around the scene's meshes; `None` for meshes without triangles.
    boxes: Vec<Option<(Vec3, Vec3)>>,
    /// Triangles placed so far, instances counted each time.
    triangles: u64,
    /// Placements so far, dropped and empty ones included.
    placed: u64,
}

impl Assembly<'_, '_> {
    fn place_mesh(&mut self, node: &Node, index: Index, mesh: Index) -> Outcome<()> {
        let mut primitives = match self.read.remove(&mesh) {
            Some(primitives) => primitives,
            None => self.read_mesh(mesh)?,
        };
        let result = self.place_primitives(node, index, mesh, &mut primitives);
        self.read.insert(mesh, primitives);
        result
    }

    fn place_primitives(
        &mut self,
        node: &Node,
        index: Index,
        mesh: Index,
        primitives: &mut [Primitive],
    ) -> Outcome<()> {
        let at = format!("nodes[{index}]");
        let rank = self.hierarchy.rank[index];
        let weights = morph_weights(self.doc.root, node, mesh, primitives, &at)?;
        let skin = match node.skin {
            Some(skin) => Some(self.skin(skin)?),
            None => None,
        };
        let locals = instances(self.doc, node, index)?;
        for (i, primitive) in primitives.iter_mut().enumerate() {
            let part = &primitive.part;
            // A node's skin is nothing to primitives without joints.
            let skin = skin.as_deref().filter(|_| !part.influences.is_empty());
            let motion = self.moved.primitive(rank, skin.map(|skin| &skin.skin), !part.targets.is_empty());
            // Joints place their mesh in the world; the node's own transform does not count (glTF 2.0 §3.7.3.3).
            let (node, locals) = match skin {
                Some(_) => (None, &[DAffine3::IDENTITY][..]),
                None => (Some(rank), &locals[..]),
            };
            let placements = Placements { node, locals, motion };
            let deforms = motion == Motion::Deforming && !part.rest.triangles.is_empty();
            if deforms || part.is_deformed_by(weights, skin.is_some()) {
                let place = format!("meshes[{mesh}].primitives[{i}]");
                let (mesh, deformer) = self.deform(part, weights, skin, &place)?;
                let mesh = self.add_mesh(mesh);
                let added = self.add_instances(mesh, &placements, &at)?;
                if deforms && added > 0 {
                    self.add_deformer(Deformer { mesh, node: rank, ..deformer }, weights, skin);
                }
            } else {
                let mesh = match primitive.shared {
                    Some(mesh) => mesh,
                    None => self.share(primitive),
                };
                self.add_instances(mesh, &placements, &at)?;
            }
        }
        Ok(())
    }

    /// A skin, read and posed once however many nodes share it.
    fn skin(&mut self, index: Index) -> Outcome<Rc<PosedSkin>> {
        if let Some(skin) = self.skins.get(&index) {
            return Ok(Rc::clone(skin));
        }
        let skin = read_skin(self.doc, index, self.hierarchy)?;
        let matrices = skin.matrices(&self.world);
        let skin = Rc::new(PosedSkin { skin, matrices, in_rig: None.into() });
        self.skins.insert(index, Rc::clone(&skin));
        Ok(skin)
    }

    fn read_mesh(&mut self, mesh: Index) -> Outcome<Vec<Primitive>> {
        let mut primitives = Vec::new();
        for (i, primitive) in self.doc.root.meshes[mesh].primitives.iter().enumerate() {
            let Some(mut part) = read_primitive(self.doc, mesh, i, self.warnings)? else { continue };
            part.rest.material = match primitive.material {
                Some(material) => material as u32, // checked to be below the number of materials
                None => default_material(self.scene, self.doc.root.materials.len()),
            };
            part.finish(&self.scene.materials[part.rest.material as usize], self.warnings);
            primitives.push(Primitive { part, shared: None });
        }
        Ok(primitives)
    }

    /// The mesh of `part` as it stands at rest, and what deforms it.
    fn deform(
        &self,
        part: &Part,
        weights: &[f32],
        skin: Option<&PosedSkin>,
        at: &str,
    ) -> Outcome<(Mesh, Deformer)> {
        let joints = skin.map_or(&[][..], |skin| &skin.matrices);
        if skin.is_some()
            && let Some(out) = part.influences.iter().find(|i| i.joint as usize >= joints.len())
        {
            let reason = format!("joint {} of a skin with {}", out.joint, joints.len());
            return Err(Fault::invalid(format!("{at}.attributes.JOINTS_0"), reason));
        }
        self.doc.reserve(part.bytes(), at)?;
        let deformer = part.deformer(skin.is_some());
        let mut mesh = part.rest.clone();
        deformer.bend(&mut mesh, weights, joints);
        Ok((mesh, deformer))
    }

    /// Keeps what deforms a mesh that animations move.
    fn add_deformer(&mut self, mut deformer: Deformer, weights: &[f32], skin: Option<&PosedSkin>) {
        let rig = &mut *self.rig;
        deformer.skin = skin.map(|skin| {
            let index = skin.in_rig.get().unwrap_or_else(|| {
                rig.skins.push(skin.skin.clone());
                rig.skins.len() as u32 - 1
            });
            skin.in_rig.set(Some(index));
            index
        });
        let at_rest = &mut rig.nodes[deformer.node as usize].weights;
        if at_rest.len() < deformer.targets.len() {
            // Missing ones are 0 (glTF 2.0 §3.7.2.2).
            *at_rest = weights.to_vec();
            at_rest.resize(deformer.targets.len(), 0.0);
        }
        rig.deformers.push(deformer);
    }

    /// Adds the rest shape to the scene, for all nodes that show it as it is.
    fn share(&mut self, primitive: &mut Primitive) -> u32 {
        let Part { rest, targets, influences, .. } = &mut primitive.part;
        let keep = !targets.is_empty() || !influences.is_empty();
        let mesh = self.add_mesh(if keep { rest.clone() } else { std::mem::take(rest) });
        primitive.shared = Some(mesh);
        mesh
    }

    fn add_mesh(&mut self, mesh: Mesh) -> u32 {
        self.boxes.push(box_around(&mesh));
        self.scene.meshes.push(Arc::new(mesh));
        (self.scene.meshes.len() - 1) as u32
    }

    /// Places a mesh, and returns how often.
    fn add_instances(&mut self, mesh: u32, placements: &Placements<'_>, at: &str) -> Outcome<usize> {
        let added = &self.scene.meshes[mesh as usize];
        let count = placements.locals.len() as u64;
        self.triangles = self.triangles.saturating_add(count.saturating_mul(added.triangles.len() as u64));
        if self.triangles > limits::TRIANGLES {
            let reason = format!("more than {} triangles, instances counted each time", limits::TRIANGLES);
            return Err(Fault::too_large(at, reason));
        }
        self.count_instances(count.max(1), at)?;
        let Some(bounds) = self.boxes[mesh as usize] else { return Ok(0) };
        let before = self.scene.instances.len();
        for &local in placements.locals {
            let attachment = Attachment { node: placements.node, local };
            if let Some(world_from_object) = self.place(&attachment, bounds, placements.motion) {
                let motion = placements.motion;
                self.scene.instances.push(Instance { mesh, world_from_object, motion });
                self.rig.instances.push(attachment);
            }
        }
        Ok(self.scene.instances.len() - before)
    }

    /// Where something with these bounds is at rest; `None`, with a warning, if it is nowhere, and never will be.
    fn place(&mut self, attachment: &Attachment, bounds: (Vec3, Vec3), motion: Motion) -> Option<Affine3A> {
        const NOWHERE: &str = "instances whose transform is singular or not finite are dropped";
        const FAR: &str = "instances beyond the range of numbers are dropped";
        let node = attachment.node.map_or(DAffine3::IDENTITY, |node| self.world[node as usize]);
        let world = node * attachment.local;
        let fault = if motion == Motion::Static || attachment.node.is_none() {
            match placement(world) {
                Some(placement) => {
                    let within = |corner| placement.transform_point3(corner).is_finite();
                    if box_corners(bounds).into_iter().all(within) {
                        return Some(placement);
                    }
                    FAR
                }
                None => NOWHERE,
            }
        } else if !attachment.local.is_finite() {
            NOWHERE
        } else if bounds.0.abs().max(bounds.1.abs()).max_element() > LARGEST_COORDINATE {
            FAR
        } else {
            // Wherever it is now, it may come into view later.
            return Some(placed(world));
        };
        self.warnings.tally(fault, 1);
        None
    }

    fn count_instances(&mut self, count: u64, at: &str) -> Outcome<()> {
        self.placed += count;
        if self.placed > limits::INSTANCES {
            return Err(Fault::too_large(at, format!("more than {} instances", limits::INSTANCES)));
        }
        Ok(())
    }

    fn place_shape(&mut self, surface: &ImplicitSurface, index: Index) -> Outcome<()> {
        self.count_instances(1, &format!("nodes[{index}]"))?;
        let shape = match self.shapes.get(&surface.shape) {
            Some(&shape) => shape,
            None => {
                self.scene.shapes.push(read_shape(self.doc, surface.shape)?);
                *self.shapes.entry(surface.shape).or_insert(self.scene.shapes.len() as u32 - 1)
            }
        };
        let material = match surface.material {
            Some(material) => material as u32, // checked to be below the number of materials
            None => default_material(self.scene, self.doc.root.materials.len()),
        };
        let Material { base_color_texture, normal_texture, emission_texture, .. } =
            &self.scene.materials[material as usize];
        let has_textures =
            [base_color_texture, normal_texture, emission_texture].iter().any(|texture| texture.is_some());
        self.warnings.tally("shapes show no textures: they have no texture coordinates", has_textures.into());
        let node = self.hierarchy.rank[index];
        let motion = self.moved.node(node);
        let attachment = Attachment { node: Some(node), local: DAffine3::IDENTITY };
        let bounds = self.scene.shapes[shape as usize].bounds();
        if let Some(world_from_object) = self.place(&attachment, bounds, motion) {
            self.scene.shape_instances.push(ShapeInstance { shape, material, world_from_object, motion });
            self.rig.shape_instances.push(attachment);
        }
        Ok(())
    }

    fn place_views(&mut self, node: &Node, index: Index) -> Outcome<()> {
        let root = self.doc.root;
        let rank = self.hierarchy.rank[index];
        let world = self.world[rank as usize];
        if let Some(camera) = node.camera {
            let at = format!("cameras[{camera}]");
            match views::camera(&root.cameras[camera], node.name.as_deref(), world, &at)? {
                Some(camera) => {
                    self.scene.cameras.push(camera);
                    self.rig.cameras.push(rank);
                }
                None => self.warnings.tally("cameras without a direction are dropped", 1),
            }
        }
        if let (Some(light), Some(lights)) = (&node.extensions.light, &root.extensions.lights) {
            let at = format!("extensions.KHR_lights_punctual.lights[{}]", light.light);
            match views::light(&lights.lights[light.light], world, &at)? {
                Some(light) => {
                    self.scene.lights.push(light);
                    self.rig.lights.push(rank);
                }
                None => self.warnings.tally("lights without a direction are dropped", 1),
            }
        }
        Ok(())
    }
}

/// Where a node shows a mesh.
struct Placements<'l> {
    /// Node of the rig that carries it; `None` for the world.
    node: Option<u32>,
    /// Places within the node.
    locals: &'l [DAffine3],
    motion: Motion,
}

/// The material of primitives that name none, appended when first needed to the `count` of the file.
fn default_material(scene: &mut Scene, count: usize) -> u32 {
    if scene.materials.len() == count {
        scene.materials.push(Material::default());
    }
    count as u32
}

/// Morph weights of a node: its own, or else the mesh's.
fn morph_weights<'r>(
    root: &'r Root,
    node: &'r Node,
    mesh: Index,
    primitives: &[Primitive],
    at: &str,
) -> Outcome<&'r [f32]> {
    let own = !node.weights.is_empty();
    let weights = if own { &node.weights } else { &root.meshes[mesh].weights };
    let at = || if own { format!("{at}.weights") } else { format!("meshes[{mesh}].weights") };
    for primitive in primitives {
        let targets = primitive.part.targets.len();
        if !weights.is_empty() && weights.len() != targets {
            return Err(Fault::invalid(
                at(),
                format!("{} weights for {targets} morph targets", weights.len()),
            ));
        }
    }
    if weights.iter().all(|weight| weight.is_finite()) {
        Ok(weights)
    } else {
        Err(Fault::invalid(at(), "weight beyond the range of numbers"))
    }
}

/// Box around the vertices in use; `None` without triangles.
fn box_around(mesh: &Mesh) -> Option<(Vec3, Vec3)> {
    let mut points = mesh.triangles.iter().flatten().map(|&i| mesh.positions[i as usize]);
    let first = points.next()?;
    Some(points.fold((first, first), |(lo, hi), p| (lo.min(p), hi.max(p))))
}
