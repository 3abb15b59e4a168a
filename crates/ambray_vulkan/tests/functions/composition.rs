//! Composition of pictures, and the factor of the self-similar bounce.

use ambray_core::{
    compose::{compose, near_radiance, self_similar_factor, smaller_batch},
    settings::{RadianceSource, Settings},
};
use ambray_scene::Scene;
use ambray_vulkan::layout::{FUNCTION_COMPOSE, FUNCTION_FINISH};
use glam::{Vec3, Vec4, Vec4Swizzles};

use crate::{
    calls::{Call, Device, view},
    compare::Comparison,
    random::Random,
};

/// Openness with a near radiance that goes with it.
fn gathered(random: &mut Random) -> Vec4 {
    let openness = match random.below(8) {
        0 => 0.0,
        1 => 1.0,
        2 => random.magnitude(-12.0, -3.0),
        _ => random.between(0.0, 1.0),
    };
    let albedo = if random.below(4) == 0 { Vec3::ONE } else { random.vector(0.0, 1.0) };
    (albedo * (1.0 - openness)).extend(openness).wxyz()
}

/// One division of numbers up to 1, of which the divisor cancels: units of the last place of the divisor count.
#[test]
fn finished_batches() {
    let Some(device) = Device::open(Scene::default()) else { return };
    let mut random = Random::new(11);
    for &source in RadianceSource::ALL {
        let arguments: Vec<_> = (0..5000)
            .map(|_| (gathered(&mut random), gathered(&mut random), random.vector(0.0, 3.0)))
            .collect();
        let calls: Vec<_> = (arguments.iter())
            .map(|&(a, b, ambient)| Call::default().vector4(a).vector4(b).vector(ambient))
            .collect();
        let settings = Settings { radiance_source: source, ..Settings::default() };
        let (mut factors, mut finished) = (Comparison::new("factors"), Comparison::new("finished batches"));
        let all = device.functions(&settings).call(FUNCTION_FINISH, &view(), &calls);
        for (&(a, b, ambient), values) in arguments.iter().zip(all) {
            let what = || format!("{source:?} {a} {b} {ambient}");
            let both = smaller_batch(a, b);
            assert_eq!(values.number(0), both.x, "{}", what());
            let near = near_radiance(source, ambient, both.x, both.yzw());
            finished.add_vector(near, values.vector4(0).yzw(), ambient.max_element(), what);
            factors.add_vector(self_similar_factor(a.x, a.yzw()), values.vector(4), 1.0, what);
        }
        factors.finish(4.0);
        finished.finish(4.0);
    }
}

/// Sums of products of positive numbers: two units for each of the three terms.
#[test]
fn composed_pixels() {
    let Some(device) = Device::open(Scene::default()) else { return };
    let functions = device.functions(&Settings::default());
    let mut random = Random::new(12);
    let arguments: Vec<_> = (0..10_000)
        .map(|_| {
            let strength = random.magnitude(-3.0, 3.0);
            let emission = if random.below(2) == 0 { Vec3::ZERO } else { random.vector(0.0, strength) };
            let gathered = gathered(&mut random);
            [emission, random.vector(0.0, 1.0), random.vector(0.0, strength), random.vector(0.0, strength)]
                .map(|v| (v, gathered))
        })
        .collect();
    let calls: Vec<_> = (arguments.iter())
        .map(|[(emission, gathered), (albedo, _), (ambient, _), (direct, _)]| {
            Call::default()
                .vector(*emission)
                .vector(*albedo)
                .vector(*ambient)
                .vector4(*gathered)
                .vector(*direct)
        })
        .collect();
    let mut pixels = Comparison::new("composed pixels");
    for ([(emission, gathered), (albedo, _), (ambient, _), (direct, _)], values) in
        arguments.iter().zip(functions.call(FUNCTION_COMPOSE, &view(), &calls))
    {
        let expected = compose(*emission, *albedo, *ambient, gathered.x, gathered.yzw(), *direct);
        pixels.add_vector(expected, values.vector(0), expected.max_element(), || {
            format!("{emission} {albedo} {ambient} {gathered} {direct}")
        });
    }
    pixels.finish(6.0);
}
