//! Image-space horizon-based ambient occlusion (Bavoil, Sainz and Dimitrov 2008; Bavoil and Sainz 2009, ShaderX7).
//!
//! The depth buffer is taken for a height field. In each direction θ of the picture its horizon rises to an angle h(θ) above
//! the picture plane, the tangent plane to t(θ), and what is between the two is blocked, the less the farther away W:
//!
//! ```text
//! A = 1 − (1/2π) ∫ W(θ) (sin h(θ) − sin t(θ)) dθ,   W(r) = 1 − r²
//! ```

use std::f32::consts::{FRAC_PI_6, TAU};

use ambray_core::{
    control::{Cancelled, Control},
    settings::{ScreenQuality, Settings},
};
use glam::{Vec2, Vec3, Vec3Swizzles};

use crate::{Screen, blur::CrossBilateral, tile::Tile};

/// HBAO.
///
/// As published it does not depend on the frame: its tile of random numbers is made once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hbao {
    /// Directions around a pixel.
    pub directions: u32,
    /// Steps along a direction, over the projected radius; at most one a pixel.
    pub steps: u32,
    /// Angle by which a horizon must rise above the tangent plane, radians, against the creases of coarse meshes.
    pub angle_bias: f32,
    /// Factor of the occlusion. With 1 a direction that is blocked up to the viewer on a surface that faces them is dark.
    pub contrast: f32,
}

/// Deviation from the centre of the filter, pixels, and its sharpness in 1/R: gl_ssao takes 40 a metre for a radius of 2 m.
const BLUR_RADIUS: usize = 3;
const BLUR_SHARPNESS: f32 = 80.0;

/// How a pixel turns its directions and shifts its steps.
#[derive(Clone, Copy)]
struct Jitter {
    /// Cosine and sine of an angle below that between two directions.
    turn: Vec2,
    /// Share of a step, in [0, 1).
    start: f32,
}

impl Hbao {
    /// The method with the samples that `settings` ask for. High, and the bias of 30°, are the defaults of NVIDIA's sample for
    /// Direct3D 10 as its ports keep them; its contrast of 1.25, which equation A above does not have, is left at 1.
    #[must_use]
    pub fn of(settings: &Settings) -> Self {
        let (directions, steps) = match settings.screen_quality {
            ScreenQuality::Low => (6, 6),
            ScreenQuality::Medium => (8, 8),
            ScreenQuality::High => (16, 8),
            ScreenQuality::Ultra => (32, 16),
        };
        Self { directions, steps, angle_bias: FRAC_PI_6, contrast: 1.0 }
    }

    /// Openness of every pixel, in [0, 1]; 1 where nothing is seen.
    ///
    /// # Errors
    /// If the caller stops it.
    pub fn estimate(&self, screen: &Screen, control: &Control<'_>) -> Result<Vec<f32>, Cancelled> {
        let apart = TAU / self.directions as f32;
        let directions: Vec<Vec2> = (0..self.directions).map(|i| unit(i as f32 * apart)).collect();
        let jitters =
            Tile::new(screen.seed, |random| Jitter { turn: unit(random(0) * apart), start: random(1) });
        let bias = unit(self.angle_bias);
        // What the bias takes from a blocked direction the sample gives back through the contrast.
        let strength = self.contrast / ((1.0 - bias.y) * self.directions as f32);
        screen.map(control, |x, y| {
            let Some(position) = screen.position(x, y) else { return 1.0 };
            let pixel = Vec2::new(x as f32, y as f32);
            let (normal, sight) = (screen.normal(x, y), -screen.towards_viewer(position));
            let around = Surroundings { screen, pixel, position, normal, sight, bias };
            let Some(steps) = self.steps_within(screen, position.z) else { return 1.0 };
            let Jitter { turn, start } = jitters.at(x, y);
            let blocked =
                directions.iter().map(|direction| around.blocked(turn.rotate(*direction), steps, start));
            (1.0 - strength * blocked.sum::<f32>()).clamp(0.0, 1.0)
        })
    }

