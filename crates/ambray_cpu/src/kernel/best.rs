//! The best hits so far of the rays of a packet.

use ambray_core::trace::Hit;

use super::bundle::{LANES, Numbers};
use super::lanes::Lanes;

/// As structure of arrays; distances are the [limits](super::bundle::Packet::limit) of the packet.
#[derive(Clone, Copy)]
pub(crate) struct Best {
    /// Lanes with a hit. Of others nothing else counts, and of no lane where any hit will do.
    pub(crate) found: u32,
    u: Numbers,
    v: Numbers,
    instance: [u32; LANES],
    triangle: [u32; LANES],
}

impl Best {
    pub(crate) const NONE: Self = Self {
        found: 0,
        u: Numbers::ZERO,
        v: Numbers::ZERO,
        instance: [Hit::NONE; LANES],
        triangle: [0; LANES],
    };

    /// By which equal distances are decided: the smaller wins.
    #[inline(always)]
    pub(crate) fn order(&self, lane: usize) -> (u32, u32) {
        (self.instance[lane], self.triangle[lane])
    }

    /// The hit of `lane` at distance `t`, which is kept for rays without a hit.
    #[inline(always)]
    pub(crate) fn hit(&self, lane: usize, t: f32) -> Hit {
        let lane = lane % LANES;
        let (u, v) = (self.u.0[lane], self.v.0[lane]);
        Hit { t, u, v, instance: self.instance[lane], triangle: self.triangle[lane] }
    }

    /// One triangle is the best of several lanes.
    #[inline(always)]
    pub(crate) fn set<R: Lanes<16>>(&mut self, lanes: u32, u: R, v: R, instance: u32, triangle: u32) {
        u.put(lanes, &mut self.u.0);
        v.put(lanes, &mut self.v.0);
        for lane in 0..LANES {
            let is_set = lanes >> lane & 1 != 0;
            self.instance[lane] = if is_set { instance } else { self.instance[lane] };
            self.triangle[lane] = if is_set { triangle } else { self.triangle[lane] };
        }
    }

    /// The best of one lane, which may be what it was.
    #[inline(always)]
    pub(crate) fn replace(&mut self, lane: usize, hit: &Hit) {
        let lane = lane % LANES;
        self.found |= u32::from(hit.is_hit()) << lane;
        self.u.0[lane] = hit.u;
        self.v.0[lane] = hit.v;
        self.instance[lane] = hit.instance;
        self.triangle[lane] = hit.triangle;
    }
}
