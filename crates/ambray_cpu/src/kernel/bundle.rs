//! Sixteen rays as vectors see them, and which of them agree in direction.

use ambray_core::trace::Ray;

use super::lanes::Rays;
use super::ray::{self, Axis, OneRay, Order, Prepared};
use super::slab::{self, Slab};

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
    pub(crate) fn of<R: Rays>(lanes: R) -> Self {
        Self(lanes.to_array())
    }

    #[inline(always)]
    pub(crate) fn load<R: Rays>(&self) -> R {
        R::load(&self.0)
    }
}

#[inline(always)]
fn abs<R: Rays>(x: R) -> R {
    x.max(R::splat(0.0).sub(x))
}

/// As [`Prepared::new`] bounds reciprocals.
#[inline(always)]
fn bounded<R: Rays>(reciprocal: R, far: R) -> R {
    let largest = R::splat(ray::LARGEST_RECIPROCAL);
    let (zero, steepest) = (R::splat(0.0), largest.div(far));
    let bound = R::where_le(zero, reciprocal, steepest, zero.sub(steepest));
    R::where_le(abs(reciprocal).mul(far), largest, reciprocal, bound)
}

/// As [`slab::padded`].
#[inline(always)]
fn padded<R: Rays>(origin: R, reciprocal: R) -> [R; 2] {
    let at = origin.mul(reciprocal);
    let pad = abs(at).mul(R::splat(slab::PAD)).add(R::splat(f32::MIN_POSITIVE));
    [at.add(pad), at.sub(pad)]
}

/// Up to sixteen rays as structure of arrays, each as [`Prepared`] has it, bit for bit.
pub(crate) struct Bundle {
    pub(crate) origin: [Numbers; 3],
    pub(crate) reciprocal: [Numbers; 3],
    pub(crate) enter: [Numbers; 3],
    pub(crate) leave: [Numbers; 3],
    pub(crate) shear: [Numbers; 3],
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
        let mut some = [NOTHING; LANES];
        let [ox, oy, oz, t_max, dx, dy, dz, _] = R::transposed(rays.first_chunk().unwrap_or_else(|| {
            some[..rays.len()].copy_from_slice(rays);
            &some
        }));
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        // So that there is no −0, which looks the other way.
        let (dx, dy, dz) = (dx.add(zero), dy.add(zero), dz.add(zero));
        // 0, or not a number where one of them is not finite.
        let lost = ox.sub(ox).add(oy.sub(oy)).add(oz.sub(oz)).add(dx.sub(dx)).add(dy.sub(dy)).add(dz.sub(dz));
        let (ax, ay, az) = (abs(dx), abs(dy), abs(dz));
        let able = zero.lt(t_max) & lost.le(zero) & zero.lt(ax.max(ay).max(az));
        let far = abs(ox).max(abs(oy)).max(abs(oz)).max(one);
        let (rx, ry, rz) = (one.div(dx), one.div(dy), one.div(dz));
        let (mut across_x, mut across_y, mut across_z) = (rx, ry, rz);
        if abs(rx).max(abs(ry)).max(abs(rz)).mul(far).le(R::splat(ray::LARGEST_RECIPROCAL))
            != u32::from(u16::MAX)
        {
            (across_x, across_y, across_z) = (bounded(rx, far), bounded(ry, far), bounded(rz, far));
        }
        let [enter_x, leave_x] = padded(ox, across_x);
        let [enter_y, leave_y] = padded(oy, across_y);
        let [enter_z, leave_z] = padded(oz, across_z);
        // As [`Axis::last`] has it.
        let (beside, last) = (ay.max(az), az);
        let x = R::where_le(beside, ax, dy, R::where_le(last, ay, dz, dx));
        let y = R::where_le(beside, ax, dz, R::where_le(last, ay, dx, dy));
        let z = R::where_le(beside, ax, dx, R::where_le(last, ay, dy, dz));
        let along_x = beside.le(ax);
        Self {
            origin: [Numbers::of(ox), Numbers::of(oy), Numbers::of(oz)],
            reciprocal: [Numbers::of(across_x), Numbers::of(across_y), Numbers::of(across_z)],
            enter: [Numbers::of(enter_x), Numbers::of(enter_y), Numbers::of(enter_z)],
            leave: [Numbers::of(leave_x), Numbers::of(leave_y), Numbers::of(leave_z)],
            shear: [Numbers::of(x.div(z)), Numbers::of(y.div(z)), Numbers::of(one.div(z))],
            t_max: Numbers::of(t_max),
            able: able & ((1_u64 << rays.len()) - 1) as u32,
            down: [dx.signs(), dy.signs(), dz.signs()],
            longest: [along_x, last.le(ay) & !along_x],
        }
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

    /// In which order the ray meets planes, and its axes with the longest one last.
    #[inline(always)]
    pub(crate) fn turn(&self, lane: usize) -> (Order, [Axis; 3]) {
        let is = |lanes: u32| lanes >> lane & 1 != 0;
        let longest = if is(self.longest[0]) {
            Axis::X
        } else if is(self.longest[1]) {
            Axis::Y
        } else {
            Axis::Z
        };
        (Order { down: self.down.map(is) }, longest.last())
    }

    /// The ray of a lane that is able.
    #[inline(always)]
    pub(crate) fn ray(&self, lane: usize) -> Prepared {
        let (order, axes) = self.turn(lane);
        Lane { bundle: self, lane, order, axes }.prepared()
    }

