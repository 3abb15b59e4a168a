//! What one frame leaves for the next, and where the surface points of this frame were in the last one.

use std::sync::Arc;

use ambray_core::{
    camera::Camera,
    filter::Guide,
    settings::{Normals, Settings},
    temporal::{Accumulation, Earlier, Mean, Path, is_comparable},
    trace::{Hit, Motion, Ray},
    view::View,
};
use ambray_scene::surface::Surfaces;
use glam::{Vec2, Vec3, Vec4};

use super::pass1::Pass1;

/// The last frame, where light is accumulated.
#[derive(Debug)]
pub(super) struct History {
    settings: Settings,
    view: View,
    guides: Vec<Guide>,
    means: Vec<Mean>,
}

impl History {
    pub(super) fn new(settings: &Settings, view: &View, guides: Vec<Guide>, means: Vec<Mean>) -> Self {
        Self { settings: settings.clone(), view: view.clone(), guides, means }
    }

    /// Whether the next frame can continue it.
    pub(super) fn suits(&self, settings: &Settings, view: &View) -> bool {
        is_comparable((&self.settings, &self.view), (settings, view))
    }

    pub(super) fn earlier(&self) -> Earlier<'_> {
        Earlier { camera: &self.view.camera, guides: &self.guides, means: &self.means }
    }
}

/// A frame that continues others, or begins a sequence.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sequel<'a> {
    /// Surfaces at the pose of the last frame, if the scene has moved since.
    pub(super) surfaces: Option<&'a Arc<Surfaces>>,
    /// Whether it has.
    pub(super) scene_moved: bool,
    /// The last frame.
    pub(super) earlier: Option<&'a History>,
}

impl Sequel<'_> {
    /// Where the point that `now` saw at the `hit` of `ray` was in the last frame, as its camera saw it.
    pub(super) fn then(
        &self,
        surfaces: &Surfaces,
        settings: &Settings,
        now: &Guide,
        ray: &Ray,
        hit: &Hit,
    ) -> Guide {
        let Some(earlier) = self.earlier else { return *now };
        let camera = &earlier.view.camera;
        let (position, normal) = match self.surfaces {
            Some(before) if surfaces.motion(hit.instance) != Motion::Static => {
                let (position, geometric, smooth) = surfaces.point_in(before, ray, hit);
                let seen = direction(camera, position);
                let normal = if settings.normals == Normals::Geometric { geometric } else { smooth };
                // The filter compares smooth normals on the side of the geometric one that is seen.
                let turned = if geometric.dot(seen) > 0.0 { -geometric } else { geometric };
                (position, if normal.dot(turned) < 0.0 { -normal } else { normal })
            }
            _ => (now.position, now.normal),
        };
        let depth = camera.depth(position);
        Guide { position, depth, normal, footprint: camera.footprint(depth) }
    }

    /// Accumulates row `y`: `rows` are its filtered planes, openness with near radiance and bent normals, which become those
    /// of the mean. What is kept of it goes to `means`.
    pub(super) fn accumulate(
        &self,
        (settings, view): (&Settings, &View),
        pass1: &Pass1,
        y: usize,
        [ambient, bent]: [&mut [Vec4]; 2],
        means: &mut [Mean],
    ) {
        let earlier = self.earlier.map(History::earlier);
        let going_on = earlier.as_ref().map(|earlier| {
            (earlier, Accumulation::new(settings, &view.camera, earlier.camera, self.scene_moved))
        });
        let first = y * ambient.len();
        for (x, mean) in means.iter_mut().enumerate() {
            let pixel = first + x;
            let now = Mean { ambient: ambient[x], bent: bent[x], frames: 1.0 };
            *mean = match &going_on {
                Some((earlier, accumulation)) if pass1.guides[pixel].is_surface() => {
                    let path = Path { now: &pass1.guides[pixel], then: &pass1.then[pixel] };
                    accumulation.update(pixel, &path, earlier, &now)
                }
                _ => now,
            };
            (ambient[x], bent[x]) = (mean.ambient, mean.bent);
        }
    }

    /// How far the point of pixel `(x, y)` moved in the picture since it was `then`, pixels.
    pub(super) fn motion(&self, (x, y): (usize, usize), then: &Guide) -> Vec2 {
        let place = self.earlier.and_then(|earlier| earlier.view.camera.project(then.position));
        place.map_or(Vec2::ZERO, |(place, _)| Vec2::new(x as f32, y as f32) - place)
    }
}

/// Direction in which `camera` sees `point`, of any length.
fn direction(camera: &Camera, point: Vec3) -> Vec3 {
    match camera.projection() {
        ambray_core::camera::Projection::Perspective { .. } => point - camera.position(),
        ambray_core::camera::Projection::Orthographic { .. } => camera.forward(),
    }
}
