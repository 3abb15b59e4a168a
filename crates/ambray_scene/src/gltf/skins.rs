//! Skins of the file to those of a rig.

use glam::{DAffine3, DMat4};

use crate::animation::Skin;
use crate::error::{Fault, Outcome};

use super::accessor::Accept;
use super::document::Document;
use super::json::Index;
use super::nodes::Hierarchy;

/// Skin `index`, which exists, as its joints.
pub(super) fn read_skin(doc: &Document<'_>, index: Index, hierarchy: &Hierarchy) -> Outcome<Skin> {
    let skin = &doc.root.skins[index];
    let at = format!("skins[{index}]");
    if skin.joints.is_empty() {
        return Err(Fault::invalid(format!("{at}.joints"), "skin without joints"));
    }
    let binds = match skin.inverse_bind_matrices {
        Some(accessor) => doc.read::<16>(accessor, Accept::Float, &format!("{at}.inverseBindMatrices"))?,
        None => Vec::new(),
    };
    if skin.inverse_bind_matrices.is_some() && binds.len() < skin.joints.len() {
        let reason = format!("{} matrices for {} joints", binds.len(), skin.joints.len());
        return Err(Fault::invalid(format!("{at}.inverseBindMatrices"), reason));
    }
    let bind = |i: usize| {
        binds.get(i).map_or(DAffine3::IDENTITY, |columns| {
            DAffine3::from_mat4(DMat4::from_cols_array(&columns.map(f64::from)))
        })
    };
    Ok(Skin {
        joints: skin.joints.iter().map(|&joint| hierarchy.rank[joint]).collect(),
        inverse_binds: (0..skin.joints.len()).map(bind).collect(),
    })
}
