//! Batches of rays and their hits.

use std::sync::Arc;

use ambray_core::trace::{Hit, Ray};
use ash::vk::BufferUsageFlags;

use crate::{
    Buffer, Context, Location, Result,
    layout::{self, NONE, RayHit},
};

/// Rays on the device, and room for what they hit.
pub(crate) struct Batch {
    rays: Buffer,
    hits: Buffer,
    count: usize,
}

impl Batch {
    pub(crate) fn new(context: &Arc<Context>, rays: &[Ray]) -> Result<Self> {
        let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        let finite: Vec<layout::Ray> = rays.iter().map(ray).collect();
        let bytes = (rays.len() * size_of::<RayHit>()) as u64;
        Ok(Self {
            rays: context.upload("rays", usage, &finite)?,
            hits: context.buffer("hits", bytes, usage, Location::Readback)?,
            count: rays.len(),
        })
    }

    pub(crate) fn address(&self, view: &mut layout::View) {
        (view.inputs, view.outputs) = (self.rays.address(), self.hits.address());
    }

    /// Appends the hits to `hits`, once the pass has run.
    pub(crate) fn read(&self, hits: &mut Vec<Hit>) {
        hits.extend(self.hits.read::<RayHit>(0, self.count).iter().map(hit));
    }
}

/// The constants of a batch of `count` rays, folded into a picture of `size`; with `any`, any hit will do.
pub(crate) fn constants(size: [u32; 2], count: usize, any: bool) -> layout::View {
    layout::View { size, count: count as u32, mode: any.into(), ..layout::View::default() }
}

fn ray(ray: &Ray) -> layout::Ray {
    layout::Ray {
        origin: ray.origin.to_array(),
        t_max: layout::finite(ray.t_max),
        direction: ray.direction.to_array(),
        seed: ray.seed,
    }
}

const fn hit(hit: &RayHit) -> Hit {
    if hit.instance == NONE {
        return Hit::MISS;
    }
    let RayHit { t, u, v, instance, triangle } = *hit;
    Hit { t, u, v, instance, triangle }
}
