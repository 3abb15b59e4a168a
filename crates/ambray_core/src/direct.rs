//! Direct light: Σ E cos V over the lights, with one shadow ray per point and light (spec §4).

use glam::Vec3;

use crate::{
    light::Light,
    offset::RayOffset,
    trace::{Ray, Trace},
};

/// A point that receives direct light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Receiver {
    /// Position, world space.
    pub position: Vec3,
    /// Unit geometric normal on the side to be lit.
    pub geometric_normal: Vec3,
    /// Unit normal n of the cosine.
    pub normal: Vec3,
    /// Reach of its triangle (see [`RayOffset::apply`]), scene units.
    pub reach: f32,
    /// Seed of the shadow rays.
    pub seed: u32,
}

/// Direct light at a [`Receiver`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Received {
    /// Σ E max(0, n·l) V over the lights, linear RGB.
    pub irradiance: Vec3,
    /// Shadow rays traced for it.
    pub shadow_rays: u32,
}

/// What lights the receivers.
#[derive(Clone, Copy, Debug)]
pub struct DirectLighting<'a> {
    /// The lights.
    pub lights: &'a [Light],
    /// How shadow rays leave their surface.
    pub offset: RayOffset,
    /// Whether shadow rays are traced; V is 1 otherwise.
    pub shadows: bool,
}

/// Buffers that are reused from batch to batch.
#[derive(Debug, Default)]
pub struct DirectScratch {
    rays: Vec<Ray>,
    arriving: Vec<(u32, Vec3)>,
    blocked: Vec<bool>,
}

/// Writes the direct light at `receivers[i]` to `received[i]`.
///
/// Lights below the geometric horizon never reach a point.
#[inline(always)]
pub fn direct_irradiance(
    trace: &impl Trace,
    lighting: DirectLighting<'_>,
    receivers: &[Receiver],
    scratch: &mut DirectScratch,
    received: &mut [Received],
) {
    let DirectLighting { lights, offset, shadows } = lighting;
    received.fill(Received::default());
    // Light by light, so that a batch holds parallel or converging rays.
    for light in lights {
        scratch.rays.clear();
        scratch.arriving.clear();
        for (i, receiver) in receivers.iter().enumerate() {
            let incident = light.incident(receiver.position);
            let cos = receiver.normal.dot(incident.to_light);
            let arriving = incident.irradiance * cos;
            let above_horizon = receiver.geometric_normal.dot(incident.to_light) > 0.0;
            if cos > 0.0 && above_horizon && arriving != Vec3::ZERO {
                let origin = offset.apply(receiver.position, receiver.geometric_normal, receiver.reach);
                let (direction, t_max) = (incident.to_light, incident.distance);
                scratch.rays.push(Ray { origin, t_max, direction, seed: receiver.seed });
                scratch.arriving.push((i as u32, arriving));
            }
        }
        scratch.blocked.clear();
        scratch.blocked.resize(scratch.rays.len(), false);
        if shadows {
            trace.any_hits(&scratch.rays, &mut scratch.blocked);
        }
        for (&(i, arriving), &blocked) in scratch.arriving.iter().zip(&scratch.blocked) {
            let received = &mut received[i as usize];
            received.shadow_rays += u32::from(shadows);
            if !blocked {
                received.irradiance += arriving;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::Hit;

    /// Blocks every ray that goes towards negative x.
    struct HalfBlocked;

    impl Trace for HalfBlocked {
        fn closest_hits(&self, _rays: &[Ray], _hits: &mut [Hit]) {}

        fn any_hits(&self, rays: &[Ray], blocked: &mut [bool]) {
            rays.iter().zip(blocked).for_each(|(ray, blocked)| *blocked = ray.direction.x < 0.0);
        }
    }

    fn receive(lights: &[Light], normal: Vec3, shadows: bool) -> Received {
        let receiver =
            Receiver { position: Vec3::ZERO, geometric_normal: Vec3::Y, normal, reach: 0.0, seed: 0 };
        let mut received = [Received::default()];
        let lighting = DirectLighting { lights, offset: RayOffset::UNIT, shadows };
        direct_irradiance(&HalfBlocked, lighting, &[receiver], &mut DirectScratch::default(), &mut received);
        received[0]
    }

    #[test]
    fn cosine_shadow_and_horizon() {
        let sun = |x: f32, y: f32| Light::Directional {
            to_light: Vec3::new(x, y, 0.0).normalize(),
            irradiance: Vec3::new(2.0, 1.0, 0.5),
        };
        let free = receive(&[sun(0.6, 0.8)], Vec3::Y, true);
        assert!(free.irradiance.abs_diff_eq(Vec3::new(1.6, 0.8, 0.4), 1e-6) && free.shadow_rays == 1);
        // Both suns shine, but one is blocked; without shadows it is not, and no rays are traced.
        let both = [sun(0.6, 0.8), sun(-0.6, 0.8)];
        assert_eq!(receive(&both, Vec3::Y, true), Received { shadow_rays: 2, ..free });
        let unshadowed = receive(&both, Vec3::Y, false);
        assert!(
            unshadowed.irradiance.abs_diff_eq(2.0 * free.irradiance, 1e-6) && unshadowed.shadow_rays == 0
        );
        // Below the geometric horizon nothing arrives, even where the shading normal faces the light.
        assert_eq!(receive(&[sun(0.9, -0.1)], Vec3::X, true), Received::default());
        assert_eq!(receive(&[sun(-0.9, 0.1)], Vec3::X, true), Received::default());
    }
}
