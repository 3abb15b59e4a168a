//! The fuzzy measure of distances.

use ambray_core::{
    openness::Openness,
    settings::{Falloff, Settings},
};
use ambray_scene::Scene;
use ambray_vulkan::layout::FUNCTION_OPENNESS;

use crate::{
    calls::{Call, Device, view},
    compare::Comparison,
    random::Random,
};

const CALLS: usize = 20_000;

fn measure(falloff: Falloff, random: &mut Random) -> Openness {
    let radius = random.magnitude(-5.0, 5.0);
    // Rates whose falloff is noticeable somewhere near the radius, and some that are not.
    let sigma = random.magnitude(-3.0, 2.0) / radius;
    match falloff {
        Falloff::Power => {
            let exponents = [1.0, 0.5, 2.0, random.magnitude(-2.0, 2.0)];
            Openness::Power { radius, exponent: exponents[random.below(exponents.len())] }
        }
        Falloff::Exponential => Openness::Exponential { sigma },
        Falloff::ExponentialTruncated => Openness::ExponentialTruncated { radius, sigma },
        Falloff::Step => Openness::Step { radius },
    }
}

fn call(measure: Openness, d: f32, x: f32) -> Call {
    let (radius, exponent, sigma) = match measure {
        Openness::Power { radius, exponent } => (radius, exponent, 0.0),
        Openness::Exponential { sigma } => (1.0, 1.0, sigma),
        Openness::ExponentialTruncated { radius, sigma } => (radius, 1.0, sigma),
        Openness::Step { radius } => (radius, 1.0, 0.0),
    };
    Call::default().number(d).number(radius).number(measure.reach()).number(exponent).number(sigma).number(x)
}

/// Distances from far below the radius to far beyond it, 0, and a miss.
fn distance(random: &mut Random, measure: &Openness) -> f32 {
    let size = match *measure {
        Openness::Exponential { sigma } => 1.0 / sigma,
        ref other => other.reach(),
    };
    match random.below(16) {
        0 => 0.0,
        1 => f32::INFINITY,
        2 => size,
        3 => size * (1.0 - f32::EPSILON),
        4 => size * random.magnitude(-20.0, -3.0),
        5 => size * random.magnitude(0.0, 3.0),
        _ => size * random.between(0.0, 1.1),
    }
}

#[test]
fn all_falloffs() {
    let Some(device) = Device::open(Scene::default()) else { return };
    let mut random = Random::new(5);
    for &falloff in Falloff::ALL {
        let arguments: Vec<_> = (0..CALLS)
            .map(|_| {
                let measure = measure(falloff, &mut random);
                (measure, distance(&mut random, &measure))
            })
            .collect();
        let calls: Vec<_> = arguments.iter().map(|&(measure, d)| call(measure, d, 0.0)).collect();
        let settings = Settings { falloff, ..Settings::default() };
        let mut values_of = Comparison::new(match falloff {
            Falloff::Power => "openness by a power",
            Falloff::Exponential => "exponential openness",
            Falloff::ExponentialTruncated => "truncated exponential openness",
            Falloff::Step => "openness by a step",
        });
        let all = device.functions(&settings).call(FUNCTION_OPENNESS, &view(), &calls);
        for (&(measure, d), values) in arguments.iter().zip(all) {
            let value = values.number(0);
            assert!((0.0..=1.0).contains(&value), "{value} for {measure:?} at {d}");
            values_of.add(measure.at(d), value, 1.0, || format!("{measure:?} at {d:e}"));
        }
        values_of.finish(match falloff {
            Falloff::Step => 0.0,
            // Powers and exponentials of Vulkan are approximate: what is left after weighing by 1, the largest openness.
            Falloff::Power => 64.0,
            Falloff::Exponential | Falloff::ExponentialTruncated => 16.0,
        });
    }
}

/// Relative to the result, also where it nearly vanishes: beyond -1/4 the exponential of Vulkan may be off by 3 + 2 |x| units
/// of its last place.
#[test]
fn exponentials_without_cancellation() {
    let Some(device) = Device::open(Scene::default()) else { return };
    let functions = device.functions(&Settings::default());
    let mut random = Random::new(6);
    let numbers: Vec<f32> = (0..CALLS)
        .map(|i| match i {
            0 => 0.0,
            1 => -0.0,
            2 => 0.25,
            3 => -0.25,
            4 => f32::MIN,
            _ if i % 2 == 0 => -random.magnitude(-30.0, 1.5),
            _ => random.between(-2.0, 0.25),
        })
        .collect();
    let measure = Openness::Step { radius: 1.0 };
    let calls: Vec<_> = numbers.iter().map(|&x| call(measure, 0.0, x)).collect();
    let mut values_of = Comparison::new("expm1");
    for (&x, values) in numbers.iter().zip(functions.call(FUNCTION_OPENNESS, &view(), &calls)) {
        let expected = libm::expm1f(x);
        values_of.add(expected, values.number(1), expected, || format!("{x:e}"));
    }
    values_of.finish(10.0);
}
