//! Screen-space ambient occlusion: points in the hemisphere above a surface, and which of them are behind what is seen
//! (Mittring 2007, "Finding next gen: CryEngine 2"; in a hemisphere as Chapman 2013, "SSAO tutorial", made it popular).

use ambray_core::{
    control::{Cancelled, Control},
    sampling::{pcg, unit_float},
    settings::{ScreenQuality, Settings},
};
use glam::{Vec2, Vec3};

use crate::{Screen, blur::box_blur, tile::Tile};

/// SSAO with a hemisphere of points.
///
/// Neither points nor rotations depend on the frame: the published kernel is made once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ssao {
    /// Points a pixel. Published: 64.
    pub samples: u32,
    /// How far a point must be behind a surface to count as blocked, in radii. Chapman has none; 1/20 is what the method is
    /// used with since (de Vries 2015, "LearnOpenGL": 0.025 for a radius of 0.5), against the depth of pixels being that of
    /// their centres.
    pub bias: f32,
}

impl Ssao {
    /// The method with the samples that `settings` ask for.
    #[must_use]
    pub fn of(settings: &Settings) -> Self {
        let samples = match settings.screen_quality {
            ScreenQuality::Low => 16,
            ScreenQuality::Medium => 32,
            ScreenQuality::High => 64,
            ScreenQuality::Ultra => 256,
        };
        Self { samples, bias: 0.05 }
    }

    /// Openness of every pixel, in [0, 1]; 1 where nothing is seen.
    ///
    /// # Errors
    /// If the caller stops it.
    pub fn estimate(&self, screen: &Screen, control: &Control<'_>) -> Result<Vec<f32>, Cancelled> {
        let kernel: Vec<Vec3> = (0..self.samples).map(|i| self.kernel_point(i, screen.seed)).collect();
        let rotations = Tile::new(screen.seed, |random| rotation(random(0), random(1)));
        screen.map(control, |x, y| {
            let Some(origin) = screen.position(x, y) else { return 1.0 };
            let hemisphere = Hemisphere::new(screen.normal(x, y), rotations.at(x, y));
            let blocked = |&point: &Vec3| {
                self.blocked(screen, origin, origin + hemisphere.to_view(point) * screen.radius)
            };
            1.0 - kernel.iter().map(blocked).sum::<f32>() / self.samples as f32
        })
    }

    /// The mean over 4 × 4 pixels that hides the tile of rotations (Chapman 2013).
    ///
    /// # Errors
    /// If the caller stops it.
    pub fn filter(&self, screen: &Screen, raw: &[f32], control: &Control<'_>) -> Result<Vec<f32>, Cancelled> {
        box_blur(screen, raw, control)
    }

    /// Point i of the kernel, in the unit hemisphere around z: a random direction, drawn from a box as published (corners
    /// come up more often), at a distance that grows with i and crowds the points near the surface.
    fn kernel_point(&self, i: u32, seed: u32) -> Vec3 {
        let random = |dimension: u32| unit_float(pcg(pcg(3 * i + dimension) ^ pcg(seed)));
        let direction = Vec3::new(2.0 * random(0) - 1.0, 2.0 * random(1) - 1.0, random(2));
        let share = i as f32 / self.samples as f32;
        direction.try_normalize().unwrap_or(Vec3::Z) * (0.1 + 0.9 * share * share)
    }

    /// Degree to which the view-space `sample` around `origin` is blocked: 0 in front of what is seen there, and ever less the
    /// farther in depth that is from the origin.
    fn blocked(&self, screen: &Screen, origin: Vec3, sample: Vec3) -> f32 {
        let Some(seen) = screen.project(sample).and_then(|pixel| seen_at(screen, pixel)) else { return 0.0 };
        if seen > sample.z - self.bias * screen.radius {
            return 0.0;
        }
        let range = (screen.radius / (origin.z - seen).abs()).min(1.0);
        range * range * (3.0 - 2.0 * range)
    }
}

/// Depth seen at the pixel next to `pixel`; `None` outside the picture, where nothing can block.
fn seen_at(screen: &Screen, pixel: Vec2) -> Option<f32> {
    let (x, y) = Screen::nearest(pixel);
    screen.depth_at(x, y)
}

/// Unit vector in the picture plane for two random numbers, drawn from a box as published.
fn rotation(a: f32, b: f32) -> Vec3 {
    Vec3::new(2.0 * a - 1.0, 2.0 * b - 1.0, 0.0).try_normalize().unwrap_or(Vec3::X)
}

/// Frame of a normal, turned about it.
struct Hemisphere {
    tangent: Vec3,
    bitangent: Vec3,
    normal: Vec3,
}

impl Hemisphere {
    /// The frame whose tangent is `turn` without its part along the normal (Gram and Schmidt).
    fn new(normal: Vec3, turn: Vec3) -> Self {
        let tangent = (turn - normal * turn.dot(normal)).try_normalize();
        let tangent = tangent.unwrap_or_else(|| normal.any_orthonormal_vector());
        Self { tangent, bitangent: normal.cross(tangent), normal }
    }

    fn to_view(&self, local: Vec3) -> Vec3 {
        self.tangent * local.x + self.bitangent * local.y + self.normal * local.z
    }
}
