//! Painted textures: each is a function of (u, v) in `[0, 1)²`, v downwards, that repeats in both directions.

use glam::{Vec3, Vec4};

use crate::Image;
use crate::modelling::noise::{cloud, noise, smoothstep};

/// Limestone: pale, clouded, with pores. To be tinted.
pub(super) fn stone() -> Image {
    paint("stone", [256, 256], true, |u, v| {
        let clouds = cloud(u, v, [3, 3], 5, 11);
        let warm = noise(u, v, [2, 2], 17);
        let pores = smoothstep(0.72, 0.95, cloud(u, v, [64, 56], 2, 13));
        let tone = 0.74 + 0.34 * clouds - 0.08 * pores;
        (Vec3::new(1.0, 0.985, 0.955 + 0.035 * warm) * tone).extend(1.0)
    })
}

/// Plaster: large soft patches and fine grain. To be tinted.
pub(super) fn plaster() -> Image {
    paint("plaster", [512, 512], true, |u, v| {
        let patches = cloud(u, v, [4, 3], 4, 23);
        let grain = cloud(u, v, [128, 128], 2, 29);
        let stains = smoothstep(0.55, 0.80, cloud(u, v, [5, 2], 3, 31));
        let tone = 0.84 + 0.20 * (patches - 0.5) + 0.08 * (grain - 0.5) - 0.05 * stains + 0.06;
        Vec3::splat(tone).extend(1.0)
    })
}

/// Relief of the plaster: tangent-space normals of a gently uneven coat.
pub(super) fn plaster_relief() -> Image {
    const STEP: f32 = 1.0 / 256.0;
    let height = |u: f32, v: f32| cloud(u, v, [10, 9], 4, 37);
    paint("plaster relief", [256, 256], false, |u, v| {
        let slope_x = height(u + STEP, v) - height(u - STEP, v);
        let slope_y = height(u, v - STEP) - height(u, v + STEP);
        let normal = Vec3::new(-2.2 * slope_x, -2.2 * slope_y, 1.0).normalize();
        (normal * 0.5 + 0.5).extend(1.0)
    })
}

/// Pale marble for floors: clouds and thin veins. To be tinted.
pub(super) fn marble() -> Image {
    paint("marble", [512, 512], true, |u, v| {
        let clouds = cloud(u, v, [4, 4], 4, 41);
        // Veins run aslant, bent by a cloud, and come and go.
        let vein = |bend: f32, seed: u32| {
            let t = 2.0 * u + 3.0 * v + bend * cloud(u, v, [3, 3], 4, seed);
            let near = (t - libm::floorf(t) - 0.5).abs();
            (1.0 - smoothstep(0.0, 0.03, near)) * smoothstep(0.45, 0.75, noise(u, v, [6, 5], seed + 9))
        };
        let vein = vein(3.0, 43) + 0.6 * vein(-4.5, 45);
        let warm = noise(u, v, [7, 7], 47);
        let tone = 0.85 + 0.15 * clouds - 0.07 * vein;
        (Vec3::new(1.0, 0.975 + 0.02 * warm, 0.93 + 0.05 * warm) * tone).extend(1.0)
    })
}

/// Planks of wood, four to the repeat, their grain along u. To be tinted.
pub(super) fn wood() -> Image {
    paint("wood", [256, 256], true, |u, v| {
        let plank = libm::floorf(v * 4.0);
        let across = v * 4.0 - plank;
        let bend = noise(u, v, [3, 4], 53);
        let rings = cloud(u, v + 0.02 * bend, [2, 56], 3, 59);
        let joint = smoothstep(0.0, 0.05, across) * smoothstep(0.0, 0.05, 1.0 - across);
        let shade = 0.9 + 0.1 * noise(0.1, plank / 4.0 + 0.1, [1, 4], 61);
        (Vec3::new(1.0, 0.96, 0.90) * ((0.62 + 0.38 * rings) * shade * (0.35 + 0.65 * joint))).extend(1.0)
    })
}

/// Plain cloth: threads over and under. To be tinted.
pub(super) fn weave() -> Image {
    paint("weave", [256, 256], true, |u, v| Vec3::splat(threads(u, v)).extend(1.0))
}

