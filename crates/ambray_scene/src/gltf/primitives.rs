//! glTF primitives to meshes at rest.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::{Vec2, Vec3, Vec4};

use crate::Mesh;
use crate::animation::{Influence, MorphTarget};
use crate::error::{Fault, Outcome};
use crate::limits;
use crate::warnings::Warnings;

use super::accessor::Accept;
use super::document::Document;
use super::json::{Index, Primitive};
use super::part::Part;

/// Primitive `primitive` of mesh `mesh`; `None` if it holds nothing that can be rendered.
pub(super) fn read_primitive(
    doc: &Document<'_>,
    mesh: Index,
    primitive: Index,
    warnings: &mut Warnings,
) -> Outcome<Option<Part>> {
    let json = &doc.root.meshes[mesh].primitives[primitive];
    let at = format!("meshes[{mesh}].primitives[{primitive}]");
    let topology = match json.mode.unwrap_or(4) {
        0..=3 => {
            warnings.tally("primitives made of points or lines are skipped", 1);
            return Ok(None);
        }
        4 => Topology::List,
        5 => Topology::Strip,
        6 => Topology::Fan,
        mode => return Err(Fault::invalid(format!("{at}.mode"), format!("no such mode: {mode}"))),
    };
    let Some(&positions) = json.attributes.get("POSITION") else {
        if json.extensions.draco.is_some() {
            return Err(draco(&at));
        }
        warnings.tally("primitives without positions are skipped", 1);
        return Ok(None);
    };
    // The accessors of Draco primitives may refer to no data at all, which would read as zeros.
    if json.extensions.draco.is_some() && doc.root.accessors[positions].buffer_view.is_none() {
        return Err(draco(&at));
    }
    let reader = Reader::new(doc, json, positions, &at)?;
    let rest = Mesh {
        name: name(doc, mesh, primitive),
        positions: reader.vec3(&json.attributes, "POSITION", "attributes")?,
        normals: reader.vec3(&json.attributes, "NORMAL", "attributes")?,
        tangents: reader.tangents()?,
        uvs: reader.uvs()?,
        colors: reader.colors()?,
        triangles: topology.triangles(&reader.indices),
        material: 0,
    };
    doc.reserve(12 * rest.triangles.len() as u64, &at)?;
    let (influences, influences_per_vertex) = reader.influences()?;
    let targets = reader.targets()?;
    Ok(Some(Part { rest, targets, influences, influences_per_vertex }))
}

fn draco(at: &str) -> Fault {
    let reason = "KHR_draco_mesh_compression without uncompressed data is not supported";
    Fault::unsupported(format!("{at}.extensions"), reason)
}

/// The mesh's name, numbered if it has several primitives.
fn name(doc: &Document<'_>, mesh: Index, primitive: Index) -> String {
    let json = &doc.root.meshes[mesh];
    let name = json.name.as_deref().unwrap_or_default();
    if json.primitives.len() > 1 { format!("{name}[{primitive}]") } else { name.to_owned() }
}

/// How a list of vertices becomes triangles (glTF 2.0 §3.7.2.1).
#[derive(Clone, Copy, Debug)]
enum Topology {
    List,
    Strip,
    Fan,
}

impl Topology {
    /// Triangles of the vertex list; incomplete ones at the end are dropped, as the specification demands.
    fn triangles(self, vertices: &[u32]) -> Vec<[u32; 3]> {
        match self {
            Self::List => vertices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
            Self::Strip => {
                let turned = |(i, t): (usize, &[u32])| {
                    if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[0], t[2], t[1]] }
                };
                vertices.windows(3).enumerate().map(turned).collect()
            }
            Self::Fan => match vertices.split_first() {
                Some((&hub, rim)) => rim.windows(2).map(|t| [t[0], t[1], hub]).collect(),
                None => Vec::new(),
            },
        }
    }
}

/// Reads the attributes of one primitive for those vertices that its indices span.
///
/// Files often keep many primitives in one vertex list; each mesh then gets only its own part.
struct Reader<'a> {
    doc: &'a Document<'a>,
    json: &'a Primitive,
    at: &'a str,
    /// Vertices of the accessors.
    total: u64,
    /// Vertices that are read.
    range: Range<u64>,
    /// Indices, counted from the start of `range`.
    indices: Vec<u32>,
}

impl<'a> Reader<'a> {
    fn new(doc: &'a Document<'a>, json: &'a Primitive, positions: Index, at: &'a str) -> Outcome<Self> {
        let total = doc.count(positions, &format!("{at}.attributes.POSITION"))?;
        let Some(accessor) = json.indices else {
            let count = u32::try_from(total)
                .map_err(|_| Fault::too_large(at, format!("{total} vertices, the limit is {}", u32::MAX)))?;
            doc.reserve(4 * total, at)?;
            // Bytes stand behind the count once the positions are read; until then it is only reserved.
            let positions: Vec<[f32; 3]> =
                doc.read(positions, Accept::Quantized, &format!("{at}.attributes.POSITION"))?;
            debug_assert_eq!(positions.len() as u64, total);
            return Ok(Self { doc, json, at, total, range: 0..total, indices: (0..count).collect() });
        };
        let place = format!("{at}.indices");
        let mut indices = doc.read_indices(accessor, &place)?;
        let least = indices.iter().copied().min().unwrap_or(0);
        let most = indices.iter().copied().max().unwrap_or(0);
        if !indices.is_empty() && u64::from(most) >= total {
            let i = indices.iter().position(|&index| index == most).unwrap_or_default();
            let reason = format!("entry {i} is vertex {most} of {total}");
            return Err(Fault::invalid(format!("accessors[{accessor}]"), reason));
        }
        let range = if indices.is_empty() { 0..0 } else { u64::from(least)..u64::from(most) + 1 };
        indices.iter_mut().for_each(|index| *index -= least);
        Ok(Self { doc, json, at, total, range, indices })
    }

