//! From rays in the order of the caller to packets of rays that agree in direction.

use ambray_core::trace::{Hit, Ray};

use super::Query;
use super::best::Best;
use super::lanes::Rays;
use super::ray::{self, Prepared};

/// Rays of a packet.
pub(crate) const LANES: usize = 16;

/// Neighbours in the batch whose directions have a smaller dot product belong to different runs.
const SAME_RUN: f32 = 0.7;

/// Fills up bundles.
const NOTHING: Ray = Ray { origin: glam::Vec3::ZERO, t_max: 0.0, direction: glam::Vec3::ZERO, seed: 0 };

/// Sixteen numbers, one a ray.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Numbers(pub(crate) [f32; LANES]);

impl Numbers {
    pub(crate) const ZERO: Self = Self([0.0; LANES]);

    #[inline(always)]
    pub(crate) fn load<R: Rays>(&self) -> R {
        R::load(&self.0)
    }
}

/// Up to sixteen rays as structure of arrays.
pub(crate) struct Bundle {
    origin: [Numbers; 3],
    direction: [Numbers; 3],
    pub(crate) t_max: Numbers,
    /// Lanes of rays that can hit anything.
    pub(crate) able: u32,
    /// For each axis the lanes whose reciprocals are negative.
    down: [u32; 3],
    /// Lanes whose direction is longest along x, and those where it is along y.
    longest: [u32; 2],
}

impl Bundle {
    /// Takes the next rays of a batch, at least one and no more than sixteen; also returns how many.
    ///
    /// The caller delivers runs of parallel rays, of no fixed length. A bundle ends with a run if it can do so in its second
    /// half, so that the next run is not torn.
    #[inline(always)]
    pub(crate) fn next<R: Rays>(rays: &[Ray]) -> (Self, usize) {
        let mut bundle = Self::of::<R>(&rays[..rays.len().min(LANES)]);
        if rays.len() <= LANES || bundle.group(bundle.able | 1) == u32::from(u16::MAX) {
            return (bundle, rays.len().min(LANES));
        }
        let mut turns = 0_u32;
        let mut last = rays.first().map_or(glam::Vec3::ZERO, |ray| ray.direction);
        for (lane, ray) in rays.iter().take(LANES + 1).enumerate() {
            turns |= u32::from(last.dot(ray.direction) < SAME_RUN) << lane;
            last = ray.direction;
        }
        let count = match turns >> (LANES / 2) {
            0 => rays.len().min(LANES),
            late => LANES / 2 + late.ilog2() as usize,
        };
        bundle.able &= (1 << count) - 1;
        (bundle, count)
    }

    /// All of `rays`, no more than sixteen.
    #[inline(always)]
    pub(crate) fn of<R: Rays>(rays: &[Ray]) -> Self {
        let mut bundle = Self {
            origin: [Numbers::ZERO; 3],
            direction: [Numbers::ZERO; 3],
            t_max: Numbers::ZERO,
            able: 0,
            down: [0; 3],
            longest: [0; 2],
        };
        let mut some = [NOTHING; LANES];
        let [ox, oy, oz, t_max, dx, dy, dz, _] = R::transposed(rays.first_chunk().unwrap_or_else(|| {
            some[..rays.len()].copy_from_slice(rays);
            &some
        }));
        bundle.origin = [Numbers(ox.to_array()), Numbers(oy.to_array()), Numbers(oz.to_array())];
        bundle.direction = [Numbers(dx.to_array()), Numbers(dy.to_array()), Numbers(dz.to_array())];
        bundle.t_max = Numbers(t_max.to_array());
        bundle.classify::<R>();
        bundle.able &= ((1_u64 << rays.len()) - 1) as u32;
        bundle
    }

    #[inline(always)]
    fn classify<R: Rays>(&mut self) {
        let zero = R::splat(0.0);
        let (largest, smallest) = (R::splat(f32::MAX), R::splat(f32::MIN));
        let mut able = zero.lt(self.t_max.load());
        let mut directed = 0;
        for (axis, down) in self.down.iter_mut().enumerate() {
            let origin: R = self.origin[axis].load();
            let direction: R = self.direction[axis].load();
            able &= origin.le(largest) & smallest.le(origin) & direction.le(largest) & smallest.le(direction);
            directed |= direction.lt(zero) | zero.lt(direction);
            *down = direction.signs();
        }
        self.able = able & directed;
        let (x, y, z): (R, R, R) =
            (self.direction[0].load(), self.direction[1].load(), self.direction[2].load());
        let (x, y, z) = (x.max(zero.sub(x)), y.max(zero.sub(y)), z.max(zero.sub(z)));
        let along_x = y.le(x) & z.le(x);
        self.longest = [along_x, z.le(y) & !along_x];
    }

    /// Those of the rays `waiting` that agree with the first of them in the order of planes and in the longest axis.
    #[inline(always)]
    pub(crate) fn group(&self, waiting: u32) -> u32 {
        let first = waiting.trailing_zeros();
        // Lanes that differ from the first in one property.
        let differ = |lanes: u32| if lanes >> first & 1 != 0 { !lanes } else { lanes };
        let [x, y, z] = self.down.map(differ);
        let [along_x, along_y] = self.longest.map(differ);
        waiting & !(x | y | z | along_x | along_y)
    }

