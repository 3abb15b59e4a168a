//! Sample sets, hashes, and thresholds of stochastic transparency: equal in all bits, so that backends take the same
//! decisions.

use ambray_core::{
    sampling::{PixelKey, SampleSets, owen, owen_point, pcg, r2_point, sample_class, sobol1, unit_float},
    settings::{Sampling, Sequence, Settings},
    trace::alpha_threshold,
};
use ambray_scene::Scene;
use ambray_vulkan::layout::{FUNCTION_ALPHA, FUNCTION_INTEGERS, FUNCTION_PIXELS, FUNCTION_SAMPLES};

use crate::{
    calls::{Call, Device, view},
    compare::Comparison,
    random::Random,
};

const EDGES: [u32; 12] = [0, 1, 2, 3, 15, 16, 255, 256, 0x7fff_ffff, 0x8000_0000, 0xffff_ff00, u32::MAX];

/// Edges first, then anything.
fn words(random: &mut Random, i: usize) -> u32 {
    if i < EDGES.len() * EDGES.len() && random.word() & 1 == 0 {
        EDGES[i % EDGES.len()]
    } else {
        random.word()
    }
}

#[test]
fn integer_functions() {
    let Some(device) = Device::open(Scene::default()) else { return };
    let functions = device.functions(&Settings::default());
    let mut random = Random::new(1);
    let arguments: Vec<[u32; 3]> = (0..10_000)
        .map(|i| {
            let first = EDGES.get(i).copied().unwrap_or_else(|| words(&mut random, i));
            [first, words(&mut random, i), words(&mut random, i)]
        })
        .collect();
    let calls: Vec<_> =
        arguments.iter().map(|[a, b, c]| Call::default().word(*a).word(*b).word(*c)).collect();
    for (&[a, b, c], values) in arguments.iter().zip(functions.call(FUNCTION_INTEGERS, &view(), &calls)) {
        let [owen_x, owen_y] = owen_point(a, [b, c]);
        let [r2_x, r2_y] = r2_point(a, [b, c]);
        let expected = [pcg(a), sobol1(a), owen(a, b), owen_x, owen_y, r2_x, r2_y, unit_float(a).to_bits()];
        assert_eq!([0, 1, 2, 3, 4, 5, 6, 7].map(|i| values.word(i)), expected, "{a:#x}, {b:#x}, {c:#x}");
    }
}

#[test]
fn pixels() {
    let Some(device) = Device::open(Scene::default()) else { return };
    let functions = device.functions(&Settings::default());
    let mut random = Random::new(2);
    let arguments: Vec<[u32; 5]> = (0..10_000)
        .map(|i| {
            let (x, y) =
                if i < 4096 { (i as u32 % 64, i as u32 / 64) } else { (random.word(), random.word()) };
            [x, y, words(&mut random, i), words(&mut random, i), words(&mut random, i)]
        })
        .collect();
    let calls: Vec<_> =
        arguments.iter().map(|words| words.iter().fold(Call::default(), |call, w| call.word(*w))).collect();
    for (&[x, y, frame, seed, ray], values) in
        arguments.iter().zip(functions.call(FUNCTION_PIXELS, &view(), &calls))
    {
        let key = PixelKey::new(x, y, frame, seed);
        let expected =
            [sample_class(x, y).into(), key.hash, PixelKey::primary_seed(x, y, frame), key.ray_seed(ray)];
        assert_eq!([0, 1, 2, 3].map(|i| values.word(i)), expected, "{x}, {y}, {frame}, {seed}, {ray}");
    }
}

#[test]
fn alpha_thresholds() {
    let Some(device) = Device::open(Scene::default()) else { return };
    let functions = device.functions(&Settings::default());
    let mut random = Random::new(3);
    let arguments: Vec<[u32; 3]> =
        (0..10_000).map(|i| [words(&mut random, i), words(&mut random, i), words(&mut random, i)]).collect();
    let calls: Vec<_> =
        arguments.iter().map(|[a, b, c]| Call::default().word(*a).word(*b).word(*c)).collect();
    for (&[seed, instance, triangle], values) in
        arguments.iter().zip(functions.call(FUNCTION_ALPHA, &view(), &calls))
    {
        let expected = alpha_threshold(seed, instance, triangle);
        assert_eq!(values.word(0), expected.to_bits(), "{seed:#x}, {instance:#x}, {triangle:#x}");
    }
}

/// Directions of tables are those of the tables. Those of per-pixel sets come from points that are equal in all bits, by
/// polynomials that are off by 2 units of the last place of 1, and one each for the square root and the product.
#[test]
fn sample_directions() {
    let Some(device) = Device::open(Scene::default()) else { return };
    let mut random = Random::new(4);
    for sampling in Sampling::ALL {
        let mut cartesian = Comparison::new("sample directions");
        for sequence in Sequence::ALL {
            for spp in [1, 8, 17] {
                let (frame, seed) = (random.word() & 1023, random.word() & 3);
                let settings = Settings {
                    sampling: *sampling,
                    sequence: *sequence,
                    spp,
                    frame,
                    seed,
                    ..Settings::default()
                };
                let sets = SampleSets::new(*sampling, *sequence, spp, frame, seed);
                let arguments: Vec<_> = (0..1000)
                    .map(|_| {
                        let key = PixelKey::new(random.word() & 4095, random.word() & 4095, frame, seed);
                        (key, random.word() % spp)
                    })
                    .collect();
                let calls: Vec<_> = (arguments.iter())
                    .map(|(key, j)| Call::default().word(key.class.into()).word(key.hash).word(*j))
                    .collect();
                let all = device.functions(&settings).call(FUNCTION_SAMPLES, &view(), &calls);
                for (&(key, j), values) in arguments.iter().zip(all) {
                    let expected = sets.direction(key, j);
                    assert_eq!(values.word(3), expected.azimuth.to_bits(), "{settings:?} {key:?} {j}");
                    let what = || format!("{sampling:?} {sequence:?} {spp} {key:?} {j}");
                    cartesian.add_vector(expected.local, values.vector(0), 1.0, what);
                }
            }
        }
        let is_table = matches!(sampling, Sampling::Interleaved | Sampling::Same);
        cartesian.finish(if is_table { 0.0 } else { 4.0 });
    }
}
