//! Puts the parts together: nodes in scene order become instances, cameras and lights.

use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;
use std::sync::Arc;

use glam::{Affine3A, DAffine3, DQuat, DVec3, Vec3};

use crate::error::{Fault, Outcome};
use crate::repair::repair;
use crate::scene::box_corners;
use crate::warnings::Warnings;
use crate::{Instance, Material, Mesh, Motion, Scene, ShapeInstance, limits, tangents};

use super::accessor::Accept;
use super::document::Document;
use super::json::{ImplicitSurface, Index, Node, Root};
use super::motion::Moved;
use super::nodes::placement;
use super::pose::{Deformable, joint_matrices};
use super::primitives::read_primitive;
use super::shapes::read_shape;
use super::views;

/// Adds what the `visible` nodes show to `scene`, which has its materials already.
pub(super) fn assemble(
    doc: &Document<'_>,
    visible: &[Index],
    world: &[DAffine3],
    moved: &Moved,
    scene: &mut Scene,
    warnings: &mut Warnings,
) -> Outcome<()> {
    let mut assembly = Assembly {
        doc,
        world,
        moved,
        scene,
        warnings,
        read: HashMap::new(),
        shapes: HashMap::new(),
        joints: HashMap::new(),
        corners: Vec::new(),
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

/// A primitive that has been read.
struct Part {
    deformable: Deformable,
    /// Scene mesh of the rest shape once it is needed.
    shared: Option<u32>,
}

struct Assembly<'a, 'd> {
    doc: &'a Document<'d>,
    world: &'a [DAffine3],
    moved: &'a Moved,
    scene: &'a mut Scene,
    warnings: &'a mut Warnings,
    /// Primitives by glTF mesh.
    read: HashMap<Index, Vec<Part>>,
    /// Scene shapes by shape of the file.
    shapes: HashMap<Index, u32>,
    /// Joint matrices by skin.
    joints: HashMap<Index, Rc<[Affine3A]>>,
    /// Corners of the boxes around the scene's meshes; `None` for meshes without triangles.
    corners: Vec<Option<[Vec3; 8]>>,
    /// Triangles placed so far, instances counted each time.
    triangles: u64,
    /// Placements so far, dropped and empty ones included.
    placed: u64,
}

impl Assembly<'_, '_> {
    fn place_mesh(&mut self, node: &Node, index: Index, mesh: Index) -> Outcome<()> {
        let mut parts = match self.read.remove(&mesh) {
            Some(parts) => parts,
            None => self.read_mesh(mesh)?,
        };
        let result = self.place_parts(node, index, mesh, &mut parts);
        self.read.insert(mesh, parts);
        result
    }

    fn place_parts(&mut self, node: &Node, index: Index, mesh: Index, parts: &mut [Part]) -> Outcome<()> {
        let at = format!("nodes[{index}]");
        let weights = morph_weights(self.doc.root, node, mesh, parts, &at)?;
        let joints = match node.skin {
            Some(skin) => Some(self.joints(skin, &format!("{at}.skin"))?),
            None => None,
        };
        let placements = self.placements(node, index)?;
        for (i, part) in parts.iter_mut().enumerate() {
            let has_joints = !part.deformable.influences.is_empty();
            let motion = self.moved.primitive(
                self.doc.root,
                node,
                index,
                has_joints,
                !part.deformable.targets.is_empty(),
            );
            if part.deformable.is_deformed_by(weights, joints.is_some()) {
                let place = format!("meshes[{mesh}].primitives[{i}]");
                let posed = self.pose(&part.deformable, weights, joints.as_deref(), &place)?;
                // Joints place their mesh in the world; the node's own transform does not count (glTF 2.0 §3.7.3.3).
                let skinned = joints.is_some() && has_joints;
                let mesh = self.add_mesh(posed)?;
                let placements = if skinned { &[Affine3A::IDENTITY][..] } else { &placements };
                self.add_instances(mesh, placements, motion, &at)?;
            } else {
                let mesh = match part.shared {
                    Some(mesh) => mesh,
                    None => self.share(part)?,
                };
                self.add_instances(mesh, &placements, motion, &at)?;
            }
        }
        Ok(())
    }

    /// Joint matrices of a skin, computed once however many nodes share it.
    fn joints(&mut self, skin: Index, at: &str) -> Outcome<Rc<[Affine3A]>> {
        if let Some(joints) = self.joints.get(&skin) {
            return Ok(Rc::clone(joints));
        }
        let joints: Rc<[Affine3A]> = joint_matrices(self.doc, skin, self.world, at)?.into();
        self.joints.insert(skin, Rc::clone(&joints));
        Ok(joints)
    }

    fn read_mesh(&mut self, mesh: Index) -> Outcome<Vec<Part>> {
        let mut parts = Vec::new();
        for (i, primitive) in self.doc.root.meshes[mesh].primitives.iter().enumerate() {
            if let Some(mut deformable) = read_primitive(self.doc, mesh, i, self.warnings)? {
                deformable.rest.material = match primitive.material {
                    Some(material) => material as u32, // checked to be below the number of materials
                    None => default_material(self.scene, self.doc.root.materials.len()),
                };
                parts.push(Part { deformable, shared: None });
            }
        }
        Ok(parts)
    }

    fn pose(
        &self,
        deformable: &Deformable,
        weights: &[f32],
        joints: Option<&[Affine3A]>,
        at: &str,
    ) -> Outcome<Mesh> {
        if let Some(joints) = joints {
            let out = deformable.influences.iter().find(|influence| influence.joint as usize >= joints.len());
            if let Some(influence) = out {
                let reason = format!("joint {} of a skin with {}", influence.joint, joints.len());
                return Err(Fault::invalid(format!("{at}.attributes.JOINTS_0"), reason));
            }
        }
        let rest = &deformable.rest;
        self.doc.reserve((64 * rest.positions.len() + 12 * rest.triangles.len()) as u64, at)?;
        Ok(deformable.pose(weights, joints))
    }

    /// Adds the rest shape to the scene, for all nodes that show it as it is.
    fn share(&mut self, part: &mut Part) -> Outcome<u32> {
        let keep = !part.deformable.targets.is_empty() || !part.deformable.influences.is_empty();
        let rest = &mut part.deformable.rest;
        let mesh = self.add_mesh(if keep { rest.clone() } else { std::mem::take(rest) })?;
        part.shared = Some(mesh);
        Ok(mesh)
    }

    fn add_mesh(&mut self, mut mesh: Mesh) -> Outcome<u32> {
        repair(&mut mesh, self.warnings);
        let material = &self.scene.materials[mesh.material as usize];
        if let Some(texture) = &material.normal_texture {
            tangents::generate(&mut mesh, texture.uv_set);
        }
        let refs = [&material.base_color_texture, &material.normal_texture, &material.emission_texture];
        let lacks_uvs = refs.into_iter().flatten().any(|texture| texture.uv_set as usize >= mesh.uvs.len());
        self.warnings
            .tally("primitives lack the texture coordinates that their material asks for", lacks_uvs.into());
        self.corners.push(corners(&mesh));
        self.scene.meshes.push(Arc::new(mesh));
        Ok((self.scene.meshes.len() - 1) as u32)
    }

    fn add_instances(&mut self, mesh: u32, placements: &[Affine3A], motion: Motion, at: &str) -> Outcome<()> {
        let added = &self.scene.meshes[mesh as usize];
        let count = placements.len() as u64;
        self.triangles = self.triangles.saturating_add(count.saturating_mul(added.triangles.len() as u64));
        if self.triangles > limits::TRIANGLES {
            let reason = format!("more than {} triangles, instances counted each time", limits::TRIANGLES);
            return Err(Fault::too_large(at, reason));
        }
        self.count_instances(count.max(1), at)?;
        let Some(corners) = self.corners[mesh as usize] else { return Ok(()) };
        let before = self.scene.instances.len();
        let finite = |m: &&Affine3A| corners.iter().all(|&corner| m.transform_point3(corner).is_finite());
        let placed = placements.iter().filter(finite);
        self.scene.instances.extend(placed.map(|&world_from_object| Instance {
            mesh,
            world_from_object,
            motion,
        }));
        let dropped = count - (self.scene.instances.len() - before) as u64;
        self.warnings.tally("instances beyond the range of numbers are dropped", dropped);
        Ok(())
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
        let Some(world_from_object) = placement(self.world[index]) else {
            self.warnings.tally("instances whose transform is singular or not finite are dropped", 1);
            return Ok(());
        };
        let corners = box_corners(self.scene.shapes[shape as usize].bounds());
        if !corners.iter().all(|&corner| world_from_object.transform_point3(corner).is_finite()) {
            self.warnings.tally("instances beyond the range of numbers are dropped", 1);
            return Ok(());
        }
        let motion = self.moved.node(index);
        self.scene.shape_instances.push(ShapeInstance { shape, material, world_from_object, motion });
        Ok(())
    }

    /// Where a node puts its mesh: once, or as often as EXT_mesh_gpu_instancing says.
    fn placements(&mut self, node: &Node, index: Index) -> Outcome<Vec<Affine3A>> {
        let world = self.world[index];
        let transforms = match &node.extensions.instancing {
            Some(instancing) => {
                let at = format!("nodes[{index}].extensions.EXT_mesh_gpu_instancing.attributes");
                instance_transforms(self.doc, &instancing.attributes, &at)?
            }
            None => vec![DAffine3::IDENTITY],
        };
        let placed: Vec<Affine3A> = transforms.iter().filter_map(|&local| placement(world * local)).collect();
        let dropped = (transforms.len() - placed.len()) as u64;
        self.warnings.tally("instances whose transform is singular or not finite are dropped", dropped);
        Ok(placed)
    }

    fn place_views(&mut self, node: &Node, index: Index) -> Outcome<()> {
        let root = self.doc.root;
        if let Some(camera) = node.camera {
            let at = format!("cameras[{camera}]");
            match views::camera(&root.cameras[camera], node.name.as_deref(), self.world[index], &at)? {
                Some(camera) => self.scene.cameras.push(camera),
                None => self.warnings.tally("cameras without a direction are dropped", 1),
            }
        }
        if let (Some(light), Some(lights)) = (&node.extensions.light, &root.extensions.lights) {
            let at = format!("extensions.KHR_lights_punctual.lights[{}]", light.light);
            match views::light(&lights.lights[light.light], self.world[index], &at)? {
                Some(light) => self.scene.lights.push(light),
                None => self.warnings.tally("lights without a direction are dropped", 1),
            }
        }
        Ok(())
    }
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
    parts: &[Part],
    at: &str,
) -> Outcome<&'r [f32]> {
    let own = !node.weights.is_empty();
    let weights = if own { &node.weights } else { &root.meshes[mesh].weights };
    let at = || if own { format!("{at}.weights") } else { format!("meshes[{mesh}].weights") };
    for part in parts {
        let targets = part.deformable.targets.len();
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

/// Local transforms of EXT_mesh_gpu_instancing.
fn instance_transforms(
    doc: &Document<'_>,
    attributes: &BTreeMap<String, Index>,
    at: &str,
) -> Outcome<Vec<DAffine3>> {
    let mut count = None;
    for (name, &accessor) in attributes {
        let this = doc.count(accessor, at)?;
        if *count.get_or_insert(this) != this {
            return Err(Fault::invalid(format!("{at}.{name}"), "attributes differ in their count"));
        }
    }
    let count = count.ok_or_else(|| Fault::invalid(at, "instancing without attributes"))?;
    if count > limits::INSTANCES {
        return Err(Fault::too_large(at, format!("{count} instances, the limit is {}", limits::INSTANCES)));
    }
    doc.reserve(count * size_of::<DAffine3>() as u64, at)?;
    let vec3 = |name: &str| match attributes.get(name) {
        Some(&accessor) => doc.read::<3>(accessor, Accept::Float, &format!("{at}.{name}")),
        None => Ok(Vec::new()),
    };
    let (translations, scales) = (vec3("TRANSLATION")?, vec3("SCALE")?);
    let rotations = match attributes.get("ROTATION") {
        Some(&accessor) => doc.read::<4>(accessor, Accept::FloatOrNormalized, &format!("{at}.ROTATION"))?,
        None => Vec::new(),
    };
    let transform = |i: usize| {
        let translation = translations.get(i).map_or(DVec3::ZERO, |t| DVec3::from(t.map(f64::from)));
        let scale = scales.get(i).map_or(DVec3::ONE, |s| DVec3::from(s.map(f64::from)));
        // A quaternion of length zero becomes NaN, and the instance is dropped with the other singular ones.
        let rotation = rotations.get(i).map_or(DQuat::IDENTITY, |q| {
            let q = DQuat::from_array(q.map(f64::from));
            q * (1.0 / q.length())
        });
        DAffine3::from_scale_rotation_translation(scale, rotation, translation)
    };
    Ok((0..count as usize).map(transform).collect())
}

/// Corners of the box around the vertices in use; `None` without triangles.
fn corners(mesh: &Mesh) -> Option<[Vec3; 8]> {
    let mut points = mesh.triangles.iter().flatten().map(|&i| mesh.positions[i as usize]);
    let first = points.next()?;
    Some(box_corners(points.fold((first, first), |(lo, hi), p| (lo.min(p), hi.max(p)))))
}
