//! The preparation of rays, and culling against the test that decides.

use ambray_core::sampling::{pcg, unit_float};
use ambray_core::trace::Ray;
use glam::Vec3;

use super::array::Array;
use super::bundle::{Bundle, LANES};
use super::lanes::{Lanes, Rays};
use super::packet::{meets, overlaps};
use super::ray::Prepared;
use super::slab;
use crate::bvh::layout::{Child, Node};

/// In [-1, 1].
fn number(seed: u32) -> f32 {
    2.0 * unit_float(pcg(seed)) - 1.0
}

fn vector(seed: u32) -> Vec3 {
    Vec3::new(number(seed), number(seed ^ 0x5555_5555), number(seed ^ 0x3333_3333))
}

/// Rays of all sizes: near each other or not, along axes, in planes, steep, starting in the centre or far away.
fn rays(seed: u32) -> [Ray; LANES] {
    let scale = 10_f32.powi((seed % 13) as i32 - 4);
    let (centre, heading) =
        (vector(pcg(seed)) * scale * [0.0, 1.0, 1000.0][seed as usize % 3], vector(pcg(seed + 1)));
    std::array::from_fn(|lane| {
        let seed = pcg(pcg(seed).wrapping_add(lane as u32));
        let spread = [0.0, 1e-3, 0.1, 10.0][(seed >> 3) as usize % 4];
        let mut direction = heading + spread * vector(seed);
        for axis in 0..3 {
            match (seed >> (8 + 4 * axis)) % 16 {
                0 => direction[axis] = 0.0,
                1 => direction[axis] = -0.0,
                2 => direction[axis] *= 1e-35,
                _ => {}
            }
        }
        let direction = direction.try_normalize().unwrap_or(Vec3::NEG_Y);
        Ray { origin: centre + 0.1 * scale * vector(seed + 7), t_max: f32::INFINITY, direction, seed }
    })
}

/// Boxes about where the rays go, some of them flat, some with planes through origins.
fn boxes(seed: u32, rays: &[Ray; LANES]) -> Node<16> {
    let mut node = Node::EMPTY;
    for slot in 0..15 {
        let seed = pcg(seed.wrapping_mul(31).wrapping_add(slot as u32));
        let ray = &rays[seed as usize % LANES];
        let reach = 10_f32.powi((seed >> 8) as i32 % 9 - 5);
        let a = ray.origin + ray.direction * reach;
        let mut b = a + reach * 0.3 * vector(seed);
        for axis in 0..3 {
            match (seed >> (12 + 3 * axis)) % 8 {
                0 => b[axis] = a[axis],
                1 => b[axis] = ray.origin[axis],
                _ => {}
            }
        }
        let (lo, hi) = (a.min(b), a.max(b));
        for axis in 0..3 {
            node.planes[axis][slot] = lo[axis];
            node.planes[axis + 3][slot] = hi[axis];
        }
        node.children[slot] = Child::node(1);
    }
    node
}

/// Every lane of a bundle is the ray on its own, bit for bit.
fn bundles_hold_prepared_rays<R: Rays>(rays: &[Ray; LANES]) {
    let bundle = Bundle::of::<R>(rays);
    for (lane, ray) in rays.iter().enumerate() {
        let alone = Prepared::new(ray.origin, ray.direction).expect("the ray is finite");
        assert_eq!(format!("{:?}", bundle.ray(lane)), format!("{alone:?}"), "{ray:?}");
    }
}

/// Boxes that the exact test keeps, with the limit just where they are met, are kept by all others. Returns how many.
fn culling_is_weaker<L: Lanes<16>, R: Rays>(rays: &[Ray; LANES], node: &Node<16>) -> usize {
    let mut kept = 0;
    for slot in 0..16 {
        let planes = node.planes.map(|plane| plane[slot]);
        let exact =
            |ray: &Ray| slab::one(&planes, &Prepared::new(ray.origin, ray.direction).expect("finite"));
        let limited = rays.map(|ray| Ray { t_max: exact(&ray).unwrap_or(0.0).max(f32::MIN_POSITIVE), ..ray });
        for ray in &limited {
            let prepared = Prepared::new(ray.origin, ray.direction).expect("finite");
            let (mask, near) = slab::children::<16, L>(node, &prepared, ray.t_max);
            if let Some(exact) = exact(ray) {
                assert!(slot < 15, "the last box is empty");
                assert!(
                    mask >> slot & 1 != 0 && near.to_array()[slot] <= exact * slab::SLACK,
                    "{ray:?}, {planes:?}"
                );
                kept += 1;
            }
        }
        let bundle = Bundle::of::<R>(&limited);
        let mut waiting = bundle.able;
        while waiting != 0 {
            let group = bundle.group(waiting);
            waiting &= !group;
            let packet = bundle.packet::<R>(group);
            let some = overlaps::<16, L>(&node.planes, &packet).0 >> slot & 1 != 0;
            let met = meets::<16, R>(&node.planes, slot, &packet);
            for lane in (0..LANES).filter(|lane| group >> lane & 1 != 0) {
                assert!(
                    exact(&rays[lane]).is_none() || some && met >> lane & 1 != 0,
                    "{:?}, {planes:?}",
                    rays[lane]
                );
            }
        }
    }
    kept
}

fn all_of<L: Lanes<16>, R: Rays>() {
    let mut kept = 0;
    for seed in 0..3_000 {
        let rays = rays(seed);
        bundles_hold_prepared_rays::<R>(&rays);
        kept += culling_is_weaker::<L, R>(&rays, &boxes(seed, &rays));
    }
    assert!(kept > 30_000, "{kept} boxes are met");
}

#[test]
fn what_decides_is_never_culled() {
    all_of::<Array<16>, Array<16>>();
    #[cfg(target_arch = "x86_64")]
    {
        use super::{sse2::Sse2x16, x86};
        all_of::<Sse2x16, Sse2x16>();
        if crate::Isa::Avx2.is_available() {
            all_of::<x86::Avx2x16, x86::Avx2x16>();
        }
        if crate::Isa::Avx512.is_available() {
            all_of::<x86::Avx512x16, x86::Avx512x16>();
        }
    }
}
