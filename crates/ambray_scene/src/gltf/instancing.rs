//! EXT_mesh_gpu_instancing: one node shows its mesh many times.

use std::collections::BTreeMap;

use glam::{DAffine3, DQuat, DVec3};

use crate::error::{Fault, Outcome};
use crate::limits;

use super::accessor::Accept;
use super::document::Document;
use super::json::{Index, Node};

/// Where node `index` shows its mesh within itself: once, or as often as the extension says. Transforms may hold NaN.
pub(super) fn instances(doc: &Document<'_>, node: &Node, index: Index) -> Outcome<Vec<DAffine3>> {
    match &node.extensions.instancing {
        Some(instancing) => {
            let at = format!("nodes[{index}].extensions.EXT_mesh_gpu_instancing.attributes");
            transforms(doc, &instancing.attributes, &at)
        }
        None => Ok(vec![DAffine3::IDENTITY]),
    }
}

fn transforms(doc: &Document<'_>, attributes: &BTreeMap<String, Index>, at: &str) -> Outcome<Vec<DAffine3>> {
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
