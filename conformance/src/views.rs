//! The three views of Sponza of spec §11.

use ambray_core::{
    filter::{Filter, Guide},
    settings::{Auto, Normals, Settings, Size, Triple},
};
use ambray_scene::{AlphaMode, Scene};
use glam::Vec4;

use ambray_metrics::Map;

/// A camera of spec §11.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Name in the specification.
    pub name: &'static str,
    eye: [f32; 3],
    target: [f32; 3],
}

/// Nave, curtain and gallery.
pub const SPONZA: [View; 3] = [
    View { name: "nave", eye: [-9.0, 1.6, -0.3], target: [0.0, 2.2, -0.3] },
    View { name: "curtain", eye: [-2.6, 0.55, 3.3], target: [-3.6, 0.25, 1.7] },
    View { name: "gallery", eye: [-9.5, 5.0, 3.2], target: [2.0, 4.2, 2.4] },
];

impl View {
    /// Settings of the measurement: 640 × 360, R = 1, α = 1, geometric normals, 8 interleaved rays.
    #[must_use]
    pub fn settings(&self) -> Settings {
        Settings {
            size: Size { width: 640, height: 360 },
            radius: Auto::Value(1.0),
            normals: Normals::Geometric,
            camera_position: Auto::Value(Triple(self.eye)),
            camera_target: Auto::Value(Triple(self.target)),
            vertical_fov: Auto::Value(50.0),
            ..Settings::default()
        }
    }
}

/// Removes what has an alpha mask, as the measurement did.
pub fn remove_masked(scene: &mut Scene) {
    let masked = |mesh: u32| {
        let material = scene.meshes[mesh as usize].material;
        matches!(scene.materials[material as usize].alpha_mode, AlphaMode::Mask(_))
    };
    let kept: Vec<_> = scene.instances.iter().copied().filter(|instance| !masked(instance.mesh)).collect();
    scene.instances = kept;
}

/// Openness of a frame before and after its filter.
#[must_use]
pub fn openness(frame: &ambray::Frame) -> (Map, Map) {
    let map =
        |plane: &[Vec4]| Map { width: frame.width as usize, values: plane.iter().map(|v| v.x).collect() };
    (map(&frame.ambient_raw), map(&frame.ambient))
}

/// The map after the filter of `settings`, guided by what `frame` sees.
#[must_use]
pub fn filtered(map: &Map, frame: &ambray::Frame, settings: &Settings) -> Map {
    let guides: Vec<Guide> = frame
        .gbuffer
        .iter()
        .map(|pixel| Guide {
            position: pixel.position,
            depth: pixel.depth,
            normal: pixel.smooth_normal,
            footprint: frame.view.camera.footprint(pixel.depth),
        })
        .collect();
    let input: Vec<Vec4> = map.values.iter().map(|&v| Vec4::splat(v)).collect();
    let mut output = vec![Vec4::ZERO; input.len()];
    let filter = Filter::from(settings);
    for (y, row) in output.chunks_mut(map.width).enumerate() {
        filter.filter_row(&guides, map.width, y, [&input], [row]);
    }
    Map { width: map.width, values: output.iter().map(|v| v.x).collect() }
}