    /// The cross-bilateral filter of NVIDIA's samples.
    ///
    /// # Errors
    /// If the caller stops it.
    pub fn filter(&self, screen: &Screen, raw: &[f32], control: &Control<'_>) -> Result<Vec<f32>, Cancelled> {
        let sharpness = BLUR_SHARPNESS / screen.radius;
        CrossBilateral { radius: BLUR_RADIUS, sharpness }.apply(screen, raw, control)
    }

    /// Steps over the radius as projected at `depth`; `None` where that is less than a pixel.
    fn steps_within(&self, screen: &Screen, depth: f32) -> Option<Steps> {
        let radius = screen.radius / screen.camera().footprint(depth);
        if radius.is_nan() || radius < 1.0 {
            return None;
        }
        let count = (self.steps as f32).min(radius).floor();
        // One step more, so that the last sample is still within the radius and counts.
        Some(Steps { count: count as u32, pixels: radius / (count + 1.0) })
    }
}

/// Steps along a direction.
#[derive(Clone, Copy)]
struct Steps {
    count: u32,
    /// Length of one, pixels.
    pixels: f32,
}

/// A pixel whose horizons are searched.
struct Surroundings<'a> {
    screen: &'a Screen,
    pixel: Vec2,
    position: Vec3,
    normal: Vec3,
    /// Unit vector from the viewer.
    sight: Vec3,
    /// Cosine and sine of the angle bias.
    bias: Vec2,
}

impl Surroundings<'_> {
    /// Σ W(r) (AO_i − AO_i−1) over the samples along `direction` that raise the horizon, AO = sin h − sin t (Bavoil and Sainz
    /// 2009): each rise counts by the distance of what causes it.
    fn blocked(&self, direction: Vec2, steps: Steps, start: f32) -> f32 {
        let (mut blocked, mut above, mut sin_horizon) = (0.0, 0.0, -1.0);
        for step in 0..steps.count {
            let place = self.pixel + direction * ((step as f32 + 1.0 + start) * steps.pixels);
            let (x, y) = Screen::nearest(place);
            let snapped = Vec2::new(x as f32, y as f32);
            let Some(offset) = self.offset_to(snapped, self.screen.depth_at(x, y)) else { continue };
            let square = offset.length_squared() / (self.screen.radius * self.screen.radius);
            // Samples outside the radius have no influence.
            if square >= 1.0 {
                continue;
            }
            let sin = -offset.z / offset.length();
            let rise = sin - self.sin_tangent(snapped - self.pixel);
            if sin > sin_horizon && rise > above {
                blocked += (1.0 - square) * (rise - above);
                (above, sin_horizon) = (rise, sin);
            }
        }
        blocked
    }

    /// Vector from the pixel to what is seen at the pixel `place` at `depth`; `None` at the pixel itself, outside the picture and
    /// where nothing is seen.
    fn offset_to(&self, place: Vec2, depth: Option<f32>) -> Option<Vec3> {
        let depth = depth.filter(|depth| depth.is_finite() && place != self.pixel)?;
        Some(self.screen.unproject(place, depth) - self.position)
    }

    /// sin(t + bias) of the tangent plane towards the pixel that is `way` to the right and down; 1 beyond a right angle.
    ///
    /// It is taken for every snapped sample anew, as NVIDIA's sample does for high quality, so that a plane never blocks
    /// itself: the tangent T is the step in the picture plane, moved along the line of sight onto the tangent plane.
    fn sin_tangent(&self, way: Vec2) -> f32 {
        let step = Vec3::new(way.x, -way.y, 0.0);
        let facing = self.normal.dot(self.sight);
        // A shading normal that faces away has no tangent plane to see.
        if facing >= 0.0 {
            return 1.0;
        }
        let tangent = step - self.sight * (self.normal.dot(step) / facing);
        let length = tangent.length();
        let (sin, cos) = (-tangent.z / length, tangent.xy().length() / length);
        if sin >= self.bias.x { 1.0 } else { sin * self.bias.x + cos * self.bias.y }
    }
}

/// Unit vector at `angle` radians.
fn unit(angle: f32) -> Vec2 {
    let (sin, cos) = libm::sincosf(angle);
    Vec2::new(cos, sin)
}
