//! What a truth depends on, as a number: the scene and the settings by their content, not by their names.

use std::fmt::{self, Write};

use ambray::{Machine, scene::Scene, settings::Settings};
use bytemuck::cast_slice;
use sha2::{Digest, Sha256};

use super::{BATCH, VERSION};

/// Fingerprint of a scene: everything that light depends on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Content(String);

impl Content {
    /// The fingerprint of `scene` as it was opened.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let mut hash = Hash(Sha256::new());
        for mesh in &scene.meshes {
            hash.part(cast_slice(&mesh.positions));
            hash.part(cast_slice(&mesh.normals));
            hash.part(cast_slice(&mesh.tangents));
            mesh.uvs.iter().for_each(|uvs| hash.part(cast_slice(uvs)));
            hash.part(cast_slice(&mesh.colors));
            hash.part(cast_slice(&mesh.triangles));
            hash.words(&mesh.material);
        }
        for image in &scene.images {
            hash.words(&image.srgb);
            for level in &image.levels {
                hash.words(&(level.width, level.height));
                hash.part(cast_slice(&level.texels));
            }
        }
        // The rest is small, and its debugging output tells all of it: numbers are written so that they can be read back.
        hash.words(&(&scene.instances, &scene.shapes, &scene.shape_instances));
        hash.words(&(&scene.materials, &scene.textures, &scene.lights, &scene.cameras));
        hash.words(&(scene.ambient, scene.radius, &scene.rig));
        Self(hash.finish())
    }

    /// Name of the truth of a scene with this content for `settings`, up to a standard error of `bound` or `most` rays, as
    /// `machine` computes it.
    pub(super) fn key(&self, settings: &Settings, bound: f64, most: u32, machine: &Machine) -> String {
        let mut hash = Hash(Sha256::new());
        hash.words(&(VERSION, BATCH, env!("CARGO_PKG_VERSION"), &self.0, bound.to_bits(), most));
        hash.words(&relevant(settings));
        // All instruction sets of the processor give the same bits.
        let device = match machine {
            Machine::Cpu { .. } => None,
            Machine::Vulkan { device, .. } => Some(device),
        };
        hash.words(&device);
        hash.finish()
    }
}

/// `settings` with what the truth does not depend on at its default.
fn relevant(settings: &Settings) -> Settings {
    let plain = Settings::default();
    Settings {
        exposure: plain.exposure,
        tone_map: plain.tone_map,
        ramp: plain.ramp,
        range: plain.range,
        background: plain.background,
        spp: plain.spp,
        method: plain.method,
        screen_quality: plain.screen_quality,
        thickness: plain.thickness,
        thin: plain.thin,
        thin_edge: plain.thin_edge,
        thin_minimum: plain.thin_minimum,
        sampling: plain.sampling,
        sequence: plain.sequence,
        filter: plain.filter,
        filter_test: plain.filter_test,
        filter_plane: plain.filter_plane,
        filter_absolute: plain.filter_absolute,
        filter_relative: plain.filter_relative,
        filter_cos_normal: plain.filter_cos_normal,
        temporal: plain.temporal,
        ..settings.clone()
    }
}

struct Hash(Sha256);

impl Hash {
    /// Adds `bytes`, kept apart from what comes after them.
    fn part(&mut self, bytes: &[u8]) {
        self.0.update((bytes.len() as u64).to_le_bytes());
        self.0.update(bytes);
    }

    fn words(&mut self, value: &dyn fmt::Debug) {
        write!(self, "{value:?};").expect("hashing does not fail");
    }

    fn finish(self) -> String {
        self.0.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

impl Write for Hash {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.update(text.as_bytes());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use ambray::{
        scene::atrium::atrium,
        settings::{Method, Sampling, Thin},
    };

    use super::*;

    #[test]
    fn scenes_are_told_apart_by_what_is_in_them() {
        let scene = atrium();
        let plain = Content::of(&scene);
        let mut renamed = scene.clone();
        renamed.name = "other".to_owned();
        assert_eq!(Content::of(&renamed), plain, "names do not count");
        let mut moved = scene.clone();
        Arc::make_mut(&mut moved.meshes[0]).positions[0].x += 1e-5;
        assert_ne!(Content::of(&moved), plain, "a moved vertex");
        let mut painted = scene;
        painted.materials[0].base_color.x *= 0.5;
        assert_ne!(Content::of(&painted), plain, "another colour");
    }

    #[test]
    fn the_truth_does_not_depend_on_who_looks_for_it() {
        let content = Content("a".to_owned());
        let cpu = Machine::Cpu { isa: "any", reason: None };
        let key = |settings: &Settings| content.key(settings, 1e-3, 1024, &cpu);
        let plain = key(&Settings::default());
        let others = Settings {
            method: Method::Gtao,
            spp: 1,
            sampling: Sampling::Same,
            thin: Thin::Sheet,
            exposure: 1.0,
            ..Settings::default()
        };
        assert_eq!(key(&others), plain);
        assert_ne!(key(&Settings { exponent: 2.0, ..Settings::default() }), plain);
        assert_ne!(content.key(&Settings::default(), 2e-3, 1024, &cpu), plain);
    }
}