    /// The packet of the rays of `group`.
    #[inline(always)]
    pub(crate) fn packet<R: Rays>(&self, group: u32) -> Packet {
        let first = group.trailing_zeros();
        let is = |lanes: u32| lanes >> first & 1 != 0;
        let longest = if is(self.longest[0]) {
            0
        } else if is(self.longest[1]) {
            1
        } else {
            2
        };
        let axes = ray::AXES[longest];
        let (near, far) = ray::planes(self.down.map(is));
        let mut packet = Packet {
            origin: [Numbers::ZERO; 3],
            reciprocal: [Numbers::ZERO; 3],
            shear: [Numbers::ZERO; 3],
            limit: Numbers(R::select(group, self.t_max.load(), R::splat(-1.0)).to_array()),
            origins: [[0.0; 2]; 3],
            reciprocals: [[0.0; 2]; 3],
            axes,
            near,
            far,
            largest_limit: 0.0,
            hits: 0,
        };
        packet.largest_limit = packet.limit.load::<R>().largest();
        // Interleaved rays are parallel on flat surfaces.
        let mut same = group;
        for axis in 0..3 {
            let direction: R = self.direction[axis].load();
            let of_first = R::splat(self.direction[axis].0[first as usize % LANES]);
            same &= direction.le(of_first) & of_first.le(direction);
        }
        let is_parallel = same == group;
        let one = R::splat(1.0);
        let longest = ray::LARGEST_RECIPROCAL;
        for axis in 0..3 {
            let lane = first as usize % LANES;
            let origin = R::select(group, self.origin[axis].load(), R::splat(self.origin[axis].0[lane]));
            packet.origin[axis] = Numbers(origin.to_array());
            let (low, high) = (origin.smallest(), origin.largest());
            let is_down = is(self.down[axis]);
            packet.origins[axis] = if is_down { [low, high] } else { [high, low] };
            let direction =
                R::select(group, self.direction[axis].load(), R::splat(self.direction[axis].0[lane]));
            let reciprocal = one.div(direction).min(R::splat(longest)).max(R::splat(-longest));
            packet.reciprocal[axis] = Numbers(reciprocal.to_array());
            let (low, high) = if is_parallel {
                let any = packet.reciprocal[axis].0[0];
                (any, any)
            } else {
                (reciprocal.smallest(), reciprocal.largest())
            };
            packet.reciprocals[axis] = if is_down { [high, low] } else { [low, high] };
        }
        let [x, y, z] = axes;
        let (x, y): (R, R) = (self.direction[x].load(), self.direction[y].load());
        let z: R = self.direction[z].load();
        packet.shear[0] = Numbers(x.div(z).to_array());
        packet.shear[1] = Numbers(y.div(z).to_array());
        // Of the longest axis, so it is not cut off.
        packet.shear[2] = packet.reciprocal[axes[2]];
        packet
    }
}

/// Rays that agree in the order of planes and in the longest axis.
pub(crate) struct Packet {
    pub(crate) origin: [Numbers; 3],
    pub(crate) reciprocal: [Numbers; 3],
    pub(crate) shear: [Numbers; 3],
    /// t of the best hits so far, or ends of the rays; negative for rays that are absent.
    pub(crate) limit: Numbers,
    /// For each axis the origins that are farthest and least far along the rays.
    pub(crate) origins: [[f32; 2]; 3],
    /// For each axis the reciprocals of the smallest and the largest absolute value.
    pub(crate) reciprocals: [[f32; 2]; 3],
    /// Largest of the limits at the start.
    pub(crate) largest_limit: f32,
    /// How many hits have shortened rays, modulo 2¹⁶. A box is tested too often or, since the walk keeps fewer boxes than that,
    /// never not at all for it.
    pub(crate) hits: u16,
    /// As in [`Prepared`].
    pub(crate) axes: [usize; 3],
    pub(crate) near: [usize; 3],
    pub(crate) far: [usize; 3],
}

impl Packet {
    /// The `lanes` have hits at `t`.
    #[inline(always)]
    pub(crate) fn shorten<R: Rays>(&mut self, lanes: u32, t: R) {
        t.put(lanes, &mut self.limit.0);
        self.hits = self.hits.wrapping_add(1);
    }

    /// A ray that went alone comes back with `hit`.
    #[inline(always)]
    pub(crate) fn settle<Q: Query>(&mut self, lane: usize, hit: &Hit, best: &mut Best) {
        self.limit.0[lane % LANES] = hit.t;
        self.hits = self.hits.wrapping_add(1);
        best.replace(lane, hit);
    }

    /// One of the rays, bit for bit what [`Prepared::new`] makes of it.
    #[inline(always)]
    pub(crate) fn ray(&self, lane: usize) -> Prepared {
        let lane = lane % LANES;
        let of = |numbers: &[Numbers; 3]| [numbers[0].0[lane], numbers[1].0[lane], numbers[2].0[lane]];
        Prepared {
            origin: of(&self.origin),
            reciprocal: of(&self.reciprocal),
            axes: self.axes,
            shear: of(&self.shear),
            near: self.near,
            far: self.far,
        }
    }
}
