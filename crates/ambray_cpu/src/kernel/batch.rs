//! The rays of a batch: which go together, and which alone.

use std::mem::MaybeUninit;

use ambray_core::trace::{Hit, Ray};

use super::bundle::{Bundle, LANES};
use super::lanes::{Lanes, Rays};
use super::loose::Loose;
use super::{Query, Scene, cut, packet, single, triangle};

/// Rays of a group that is worth a packet of its own; those of others look for company in the whole batch.
const TOGETHER: u32 = 8;

/// Numbers of lanes. A constant, because closures that fill arrays are not inlined into the kernels.
const COUNTED: [u32; LANES] = {
    let mut counted = [0; LANES];
    let mut lane = 0;
    while lane < LANES {
        counted[lane] = lane as u32;
        lane += 1;
    }
    counted
};

/// Answers `rays`.
#[inline(always)]
pub(super) fn answer<const W: usize, L: Lanes<W>, R: Rays, Q: Query>(
    scene: &Scene<'_, W>,
    rays: &[Ray],
    answers: &mut [Q::Answer],
) {
    answers.fill(Q::answer(false, || Hit::MISS));
    let cut = scene.baked.nodes.first().map(|_| cut::root::<W, R>(&scene.baked.nodes, rays));
    let scene = &Scene { entry: cut.as_ref(), ..*scene };
    let mut single = vec![MaybeUninit::uninit(); scene.stack];
    if !scene.packets {
        for (rays, answers) in rays.chunks(LANES).zip(answers.chunks_mut(LANES)) {
            let bundle = Bundle::of::<R>(rays);
            for (lane, (ray, answer)) in rays.iter().zip(answers).enumerate() {
                let mut hit = Hit::MISS;
                if bundle.able >> lane & 1 != 0 {
                    hit = single::trace::<W, L, Q>(scene, ray, &bundle.ray(lane), &mut single);
                }
                if hit.is_hit() {
                    *answer = Q::answer(true, || triangle::named(&scene.baked.names, hit));
                }
            }
        }
        return;
    }
    let mut scratch = packet::Scratch { packet: vec![MaybeUninit::uninit(); scene.stack], single };
    let mut loose = Loose::default();
    in_order::<W, L, R, Q>(scene, rays, answers, &mut scratch, &mut loose);
    by_direction::<W, L, R, Q>(scene, rays, answers, &mut scratch, &mut loose);
}

/// Answers the rays that agree with their neighbours in the batch; the others become loose.
#[inline(always)]
fn in_order<'a, const W: usize, L: Lanes<W>, R: Rays, Q: Query>(
    scene: &Scene<'a, W>,
    rays: &[Ray],
    answers: &mut [Q::Answer],
    scratch: &mut packet::Scratch<'a, W>,
    loose: &mut Loose,
) {
    let mut first = 0;
    while first < rays.len() {
        let (bundle, count) = Bundle::next::<R>(&rays[first..]);
        let rays = &rays[first..][..count];
        let mut places = COUNTED;
        for place in &mut places {
            *place += first as u32;
        }
        let mut waiting = bundle.able;
        while waiting != 0 {
            let group = bundle.group(waiting);
            waiting &= !group;
            if group.count_ones() >= TOGETHER {
                packet::trace::<W, L, R, Q>(scene, &bundle, group, rays, (answers, &places), scratch);
                continue;
            }
            loose.push(first, &bundle, group);
        }
        first += count;
    }
}

/// Answers the loose rays, those of like directions together.
#[inline(always)]
fn by_direction<'a, const W: usize, L: Lanes<W>, R: Rays, Q: Query>(
    scene: &Scene<'a, W>,
    rays: &[Ray],
    answers: &mut [Q::Answer],
    scratch: &mut packet::Scratch<'a, W>,
    loose: &mut Loose,
) {
    let mut order = loose.sort();
    while let Some(together) = Loose::take::<LANES>(&mut order) {
        let mut some = [rays[together[0].index as usize]; LANES];
        let mut places = [0; LANES];
        for ((ray, place), loose) in some.iter_mut().zip(&mut places).zip(together) {
            *ray = rays[loose.index as usize];
            *place = loose.index;
        }
        let some = &some[..together.len()];
        let bundle = Bundle::of::<R>(some);
        let mut waiting = bundle.able;
        while waiting != 0 {
            let group = bundle.group(waiting);
            waiting &= !group;
            packet::trace::<W, L, R, Q>(scene, &bundle, group, some, (answers, &places), scratch);
        }
    }
}
