//! Cameras: from pixels to primary rays (pass 1), and the size of a pixel in the scene (spec §7).

use glam::{Vec2, Vec3};

use crate::trace::Ray;

/// How a camera maps directions to the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Full vertical angle of view, radians.
    Perspective {
        /// Angle between the top and the bottom of the picture.
        vertical_fov: f32,
    },
    /// Parallel projection.
    Orthographic {
        /// Height of the picture in scene units.
        height: f32,
    },
}

/// A camera with the size of its picture. Pixel (0, 0) is the top left one; rays pass through pixel centres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    position: Vec3,
    forward: Vec3,
    right: Vec3,
    up: Vec3,
    projection: Projection,
    /// Half the height of the picture at depth 1, or anywhere in parallel projection.
    half_height: f32,
    width: u32,
    height: u32,
}

impl Camera {
    /// Camera at `position` looking along the unit vector `forward`, with `up` the direction that appears upright.
    ///
    /// `up` need not be orthogonal to `forward`; where it is parallel, another one is chosen.
    #[must_use]
    pub fn new(
        position: Vec3,
        forward: Vec3,
        up: Vec3,
        projection: Projection,
        width: u32,
        height: u32,
    ) -> Self {
        let right = forward.cross(up).try_normalize().unwrap_or_else(|| forward.any_orthonormal_vector());
        let half_height = match projection {
            Projection::Perspective { vertical_fov } => libm::tanf(0.5 * vertical_fov),
            Projection::Orthographic { height } => 0.5 * height,
        };
        Self { position, forward, right, up: right.cross(forward), projection, half_height, width, height }
    }

    /// Eye point, world space.
    #[must_use]
    pub const fn position(&self) -> Vec3 {
        self.position
    }

    /// Unit viewing direction.
    #[must_use]
    pub const fn forward(&self) -> Vec3 {
        self.forward
    }

    /// Unit vector to the right in the picture.
    #[must_use]
    pub const fn right(&self) -> Vec3 {
        self.right
    }

    /// Unit vector up in the picture.
    #[must_use]
    pub const fn up(&self) -> Vec3 {
        self.up
    }

    /// Perspective or parallel projection.
    #[must_use]
    pub const fn projection(&self) -> Projection {
        self.projection
    }

    /// Half the height of the picture at depth 1, or anywhere in parallel projection, scene units.
    #[must_use]
    pub const fn half_height(&self) -> f32 {
        self.half_height
    }

    /// Width and height of the picture in pixels.
    #[must_use]
    pub const fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Primary ray through the centre of pixel (x, y), unbounded.
    #[must_use]
    #[inline(always)]
    pub fn primary_ray(&self, x: u32, y: u32, seed: u32) -> Ray {
        // Place in the picture plane: x to the right, y up, scaled so that the picture reaches up to half_height.
        let scale = self.half_height / (0.5 * self.height as f32);
        let right = (x as f32 + 0.5 - 0.5 * self.width as f32) * scale;
        let up = (0.5 * self.height as f32 - y as f32 - 0.5) * scale;
        let offset = self.right * right + self.up * up;
        let (origin, direction) = match self.projection {
            Projection::Perspective { .. } => (self.position, (self.forward + offset).normalize()),
            Projection::Orthographic { .. } => (self.position + offset, self.forward),
        };
        Ray { origin, t_max: f32::INFINITY, direction, seed }
    }

    /// Where `point` is in the picture, in pixels from the centre of pixel (0, 0) to the right and down, and its view depth;
    /// `None` behind a perspective camera. The place may be outside the picture.
    #[must_use]
    pub fn project(&self, point: Vec3) -> Option<(Vec2, f32)> {
        let offset = point - self.position;
        let depth = offset.dot(self.forward);
        let pixel = self.footprint(depth);
        let is_seen = pixel > 0.0;
        is_seen.then(|| {
            let x = offset.dot(self.right) / pixel + 0.5 * (self.width as f32 - 1.0);
            let y = 0.5 * (self.height as f32 - 1.0) - offset.dot(self.up) / pixel;
            (Vec2::new(x, y), depth)
        })
    }

    /// View depth of `point`: its distance from the camera plane, scene units.
    #[must_use]
    #[inline(always)]
    pub fn depth(&self, point: Vec3) -> f32 {
        (point - self.position).dot(self.forward)
    }

    /// Size of a pixel at view depth `depth`, scene units: z · 2 tan(fov/2)/height (spec §7).
    #[must_use]
    #[inline(always)]
    pub fn footprint(&self, depth: f32) -> f32 {
        let pixel = self.half_height / (0.5 * self.height as f32);
        match self.projection {
            Projection::Perspective { .. } => depth * pixel,
            Projection::Orthographic { .. } => pixel,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: u32 = 640;
    const HEIGHT: u32 = 360;

    fn camera(projection: Projection) -> Camera {
        Camera::new(Vec3::new(1.0, 2.0, 3.0), Vec3::NEG_Z, Vec3::Y, projection, WIDTH, HEIGHT)
    }

    #[test]
    fn rays_span_the_angle_of_view() {
        let camera = camera(Projection::Perspective { vertical_fov: 1.0 });
        let (top, bottom) = (camera.primary_ray(320, 0, 0), camera.primary_ray(320, HEIGHT - 1, 0));
        let angle = top.direction.angle_between(bottom.direction);
        // From the middle of the first pixel to the middle of the last one.
        let expected = 2.0 * (0.5_f32.tan() * 359.0 / 360.0).atan();
        assert!((angle - expected).abs() < 1e-5, "{angle} for {expected}");
        assert!(top.direction.y > 0.0 && camera.primary_ray(639, 180, 0).direction.x > 0.0);
        assert_eq!(top.origin, camera.position());
    }

    #[test]
    fn neighbouring_rays_are_a_footprint_apart() {
        for projection in
            [Projection::Perspective { vertical_fov: 0.8 }, Projection::Orthographic { height: 4.0 }]
        {
            let camera = camera(projection);
            let at_depth = |x: u32, y: u32, depth: f32| {
                let ray = camera.primary_ray(x, y, 0);
                ray.origin + ray.direction * (depth / ray.direction.dot(camera.forward()))
            };
            for depth in [1.0, 7.0] {
                let (a, b) = (at_depth(100, 50, depth), at_depth(100, 51, depth));
                assert!(
                    (a.distance(b) / camera.footprint(depth) - 1.0).abs() < 1e-3,
                    "{projection:?} at {depth}"
                );
                assert!((camera.depth(a) - depth).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn projection_inverts_rays() {
        for projection in
            [Projection::Perspective { vertical_fov: 0.8 }, Projection::Orthographic { height: 4.0 }]
        {
            let camera = camera(projection);
            for (x, y) in [(0, 0), (639, 359), (100, 50)] {
                let ray = camera.primary_ray(x, y, 0);
                let point = ray.origin + 3.0 * ray.direction;
                let (place, depth) = camera.project(point).expect("in front");
                assert!(place.abs_diff_eq(Vec2::new(x as f32, y as f32), 1e-3), "{place} for {x}, {y}");
                assert_eq!(depth, camera.depth(point));
            }
        }
        let perspective = camera(Projection::Perspective { vertical_fov: 0.8 });
        assert_eq!(perspective.project(perspective.position() - perspective.forward()), None);
    }

    #[test]
    fn looking_straight_up_is_defined() {
        let camera =
            Camera::new(Vec3::ZERO, Vec3::Y, Vec3::Y, Projection::Orthographic { height: 1.0 }, 2, 2);
        assert!(camera.right().is_normalized() && camera.up().is_normalized());
    }
}
