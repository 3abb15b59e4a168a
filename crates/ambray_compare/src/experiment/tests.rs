use ambray::{
    Control, Renderer,
    scene::{atrium::atrium, moving},
    settings::{Auto, Size},
};
use ambray_metrics::Measure;

use super::*;
use crate::subject::Effort;

fn options(methods: &[Method]) -> Options {
    Options {
        methods: methods.to_vec(),
        rays: vec![1, 4],
        runs: 2,
        truth: TruthOptions::default(),
        sequence: None,
    }
}

fn measured(scene: ambray::scene::Scene, settings: &Settings, options: &Options) -> Outcome {
    let mut renderer = Renderer::new(scene);
    let content = Content::of(renderer.scene());
    let work = Work::new(Control::default(), &|_| ());
    run(&mut renderer, &content, settings, options, work).expect("renders")
}

#[test]
fn every_method_is_measured_against_the_truth() {
    let settings = Settings { size: Size { width: 96, height: 54 }, ..Settings::default() };
    let outcome = measured(atrium(), &settings, &options(Method::ALL));
    let names: Vec<_> = outcome.rows.iter().map(|row| row.method).collect();
    assert_eq!(names, Method::ALL, "Ambray once, and first");
    assert!(outcome.truth.spp >= 1024 && outcome.truth.is_reached());
    let of = |method| &outcome.rows[Method::ALL.iter().position(|&m| m == method).expect("a method")];
    for row in &outcome.rows {
        assert!(row.measures.rmse > 0.0 && row.measures.rmse < 0.5, "{row:?}");
        assert!(row.fitted_rmse <= row.measures.rmse + 1e-9, "a line can only help: {row:?}");
        let is_part =
            |measure| matches!(measure, Measure::SamplingPart | Measure::Grain | Measure::PatternLeft);
        let converges = !row.method.is_screen_space() || row.method == Method::Hybrid;
        for &measure in Measure::ALL {
            assert_eq!(row.measures.get(measure).is_some(), converges || !is_part(measure), "{row:?}");
        }
        assert_eq!(row.milliseconds.count, 2);
        assert!(row.milliseconds.min > 0.0 && row.milliseconds.min <= row.milliseconds.median);
    }
    let sampling = |method| of(method).measures.sampling_part.expect("measured");
    assert!(sampling(Method::Ambray) < 0.7 * sampling(Method::TracedRandom));
    assert!(sampling(Method::TracedRandom) < sampling(Method::TracedSame) * 1.5);
    // A step counts far hits fully: the picture is darker on the whole.
    assert!(of(Method::TracedStep).measures.bias < -0.05);
    // Against what it converges to, it errs as other rays do.
    assert!(sampling(Method::TracedStep) < sampling(Method::TracedRandom));
    let rays = |method| of(method).rays_per_pixel;
    assert!((7.0..=8.0).contains(&rays(Method::Ambray)), "{}", rays(Method::Ambray));
    assert!(rays(Method::Hybrid) > 0.0 && rays(Method::Hybrid) < rays(Method::Ambray));
    assert_eq!(rays(Method::Gtao), 0.0);
    let efforts = |i: usize| outcome.series[i].iter().map(|row| row.effort).collect::<Vec<_>>();
    assert_eq!(efforts(0), [Effort::Rays(1), Effort::Rays(4)]);
    assert_eq!(efforts(6).len(), 4, "all qualities of a method without rays");
    assert!(outcome.series[0][1].measures.rmse < outcome.series[0][0].measures.rmse, "more rays, less error");
    let seen = &outcome.seen;
    assert_eq!((seen.openness.len(), seen.errors.len(), seen.raw.len(), seen.beauty.len()), (10, 9, 9, 10));
}

#[test]
fn a_sequence_tells_flicker_and_ghosting() {
    let settings = Settings {
        size: Size { width: 64, height: 36 },
        spp: 2,
        time: Auto::Value(0.5),
        ..Settings::default()
    };
    let sequence = Some(SequenceOptions { frames: 8, fps: 12.0 });
    let options = Options { sequence, rays: vec![2, 2], runs: 1, ..options(&[Method::TracedRandom]) };
    let outcome = measured(moving::banner(), &settings, &options);
    let moving = outcome.sequence.expect("asked for");
    let names: Vec<_> = moving.rows.iter().map(|row| row.name.as_str()).collect();
    assert_eq!(names, ["Ambray", "Rays, random", "Ambray, accumulated"]);
    let [plain, random, accumulated] = &moving.rows[..] else { panic!("three rows") };
    assert!(moving.rows.iter().all(|row| row.rmse.len() == 8 && row.flicker > 0.0));
    assert!(plain.rmse[7] < random.rmse[7], "{moving:?}");
    assert!(accumulated.rmse[7] < 0.9 * plain.rmse[7], "{moving:?}");
    assert_eq!([plain.lag, random.lag], [None; 2], "what keeps no frames is not late");
    assert!((0.0..1.0).contains(&accumulated.lag.expect("it moves")), "what is kept is: {moving:?}");
    assert!(moving.truth.is_reached());
}
