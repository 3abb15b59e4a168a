//! Texture lookups and checkers.

use ambray_core::settings::Settings;
use ambray_scene::{Checker, Filter, Image, Sampler, Scene, Texture, Wrap};
use ambray_vulkan::layout::{FUNCTION_CHECKER, FUNCTION_TEXTURE};
use glam::{Vec2, Vec3};

use crate::{
    calls::{Call, Device, view},
    compare::Comparison,
    random::Random,
};

/// Images of odd and even sizes, square and not, in both encodings; with each way to read them.
fn scene(random: &mut Random) -> Scene {
    let mut scene = Scene::default();
    for (width, height) in [(1, 1), (16, 16), (3, 5), (64, 7), (2, 256)] {
        for srgb in [false, true] {
            let texels = (0..width * height).map(|_| random.word().to_le_bytes()).collect();
            scene.images.push(Image::new(String::new(), width, height, texels, srgb).into());
        }
    }
    let wraps = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];
    let filters = [Filter::Nearest, Filter::Linear];
    for image in 0..scene.images.len() as u32 {
        for wrap in wraps.map(|u| wraps.map(|v| [u, v])).into_iter().flatten() {
            for (mag, min) in filters.map(|mag| filters.map(|min| (mag, min))).into_iter().flatten() {
                for mip in [None, Some(Filter::Nearest), Some(Filter::Linear)] {
                    scene.textures.push(Texture { image, sampler: Sampler { wrap, mag, min, mip } });
                }
            }
        }
    }
    scene
}

fn coordinate(random: &mut Random, size: u32) -> f32 {
    match random.below(16) {
        0 => f32::NAN,
        1 => random.signed(-40.0, 38.0),
        2 => random.signed(2.0, 7.0),
        // Borders and centres of texels.
        3..=6 => random.below(8 * size as usize) as f32 / (2 * size) as f32 - 2.0,
        _ => random.between(-2.5, 2.5),
    }
}

/// Whether the last place of the logarithm decides which texels are read.
fn is_between_levels(sampler: &Sampler, texels_wide: f32) -> bool {
    let level = f64::from(texels_wide).log2();
    let border = match sampler.mip {
        Some(Filter::Nearest) if level > 0.25 => level + 0.5,
        _ => level,
    };
    let is_border = border.round() == 0.0 || sampler.mip == Some(Filter::Nearest);
    is_border && (border - border.round()).abs() < 1e-5
}

/// Weighted means of numbers up to 1. What decides about texels is equal in all bits; the weights of levels come from a
/// logarithm, which Vulkan lets be off by 3 units of the last place or 2⁻²¹, and weigh texels that differ by up to 1.
#[test]
fn all_samplers() {
    let mut random = Random::new(13);
    let scene = scene(&mut random);
    let Some(device) = Device::open(scene.clone()) else { return };
    let functions = device.functions(&Settings::default());
    let mut arguments = Vec::new();
    for (number, texture) in scene.textures.iter().enumerate() {
        let full = &scene.images[texture.image as usize].levels[0];
        let texel = 1.0 / (full.width as f32 * full.height as f32).sqrt();
        for _ in 0..40 {
            let uv = Vec2::new(coordinate(&mut random, full.width), coordinate(&mut random, full.height));
            let width = match random.below(12) {
                0 => 0.0,
                1 => f32::NAN,
                2 => f32::INFINITY,
                3 => -1.0,
                4 => random.magnitude(-38.0, 38.0),
                _ => texel * 2_f32.powf(random.between(-1.0, 9.0)),
            };
            if !is_between_levels(&texture.sampler, width / texel) {
                arguments.push((number, uv, width));
            }
        }
    }
    let calls: Vec<_> = (arguments.iter())
        .map(|&(number, uv, width)| {
            Call::default().word(number as u32).number(uv.x).number(uv.y).number(width)
        })
        .collect();
    let (mut colors, mut alphas) = (Comparison::new("texture colours"), Comparison::new("texture alphas"));
    let mut unfiltered = Comparison::new("nearest texels");
    for (&(number, uv, width), values) in
        arguments.iter().zip(functions.call(FUNCTION_TEXTURE, &view(), &calls))
    {
        let Texture { image, sampler } = scene.textures[number];
        let image = &scene.images[image as usize];
        let what = || {
            format!("{uv} {width:e} of {} × {} by {sampler:?}", image.levels[0].width, image.levels[0].height)
        };
        let expected = sampler.sample(image, uv, width);
        let is_nearest = sampler.mag == Filter::Nearest
            && sampler.min == Filter::Nearest
            && sampler.mip != Some(Filter::Linear);
        let comparison = if is_nearest { &mut unfiltered } else { &mut colors };
        comparison.add_vector(expected.truncate(), values.vector(0), 1.0, what);
        comparison.add(expected.w, values.number(3), 1.0, what);
        alphas.add(sampler.alpha_at(image, uv), values.number(4), 1.0, what);
    }
    // Bytes are divided by 255.
    unfiltered.finish(if device.is_exact() { 0.0 } else { 2.5 });
    alphas.finish(6.0);
    colors.finish(16.0);
}

/// Positions at random, and on the faces between cubes, which the bias decides.
#[test]
fn checkers() {
    let Some(device) = Device::open(Scene::default()) else { return };
    let functions = device.functions(&Settings::default());
    let mut random = Random::new(14);
    let arguments: Vec<_> = (0..20_000)
        .map(|i| {
            let size = random.magnitude(-3.0, 3.0);
            let mut cube = random.vector(-1000.0, 1000.0);
            if i % 2 == 0 {
                cube = cube.round();
            }
            (size, cube * size)
        })
        .collect();
    let calls: Vec<_> = arguments.iter().map(|&(size, p)| Call::default().number(size).vector(p)).collect();
    let mut other = 0;
    for (&(size, p), values) in arguments.iter().zip(functions.call(FUNCTION_CHECKER, &view(), &calls)) {
        let checker = Checker { color: Vec3::Y, size };
        let expected = checker.at(Vec3::X, p);
        let value = values.vector(0);
        assert!(value == Vec3::X || value == Vec3::Y);
        other += u32::from(value != expected);
        // Where a division that is off by 2.5 units of the last place does not matter.
        let within = ((p / size + Checker::BIAS).fract() - 0.5).abs().max_element();
        let is_inside = within < 0.5 - 1e-3;
        assert!(
            value == expected || !(device.is_exact() || is_inside),
            "{value} for {expected} at {p} by {size}"
        );
    }
    println!("checkers: {other} of {} differ", arguments.len());
}
