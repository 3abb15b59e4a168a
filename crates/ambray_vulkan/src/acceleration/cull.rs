//! Which rays of a frame can meet a placed structure.

use ambray_core::camera::{Camera, Projection};
use glam::Vec3;

use super::bounds::Bounds;
use super::rays;

/// What is known about the rays of a frame. It only ever leaves out what no ray can meet.
#[derive(Clone, Copy, Debug)]
pub struct Culling<'a> {
    /// Where primary rays come from.
    pub camera: &'a Camera,
    /// Farthest that ambient rays and chords go from a visible point, scene units; may be infinite.
    pub reach: f32,
    /// Whether shadow rays are traced. They may start and end anywhere.
    pub has_lights: bool,
}

/// Share of the largest coordinate by which a box must be outside: covers the rounding of boxes, of rays, and their
/// offsets from surfaces, which all follow coordinates and are below 2⁻¹⁵ of them.
const SLACK: f32 = 1e-4;

/// Share of the reach by which a box must be farther than that.
const REACH_SLACK: f32 = 0.01;

/// The camera's view as half-spaces.
#[derive(Debug)]
pub(super) struct View {
    /// Unit normals to the inside and distances: a point p is inside where n · p + d ≥ 0. Empty if nothing can be said.
    planes: Vec<(Vec3, f32)>,
    reach: f32,
    slack: f32,
    shadow: u8,
}

impl View {
    /// Prepares for a scene whose largest coordinate is `extent`; `None` leaves everything in.
    pub(super) fn new(culling: Option<&Culling<'_>>, extent: f32) -> Self {
        let Some(culling) = culling else {
            return Self { planes: Vec::new(), reach: f32::INFINITY, slack: 0.0, shadow: rays::SHADOW };
        };
        let position = culling.camera.position();
        Self {
            planes: planes(culling.camera),
            reach: culling.reach * (1.0 + REACH_SLACK),
            slack: SLACK * extent.max(position.abs().max_element()),
            shadow: if culling.has_lights { rays::SHADOW } else { 0 },
        }
    }

    /// Bits of the rays that may meet what is in `bounds`.
    pub(super) fn mask(&self, bounds: Bounds) -> u8 {
        let outside = self.planes.iter().map(|&plane| outside(bounds, plane)).fold(0.0, f32::max);
        // Written so that what is not a number stays in.
        let is_unseen = outside > self.slack;
        let is_unreached = outside > self.slack + self.reach;
        let primary = if is_unseen { 0 } else { rays::PRIMARY };
        let ambient = if is_unreached { 0 } else { rays::AMBIENT | rays::CHORD };
        primary | ambient | self.shadow
    }
}

/// How far the whole box is beyond a plane. Negative or 0 where it is not; then the view may contain some of it.
fn outside(bounds: Bounds, (normal, distance): (Vec3, f32)) -> f32 {
    let innermost = Vec3::select(normal.cmpge(Vec3::ZERO), bounds.hi, bounds.lo);
    -(normal.dot(innermost) + distance)
}

/// Sides of the view, and the plane of the camera itself: nothing behind it is seen.
fn planes(camera: &Camera) -> Vec<(Vec3, f32)> {
    let (width, height) = camera.size();
    let half_height = 0.5 * height as f32 * camera.footprint(1.0);
    let half_width = half_height * width as f32 / height as f32;
    let (forward, right, up) = (camera.forward(), camera.right(), camera.up());
    let through = |normal: Vec3, offset: f32| (normal, offset - normal.dot(camera.position()));
    let sides = [(right, half_width), (-right, half_width), (up, half_height), (-up, half_height)];
    let mut planes = vec![through(forward, 0.0)];
    planes.extend(sides.map(|(side, half)| match camera.projection() {
        // Inside is side · p + half ≥ 0, at depth 1: side · p + half forward · p ≥ 0 from the eye.
        Projection::Perspective { .. } => through((side + forward * half).normalize(), 0.0),
        Projection::Orthographic { .. } => through(side, half),
    }));
    let is_usual = half_width.is_finite() && half_height.is_finite() && half_width > 0.0 && half_height > 0.0;
    if is_usual { planes } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Uniform in [0, 1), a function of the index.
    fn random(index: &mut u32) -> f32 {
        *index = ambray_core::sampling::pcg(*index);
        (*index >> 8) as f32 / (1 << 24) as f32
    }

    fn random_point(index: &mut u32, scale: f32) -> Vec3 {
        (Vec3::from_array([(); 3].map(|()| random(index))) - 0.5) * scale
    }

    #[test]
    fn what_sampled_rays_meet_is_never_left_out() {
        let mut index = 7;
        let (mut unseen, mut unreached) = (0, 0);
        for round in 0..300 {
            let projection = if round % 2 == 0 {
                Projection::Perspective { vertical_fov: 0.3 + 2.0 * random(&mut index) }
            } else {
                Projection::Orthographic { height: 0.5 + 4.0 * random(&mut index) }
            };
            let eye = random_point(&mut index, 6.0);
            let forward = random_point(&mut index, 1.0).normalize();
            let camera = Camera::new(eye, forward, Vec3::Y, projection, 64, 36);
            let reach = 2.0 * random(&mut index);
            let view = View::new(Some(&Culling { camera: &camera, reach, has_lights: false }), 10.0);
            let corner = random_point(&mut index, 16.0);
            let bounds = Bounds { lo: corner, hi: corner + 0.5 + random_point(&mut index, 1.0) };
            let mask = view.mask(bounds);
            unseen += u32::from(mask & rays::PRIMARY == 0);
            unreached += u32::from(mask == 0);
            assert_eq!(mask & rays::SHADOW, 0);
            for _ in 0..300 {
                let (x, y) = ((64.0 * random(&mut index)) as u32, (36.0 * random(&mut index)) as u32);
                let ray = camera.primary_ray(x, y, 0);
                let visible = ray.origin + ray.direction * (20.0 * random(&mut index));
                let met = visible.clamp(bounds.lo, bounds.hi);
                let distance = met.distance(visible);
                assert!(distance > 0.0 || mask & rays::PRIMARY != 0, "{bounds:?} of {camera:?}");
                assert!(distance > reach || mask & rays::AMBIENT != 0, "{bounds:?} of {camera:?}");
            }
        }
        assert!(unseen > 100 && unreached > 50 && unreached < unseen, "{unseen} {unreached}");
    }

    #[test]
    fn nothing_known_keeps_everything() {
        let far = Bounds { lo: Vec3::splat(1e9), hi: Vec3::splat(2e9) };
        assert_eq!(View::new(None, 1.0).mask(far), rays::ALL);
        let camera = |fov| {
            Camera::new(Vec3::ZERO, Vec3::X, Vec3::Y, Projection::Perspective { vertical_fov: fov }, 4, 4)
        };
        let infinite = Culling { camera: &camera(0.5), reach: f32::INFINITY, has_lights: true };
        assert_eq!(View::new(Some(&infinite), 1.0).mask(far) & rays::PRIMARY, 0, "diagonal is not in view");
        assert_eq!(View::new(Some(&infinite), 1.0).mask(far) | rays::PRIMARY, rays::ALL);
        // A view of half a turn and more has no sides.
        let wide = Culling { camera: &camera(3.5), reach: 0.0, has_lights: false };
        assert_eq!(View::new(Some(&wide), 1.0).mask(far), rays::ALL & !rays::SHADOW);
    }
}
