//! Flying: keys push, the mouse looks, the wheel sets the speed.

use glam::Vec3;

use super::Viewpoint;

/// Time in which the speed comes most of the way to what is asked for, seconds.
const INERTIA: f32 = 0.07;
/// Factor of the speed while hurrying.
const HURRY: f32 = 4.0;
/// Factor of the speed for one notch of the wheel.
const NOTCH: f32 = 1.2;
/// Share of the scene's diagonal that is flown in a second at first.
const SPEED_SHARE: f32 = 0.12;
/// Slowest and fastest flight, over the speed of the beginning.
const SPEEDS: (f32, f32) = (1e-4, 1e4);

/// Which way the keys push, each -1 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Thrust {
    /// Along the view.
    pub forward: f32,
    /// To the right in the picture.
    pub right: f32,
    /// Along the upright direction.
    pub up: f32,
    /// Whether to hurry.
    pub fast: bool,
}

/// A flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fly {
    /// Scene units a second.
    speed: f32,
    /// Speed of the beginning.
    normal: f32,
    /// Scene units a second, world space.
    velocity: Vec3,
}

impl Fly {
    /// A flight through a scene of this size.
    #[must_use]
    pub fn through((low, high): (Vec3, Vec3)) -> Self {
        let diagonal = low.distance(high);
        let normal = if diagonal > 0.0 && diagonal.is_finite() { SPEED_SHARE * diagonal } else { 1.0 };
        Self { speed: normal, normal, velocity: Vec3::ZERO }
    }

    /// Scene units a second without hurrying.
    #[must_use]
    pub const fn speed(&self) -> f32 {
        self.speed
    }

    /// Faster by notches of the wheel, or slower.
    pub fn accelerate(&mut self, notches: f32) {
        let (slowest, fastest) = (SPEEDS.0 * self.normal, SPEEDS.1 * self.normal);
        self.speed = (self.speed * libm::powf(NOTCH, notches)).clamp(slowest, fastest);
    }

    /// Moves on for `dt` seconds. The path does not depend on how the time is cut into steps.
    #[must_use]
    pub fn step(&mut self, viewpoint: Viewpoint, thrust: Thrust, dt: f32) -> Viewpoint {
        let wish = thrust.forward * viewpoint.forward()
            + thrust.right * viewpoint.right()
            + thrust.up * viewpoint.up.normalize_or(Vec3::Y);
        let wish = wish.clamp_length_max(1.0) * self.speed * if thrust.fast { HURRY } else { 1.0 };
        // The velocity comes exponentially closer to the wish: integrated exactly over the step.
        let kept = libm::expf(-dt / INERTIA);
        let lag = self.velocity - wish;
        let offset = wish * dt + lag * (INERTIA * (1.0 - kept));
        self.velocity = wish + lag * kept;
        Viewpoint { position: viewpoint.position + offset, target: viewpoint.target + offset, ..viewpoint }
    }

    /// Whether it still moves without being pushed.
    #[must_use]
    pub fn is_gliding(&self) -> bool {
        self.velocity.length() > 0.01 * self.speed
    }

    /// Stands still.
    pub const fn stop(&mut self) {
        self.velocity = Vec3::ZERO;
    }
}

#[cfg(test)]
mod tests {
    use super::{super::tests::somewhere, *};

    const SCENE: (Vec3, Vec3) = (Vec3::splat(-5.0), Vec3::splat(5.0));
    const AHEAD: Thrust = Thrust { forward: 1.0, right: 0.0, up: 0.0, fast: false };

    fn path(thrusts: &[(Thrust, f32)], dt: f32) -> Viewpoint {
        let mut fly = Fly::through(SCENE);
        let mut viewpoint = somewhere();
        for &(thrust, seconds) in thrusts {
            for _ in 0..(seconds / dt).round() as usize {
                viewpoint = fly.step(viewpoint, thrust, dt);
            }
        }
        viewpoint
    }

    #[test]
    fn the_path_does_not_depend_on_the_frame_rate() {
        let sideways = Thrust { right: -1.0, up: 0.5, fast: true, ..Thrust::default() };
        let flight = [(AHEAD, 0.5), (sideways, 0.25), (Thrust::default(), 0.5)];
        let slow = path(&flight, 1.0 / 16.0);
        for dt in [1.0 / 32.0, 1.0 / 64.0, 1.0 / 256.0] {
            let other = path(&flight, dt);
            assert!(slow.position.distance(other.position) < 1e-4, "{dt}");
        }
        assert!(slow.position.distance(somewhere().position) > 0.1);
    }

    #[test]
    fn all_goes_along_and_nothing_turns() {
        let (start, end) = (somewhere(), path(&[(AHEAD, 1.0)], 0.125));
        assert!((end.distance() - start.distance()).abs() < 1e-4);
        assert!(end.forward().distance(start.forward()) < 1e-5);
        let way = end.position - start.position;
        assert!(way.normalize().distance(start.forward()) < 1e-4);
        let expected = Fly::through(SCENE).speed() * (1.0 - INERTIA);
        assert!((way.length() - expected).abs() < 1e-3, "{} for {expected}", way.length());
    }

    #[test]
    fn it_comes_to_rest_when_nothing_pushes() {
        let (mut fly, mut viewpoint) = (Fly::through(SCENE), somewhere());
        viewpoint = fly.step(viewpoint, AHEAD, 0.5);
        assert!(fly.is_gliding());
        viewpoint = fly.step(viewpoint, Thrust::default(), 1.0);
        assert!(!fly.is_gliding());
        fly.stop();
        assert_eq!(fly.step(viewpoint, Thrust::default(), 1.0), viewpoint);
    }

    #[test]
    fn diagonals_are_no_faster_and_the_wheel_sets_the_speed() {
        let both = Thrust { right: 1.0, ..AHEAD };
        let way = |thrust| path(&[(thrust, 1.0)], 0.25).position.distance(somewhere().position);
        assert!((way(both) / way(AHEAD) - 1.0).abs() < 1e-4);
        let mut fly = Fly::through(SCENE);
        let normal = fly.speed();
        fly.accelerate(2.0);
        assert!((fly.speed() / normal - NOTCH * NOTCH).abs() < 1e-5);
        fly.accelerate(-1e6);
        assert!(fly.speed() > 0.0);
        assert!(Fly::through((Vec3::ZERO, Vec3::ZERO)).speed() > 0.0);
    }
}