/// Cloth with ochre and indigo stripes along v.
pub(super) fn stripes() -> Image {
    let (ochre, indigo, cream) =
        (Vec3::new(0.86, 0.62, 0.20), Vec3::new(0.16, 0.20, 0.47), Vec3::new(0.93, 0.87, 0.74));
    paint("stripes", [256, 64], true, |u, v| {
        let colour = match (u * 32.0) as u32 {
            0..9 | 24.. => ochre,
            9 | 11 | 20 | 22 => cream,
            10 | 21 | 14..18 => indigo,
            12..14 | 18..20 => cream,
            _ => indigo,
        };
        (colour * threads(u, v * 0.25)).extend(1.0)
    })
}

/// Banner: golden sun and borders on crimson; covers the whole sheet once.
pub(super) fn banner() -> Image {
    let (crimson, gold) = (Vec3::new(0.66, 0.08, 0.10), Vec3::new(0.93, 0.72, 0.27));
    paint("banner", [128, 512], true, |u, v| {
        let (x, y) = (u - 0.5, (v - 0.34) * 3.2);
        let radius = libm::sqrtf(x * x + y * y);
        let rays = libm::cosf(libm::atan2f(y, x) * 12.0);
        let sun = radius < 0.17 || (radius > 0.20 && radius < 0.29 + 0.05 * rays && rays > 0.0);
        let border = !(0.09..0.91).contains(&u) && (0.05..0.95).contains(&u);
        let bands =
            [0.03..0.04, 0.62..0.63, 0.66..0.69, 0.72..0.73, 0.90..0.93].iter().any(|b| b.contains(&v));
        let zigzag = 0.80 + 0.03 * (2.0 * (u * 6.0 - libm::floorf(u * 6.0)) - 1.0).abs();
        let chevron = (v - zigzag).abs() < 0.012;
        let colour = if sun || border || bands || chevron { gold } else { crimson };
        (colour * (0.9 + 0.1 * threads(u, v * 4.0))).extend(1.0)
    })
}

/// One leaf on a card, its stalk at the bottom: alpha is its outline.
pub(super) fn leaf() -> Image {
    let (dark, light) = (Vec3::new(0.20, 0.36, 0.11), Vec3::new(0.44, 0.58, 0.22));
    paint("leaf", [128, 128], true, |u, v| {
        let along = 1.0 - v; // 0 at the stalk, 1 at the tip
        let across = (u - 0.5).abs();
        let blade = ((along - 0.10) / 0.88).clamp(0.0, 1.0);
        let half_width = 0.44 * libm::sqrtf(blade) * (1.0 - blade) * 2.3;
        let stalk = along < 0.16 && across < 0.022;
        let veins = blade * 9.0 - across * 7.0;
        let vein = smoothstep(0.80, 1.0, 1.0 - (veins - libm::floorf(veins)));
        let rib = 1.0 - smoothstep(0.010, 0.030, across);
        let tone = 0.30 * noise(u, v, [6, 6], 71) + 0.25 * along + 0.35 * rib.max(0.6 * vein);
        let alpha = smoothstep(-0.012, 0.012, half_width - across).max(f32::from(u8::from(stalk)));
        dark.lerp(light, tone).extend(alpha)
    })
}

/// Brightness of woven threads, 64 to the repeat.
fn threads(u: f32, v: f32) -> f32 {
    let wave = |x: f32| {
        let t = x - libm::floorf(x);
        4.0 * t * (1.0 - t)
    };
    let (x, y) = (u * 64.0, v * 64.0);
    let over = ((libm::floorf(x) + libm::floorf(y)) as i32) & 1 == 0;
    let round = if over { wave(x) } else { wave(y) };
    let slub = noise(u, v, [4, 64], 73) * 0.5 + noise(u, v, [64, 4], 79) * 0.5;
    0.76 + 0.12 * round + 0.16 * (slub - 0.5) + 0.04
}

/// Evaluates `texel` at all texel centres; the values are what is stored, encoded if `srgb`.
fn paint(name: &str, [width, height]: [u32; 2], srgb: bool, texel: impl Fn(f32, f32) -> Vec4) -> Image {
    let texels = (0..width * height).map(|i| {
        let (x, y) = (i % width, i / width);
        let value = texel((x as f32 + 0.5) / width as f32, (y as f32 + 0.5) / height as f32);
        value.to_array().map(|c| (255.0 * c.clamp(0.0, 1.0) + 0.5) as u8)
    });
    Image::new(name.to_owned(), width, height, texels.collect(), srgb)
}