    /// The packet of the rays of `group`.
    #[inline(always)]
    pub(crate) fn packet<R: Rays>(&self, group: u32) -> Packet<'_> {
        let first = group.trailing_zeros() as usize % LANES;
        let (order, axes) = self.turn(first);
        let limit: R = R::select(group, self.t_max.load(), R::splat(-1.0));
        let mut packet = Packet {
            bundle: self,
            limit: Numbers::of(limit),
            enter: [[0.0; 2]; 3],
            leave: [[0.0; 2]; 3],
            axes,
            order,
            largest_limit: limit.largest(),
            changes: 0,
        };
        // Interleaved rays are parallel on flat surfaces.
        let mut alike = u32::from(u16::MAX);
        for axis in 0..3 {
            let (reciprocal, all) =
                (self.reciprocal[axis].load::<R>(), R::splat(self.reciprocal[axis].0[first]));
            alike &= reciprocal.le(all) & all.le(reciprocal);
        }
        let are_parallel = group & !alike == 0;
        for axis in 0..3 {
            let (origin, reciprocal) = (&self.origin[axis], &self.reciprocal[axis]);
            // Lanes of other groups are as the first one.
            let one = reciprocal.0[first];
            let origin: R = R::select(group, origin.load(), R::splat(origin.0[first]));
            let origins = [origin.smallest(), origin.largest()];
            let reciprocals = if are_parallel {
                [one; 2]
            } else {
                let reciprocal = R::select(group, reciprocal.load(), R::splat(one));
                [reciprocal.smallest(), reciprocal.largest()]
            };
            let ([early, late], [small, large]) = match order.down[axis] {
                false => (origins, reciprocals),
                true => ([origins[1], origins[0]], [reciprocals[1], reciprocals[0]]),
            };
            packet.enter[axis] = [small, slab::padded(late, small).0];
            packet.leave[axis] = [large, slab::padded(early, large).1];
        }
        packet
    }
}

/// Rays that agree in the order of planes and in the longest axis.
pub(crate) struct Packet<'a> {
    pub(crate) bundle: &'a Bundle,
    /// t of the best hits so far, or ends of the rays; negative for rays that are absent.
    pub(crate) limit: Numbers,
    /// For each axis the factor and the number to subtract with which a near plane is no farther than for any ray.
    pub(crate) enter: [[f32; 2]; 3],
    /// For each axis the factor and the number to subtract with which a far plane is no nearer than for any ray.
    pub(crate) leave: [[f32; 2]; 3],
    /// As in [`Prepared`].
    pub(crate) axes: [Axis; 3],
    pub(crate) order: Order,
    /// Largest of the limits at the start.
    pub(crate) largest_limit: f32,
    /// How often limits have changed, modulo 2¹⁶; if two moments are taken for one, boxes are visited that need not be.
    pub(crate) changes: u16,
}

impl Packet<'_> {
    /// The `lanes` have hits at `t`.
    #[inline(always)]
    pub(crate) fn shorten<R: Rays>(&mut self, lanes: u32, t: R) {
        t.put(lanes, &mut self.limit.0);
        self.changes = self.changes.wrapping_add(1);
    }

    /// The best hit of one ray is at `t`, or it has none still and ends there.
    #[inline(always)]
    pub(crate) fn shorten_one(&mut self, lane: usize, t: f32) {
        let limit = &mut self.limit.0[lane % LANES];
        self.changes = self.changes.wrapping_add(u16::from(t < *limit));
        *limit = t;
    }

    #[inline(always)]
    pub(crate) fn ray(&self, lane: usize) -> Lane<'_> {
        Lane { bundle: self.bundle, lane: lane % LANES, order: self.order, axes: self.axes }
    }
}

/// One ray of a bundle.
pub(crate) struct Lane<'a> {
    bundle: &'a Bundle,
    lane: usize,
    order: Order,
    axes: [Axis; 3],
}

impl Lane<'_> {
    /// On its own.
    #[inline(always)]
    pub(crate) fn prepared(&self) -> Prepared {
        let mut slab = [Slab::NONE; 3];
        for (axis, slab) in slab.iter_mut().enumerate() {
            slab.reciprocal = self.reciprocal(axis);
            slab.enter = self.bundle.enter[axis].0[self.lane % LANES];
            slab.leave = self.bundle.leave[axis].0[self.lane % LANES];
        }
        Prepared {
            origin: [self.origin(0), self.origin(1), self.origin(2)],
            slab,
            axes: self.axes,
            shear: [self.shear(0), self.shear(1), self.shear(2)],
            order: self.order,
        }
    }
}

impl OneRay for Lane<'_> {
    #[inline(always)]
    fn origin(&self, axis: usize) -> f32 {
        self.bundle.origin[axis].0[self.lane % LANES]
    }
    #[inline(always)]
    fn reciprocal(&self, axis: usize) -> f32 {
        self.bundle.reciprocal[axis].0[self.lane % LANES]
    }
    #[inline(always)]
    fn shear(&self, axis: usize) -> f32 {
        self.bundle.shear[axis].0[self.lane % LANES]
    }
    #[inline(always)]
    fn axes(&self) -> [Axis; 3] {
        self.axes
    }
    #[inline(always)]
    fn order(&self) -> Order {
        self.order
    }
}
