//! Cameras: from pixels to primary rays (pass 1), and the size of a pixel in the scene (spec §7).

use glam::Vec3;

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
        Self { position, forward, right, up: right.cross(forward), projection, width, height }
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

    /// Width and height of the picture in pixels.
    #[must_use]
    pub const fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Primary ray through the centre of pixel (x, y), unbounded.
    #[must_use]
    pub fn primary_ray(&self, x: u32, y: u32, seed: u32) -> Ray {
        // Picture coordinates: x to the right, y up, y from -1 to 1 over the height of the picture.
        let half = 0.5 * self.height as f32;
        let (px, py) = ((x as f32 + 0.5 - 0.5 * self.width as f32) / half, (half - y as f32 - 0.5) / half);
        let (origin, direction) = match self.projection {
            Projection::Perspective { vertical_fov } => {
                let tan = libm::tanf(0.5 * vertical_fov);
                (self.position, (self.forward + self.right * (px * tan) + self.up * (py * tan)).normalize())
            }
            Projection::Orthographic { height } => {
                (self.position + (self.right * px + self.up * py) * (0.5 * height), self.forward)
            }
        };
        Ray { origin, t_max: f32::INFINITY, direction, seed }
    }

    /// View depth of `point`: its distance from the camera plane, scene units.
    #[must_use]
    pub fn depth(&self, point: Vec3) -> f32 {
        (point - self.position).dot(self.forward)
    }

    /// Size of a pixel at view depth `depth`, scene units: z · 2 tan(fov/2)/height (spec §7).
    #[must_use]
    pub fn footprint(&self, depth: f32) -> f32 {
        match self.projection {
            Projection::Perspective { vertical_fov } => {
                depth * 2.0 * libm::tanf(0.5 * vertical_fov) / self.height as f32
            }
            Projection::Orthographic { height } => height / self.height as f32,
        }
    }
}
