//! Display bytes of frames, made in parallel: the same bytes as in the file.

use std::sync::Arc;

use ambray::{
    Aov, AovKind, Frame,
    display::{self, Picture},
    settings::Settings,
};
use glam::Vec3;
use rayon::prelude::*;

use super::contract::Pixels;

/// Pixels that a task takes.
const PART: usize = 1 << 12;

/// The plane `aov` of `frame`, whose values are `values`, as `settings` show it.
pub(super) fn pixels(frame: &Frame, aov: Aov, values: &[f32], settings: &Settings) -> Arc<Pixels> {
    let rgba = match aov.kind() {
        // Each pixel stands for itself, and mapping colours is what takes time.
        AovKind::Color => {
            values.par_chunks(3 * PART).flat_map_iter(|part| colors(part, aov, settings)).collect()
        }
        _ => display::show(frame, aov, settings).rgba8(),
    };
    Arc::new(Pixels { width: frame.width, height: frame.height, rgba })
}

fn colors(values: &[f32], aov: Aov, settings: &Settings) -> Vec<u8> {
    let colors = values.chunks_exact(3).map(Vec3::from_slice);
    let shown = |color: Vec3| match aov {
        Aov::Albedo => display::encode(color),
        _ => display::display(color, settings.exposure, settings.tone_map),
    };
    Picture::Rgb { pixels: colors.map(shown).collect(), is_color: true }.rgba8()
}

#[cfg(test)]
mod tests {
    use ambray::{
        Control, Renderer,
        scene::atrium::atrium,
        settings::{Ramp, Size, ToneMap},
    };

    use super::*;

    #[test]
    fn every_plane_is_shown_as_in_the_file() {
        let size = Size { width: 97, height: 61 };
        let settings = Settings { size, spp: 1, exposure: 0.7, ramp: Ramp::Turbo, ..Settings::default() };
        let frame = Renderer::new(atrium()).render(&settings, Control::default()).expect("a picture");
        for settings in [Settings { tone_map: ToneMap::None, ..settings.clone() }, settings] {
            for &aov in Aov::ALL {
                let shown = pixels(&frame, aov, &frame.plane(aov), &settings);
                assert!(shown.rgba == display::show(&frame, aov, &settings).rgba8(), "{aov}");
            }
        }
    }
}