    /// The attribute `name` of `attributes`, empty if it is not there.
    fn attribute<const N: usize>(
        &self,
        attributes: &BTreeMap<String, Index>,
        name: &str,
        accept: Accept,
        field: &str,
    ) -> Outcome<Vec<[f32; N]>> {
        let Some(&accessor) = attributes.get(name) else { return Ok(Vec::new()) };
        let place = format!("{}.{field}.{name}", self.at);
        let count = self.doc.count(accessor, &place)?;
        if count != self.total {
            let reason = format!("{count} elements for {} positions", self.total);
            return Err(Fault::invalid(place, reason));
        }
        self.doc.read_range(accessor, accept, self.range.clone(), &place)
    }

    fn vec3(&self, attributes: &BTreeMap<String, Index>, name: &str, field: &str) -> Outcome<Vec<Vec3>> {
        let values = self.attribute::<3>(attributes, name, Accept::Quantized, field)?;
        Ok(values.into_iter().map(Vec3::from).collect())
    }

    fn tangents(&self) -> Outcome<Vec<Vec4>> {
        let values =
            self.attribute::<4>(&self.json.attributes, "TANGENT", Accept::Quantized, "attributes")?;
        Ok(values.into_iter().map(Vec4::from).collect())
    }

    fn uvs(&self) -> Outcome<Vec<Vec<Vec2>>> {
        let mut sets = Vec::new();
        loop {
            let name = format!("TEXCOORD_{}", sets.len());
            if !self.json.attributes.contains_key(&name) {
                return Ok(sets);
            }
            let uvs = self.attribute::<2>(&self.json.attributes, &name, Accept::Quantized, "attributes")?;
            sets.push(uvs.into_iter().map(Vec2::from).collect());
        }
    }

    fn colors(&self) -> Outcome<Vec<Vec4>> {
        let attributes = &self.json.attributes;
        let Some(accessor) = attributes.get("COLOR_0").and_then(|&index| self.doc.root.accessors.get(index))
        else {
            return Ok(Vec::new());
        };
        let accept = Accept::FloatOrNormalized;
        Ok(if accessor.shape == "VEC3" {
            let values = self.attribute::<3>(attributes, "COLOR_0", accept, "attributes")?;
            values.into_iter().map(|rgb| Vec3::from(rgb).extend(1.0)).collect()
        } else {
            let values = self.attribute::<4>(attributes, "COLOR_0", accept, "attributes")?;
            values.into_iter().map(Vec4::from).collect()
        })
    }

    /// Joints and weights of all sets, flattened vertex by vertex, and how many there are a vertex.
    fn influences(&self) -> Outcome<(Vec<Influence>, usize)> {
        let (mut joints, mut weights) = (Vec::new(), Vec::new());
        loop {
            let set = joints.len();
            let (joint, weight) = (format!("JOINTS_{set}"), format!("WEIGHTS_{set}"));
            let attributes = &self.json.attributes;
            match (attributes.contains_key(&joint), attributes.contains_key(&weight)) {
                (true, true) => {}
                (false, false) => break,
                _ => {
                    let place = format!("{}.attributes", self.at);
                    return Err(Fault::invalid(place, format!("{joint} and {weight} must come together")));
                }
            }
            joints.push(self.attribute::<4>(attributes, &joint, Accept::Unsigned, "attributes")?);
            weights.push(self.attribute::<4>(
                attributes,
                &weight,
                Accept::FloatOrNormalized,
                "attributes",
            )?);
        }
        let count = (self.range.end - self.range.start) as usize;
        let mut influences = Vec::with_capacity(4 * joints.len() * count);
        for vertex in 0..count {
            for (joints, weights) in joints.iter().zip(&weights) {
                let pairs = joints[vertex].iter().zip(&weights[vertex]);
                influences.extend(pairs.map(|(&joint, &weight)| Influence { joint: joint as u32, weight }));
            }
        }
        Ok((influences, 4 * joints.len()))
    }

    fn targets(&self) -> Outcome<Vec<MorphTarget>> {
        let targets = &self.json.targets;
        if targets.len() > limits::MORPH_TARGETS {
            let reason = format!("{} morph targets, the limit is {}", targets.len(), limits::MORPH_TARGETS);
            return Err(Fault::too_large(format!("{}.targets", self.at), reason));
        }
        let read = |(i, target): (usize, &BTreeMap<String, Index>)| {
            let field = format!("targets[{i}]");
            Ok(MorphTarget {
                positions: self.vec3(target, "POSITION", &field)?,
                normals: self.vec3(target, "NORMAL", &field)?,
                tangents: self.vec3(target, "TANGENT", &field)?,
            })
        };
        targets.iter().enumerate().map(read).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn topologies() {
        let v = [0, 1, 2, 3, 4];
        assert_eq!(Topology::List.triangles(&v), [[0, 1, 2]]);
        assert_eq!(Topology::Strip.triangles(&v), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        assert_eq!(Topology::Fan.triangles(&v), [[1, 2, 0], [2, 3, 0], [3, 4, 0]]);
        assert!(Topology::Strip.triangles(&v[..2]).is_empty());
        assert!(Topology::Fan.triangles(&[]).is_empty());
    }
}
