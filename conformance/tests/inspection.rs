//! The pixel inspector tells what the picture shows: its rays, chords, shadow rays and taps add up to the frame (spec §§3–8).

use ambray::{
    Control, Frame, Inspection, RenderError, Renderer,
    filter::{Refusal, Verdict},
    inspect::{Chord, ShadowSource},
    scene::{Scene, atrium, moving},
};
use ambray_core::{
    compose::reflected,
    openness::Openness,
    settings::{
        Auto, Falloff, FilterTest, NearRadiance, Normals, RadianceSource, Sampling, Settings, Size, Thin,
        ThinMinimum, Triple, Window,
    },
};
use conformance::{backends, parity, scenes};
use glam::{DVec3, Vec3, Vec4, Vec4Swizzles};

/// Settings that differ from `base` in what changes rays, chords or taps.
fn variants(base: &Settings) -> Vec<Settings> {
    let with = |change: &dyn Fn(&mut Settings)| {
        let mut settings = base.clone();
        change(&mut settings);
        settings
    };
    let mut all = vec![base.clone()];
    for &thin in Thin::ALL {
        all.extend(Sampling::ALL.iter().map(|&sampling| with(&|s| (s.thin, s.sampling) = (thin, sampling))));
        all.extend(NearRadiance::ALL.iter().map(|&near| with(&|s| (s.thin, s.near_radiance) = (thin, near))));
        all.extend(
            RadianceSource::ALL.iter().map(|&source| with(&|s| (s.thin, s.radiance_source) = (thin, source))),
        );
        all.extend(Falloff::ALL.iter().map(|&falloff| with(&|s| (s.thin, s.falloff) = (thin, falloff))));
        all.push(with(&|s| (s.thin, s.thin_minimum) = (thin, ThinMinimum::AfterFilter)));
    }
    all.push(with(&|s| (s.thin, s.thin_edge) = (Thin::Sheet, true)));
    all.push(with(&|s| {
        (s.thin, s.thin_minimum, s.radiance_source) =
            (Thin::Sheet, ThinMinimum::AfterFilter, RadianceSource::SelfSimilar)
    }));
    all.extend(Window::ALL.iter().map(|&window| with(&|s| (s.filter, s.filter_cos_normal) = (window, -1.0))));
    all.extend(FilterTest::ALL.iter().map(|&test| with(&|s| s.filter_test = test)));
    all.extend(Normals::ALL.iter().map(|&normals| with(&|s| s.normals = normals)));
    all.push(with(&|s| (s.spp, s.seed, s.frame) = (5, 7, 3)));
    all.push(with(&|s| s.orthographic_height = Auto::Value(3.0)));
    all
}

fn small() -> Settings {
    Settings { size: Size { width: 64, height: 36 }, ..Settings::default() }
}

/// The zoo has masked foliage, blended glass, shapes, and lights of all kinds.
fn zoo() -> Settings {
    Settings {
        radius: Auto::Value(0.8),
        camera_position: Auto::Value(Triple([0.5, 2.2, 4.5])),
        camera_target: Auto::Value(Triple([0.0, 0.3, -0.2])),
        ..small()
    }
}

fn pixels(frame: &Frame, step: usize) -> Vec<(u32, u32)> {
    let (width, height) = (frame.width, frame.height);
    let corners = [(0, 0), (width - 1, 0), (0, height - 1), (width - 1, height - 1)];
    let all = (0..width * height).map(|i| (i % width, i / width));
    corners.into_iter().chain(all.step_by(step)).collect()
}

fn inspect(renderer: &mut Renderer, settings: &Settings, frame: &Frame, pixel: (u32, u32)) -> Inspection {
    renderer.inspect(settings, frame, pixel, Control::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// Openness by the first batch, as the mean of what the rays say.
fn mean_openness(inspection: &Inspection) -> f32 {
    let sum: f64 = inspection.rays.iter().map(|ray| f64::from(ray.openness)).sum();
    (sum / inspection.rays.len() as f64) as f32
}

/// A2, from what the chords say.
fn second_batch(chords: &[Chord]) -> f32 {
    1.0 - chords.iter().map(|chord| chord.weight * chord.blocked).sum::<f32>()
}

/// What an inspection says of itself, whoever traced its rays.
fn assert_sound(name: &str, settings: &Settings, frame: &Frame, inspection: &Inspection) {
    let Some(surface) = inspection.surface else {
        let is_empty = inspection.rays.is_empty()
            && inspection.chords.is_empty()
            && inspection.shadows.is_empty()
            && inspection.taps.is_empty();
        assert!(is_empty, "{name}");
        return;
    };
    assert_eq!(inspection.rays.len(), settings.spp as usize, "{name}");
    let gathered = &inspection.gathered;
    assert_eq!(mean_openness(inspection), gathered.first, "{name}: the rays do not add up");
    let second = second_batch(&inspection.chords);
    assert!((second - gathered.second).abs() < 2e-6, "{name}: the chords say {second}, {gathered:?}");
    assert_eq!(gathered.openness, gathered.first.min(gathered.second), "{name}");
    assert_eq!(inspection.chords.len(), gathered.chord_rays as usize, "{name}");
    if settings.near_radiance == NearRadiance::PerHit && settings.thin == Thin::Off {
        let sum: DVec3 = inspection
            .rays
            .iter()
            .filter_map(|ray| ray.hit.map(|hit| f64::from(1.0 - ray.openness) * hit.radiance.as_dvec3()))
            .sum();
        let near = (sum / inspection.rays.len() as f64).as_vec3();
        assert!(near.abs_diff_eq(gathered.near, 1e-6), "{name}: {near} for {}", gathered.near);
    }
    for ray in &inspection.rays {
        assert_eq!(ray.openness, frame.view.openness.at(ray.distance()), "{name}");
        let above = ray.direction.dot(surface.geometric_normal) > 0.0;
        assert_eq!(ray.is_traced, above, "{name}: {ray}");
    }
    for chord in &inspection.chords {
        assert_chord(name, settings, frame, inspection, chord);
    }
    assert_direct(name, frame, inspection, surface.position);
    for shadow in &inspection.shadows {
        let at = match shadow.source {
            ShadowSource::Surface => surface.position,
            ShadowSource::Ray(i) => inspection.rays[i].hit.expect("a ray that hit").position,
            ShadowSource::Chord(i) => inspection.chords[i].hit.expect("a chord that hit").position,
        };
        let off = shadow.origin.distance(at);
        assert!(off < 2e-3, "{name}: {shadow} starts {off} from where it should");
    }
}

fn assert_chord(name: &str, settings: &Settings, frame: &Frame, inspection: &Inspection, chord: &Chord) {
    let surface = inspection.surface.expect("chords join rays of a surface");
    let length = if settings.thin == Thin::Paper { frame.view.radius } else { 0.5 * frame.view.radius };
    for (end, ray) in [chord.from, chord.to].into_iter().zip(chord.joins) {
        let ray = &inspection.rays[ray];
        assert!(ray.distance() >= frame.view.radius, "{name}: {chord}");
        assert_eq!(end, surface.position + ray.direction * length, "{name}: {chord}");
    }
    let Some(hit) = chord.hit else {
        assert_eq!(chord.blocked, 0.0, "{name}: {chord}");
        return;
    };
    assert!(hit.distance <= chord.from.distance(chord.to), "{name}: {chord}");
    match settings.thin {
        Thin::Paper => assert_eq!(chord.blocked, 1.0, "{name}: {chord}"),
        Thin::Sheet | Thin::Off => {
            let distance = hit.position.distance(surface.position);
            let most = 1.0 - frame.view.openness.at(distance);
            // The edge factor takes some of it; a step jumps at its radius.
            let exact = !settings.thin_edge && !matches!(frame.view.openness, Openness::Step { .. });
            assert!(chord.blocked <= most + 1e-5, "{name}: {chord}");
            assert!(!exact || (chord.blocked - most).abs() < 1e-5, "{name}: {chord} for {most}");
        }
    }
}

/// The shadow rays of the surface add up to its direct light.
fn assert_direct(name: &str, frame: &Frame, inspection: &Inspection, position: Vec3) {
    let surface = inspection.surface.expect("a surface");
    let shadows = inspection.shadows.iter().filter(|shadow| shadow.source == ShadowSource::Surface);
    let arriving = shadows.filter(|shadow| !shadow.blocked).map(|shadow| {
        let incident = frame.view.lights[shadow.light].incident(position);
        assert_eq!(incident.to_light, shadow.direction, "{name}: {shadow}");
        incident.irradiance * surface.shading_normal.dot(incident.to_light)
    });
    let direct = reflected(surface.albedo, arriving.sum());
    let error = (direct - surface.direct).abs().max_element();
    assert!(error <= 1e-5 * (1.0 + surface.direct.max_element()), "{name}: {direct} for {}", surface.direct);
}

/// The taps, with the values of the frame, give what the filter made of them.
fn from_taps(inspection: &Inspection) -> Vec4 {
    let accepted = inspection.taps.iter().filter(|tap| tap.verdict.is_accepted());
    let (sum, weight) = accepted.fold((Vec4::ZERO, 0.0), |(sum, weight), tap| {
        (sum + tap.weight * tap.value.expect("accepted taps have a value"), weight + tap.weight)
    });
    sum / weight
}

fn assert_taps(name: &str, settings: &Settings, frame: &Frame, inspection: &Inspection) {
    if inspection.surface.is_none() {
        return;
    }
    let side = match settings.filter {
        Window::Off => 1,
        Window::Box => 4,
        Window::Centred => 5,
    };
    assert_eq!(inspection.taps.len(), side * side, "{name}");
    for tap in &inspection.taps {
        assert_eq!(tap.pixel.is_none(), tap.verdict == Verdict::Refused(Refusal::OutsidePicture), "{name}");
        let is_empty = tap.pixel.is_some() && tap.value.is_none();
        assert_eq!(is_empty, tap.verdict == Verdict::Refused(Refusal::NoSurface), "{name}: {tap}");
    }
    // Otherwise the mean is not one of the finished values of the frame.
    if !settings.takes_minimum_after_filter() {
        let mean = from_taps(inspection);
        let shown = frame.ambient[index(frame, inspection.pixel)];
        assert!((mean.x - shown.x).abs() < 1e-6, "{name}: {mean} for {shown}");
        if settings.radiance_source != RadianceSource::SelfSimilar {
            let tolerance = 1e-6 * (1.0 + shown.max_element());
            assert!(mean.yzw().abs_diff_eq(shown.yzw(), tolerance), "{name}: {mean} for {shown}");
        }
    }
}

const fn index(frame: &Frame, (x, y): (u32, u32)) -> usize {
    y as usize * frame.width as usize + x as usize
}

/// On the processor everything is what the frame has, bit for bit.
fn check(name: &str, scene: Scene, all: &[Settings]) {
    let mut renderer = Renderer::new(scene);
    let mut seen = Seen::default();
    for (i, settings) in all.iter().enumerate() {
        let frame = parity::render(&mut renderer, settings);
        for pixel in pixels(&frame, 17) {
            let inspection = inspect(&mut renderer, settings, &frame, pixel);
            let name = format!("{name} {i}, pixel {pixel:?}");
            assert_sound(&name, settings, &frame, &inspection);
            assert_taps(&name, settings, &frame, &inspection);
            let i = index(&frame, pixel);
            assert_eq!(inspection.raw, frame.ambient_raw[i], "{name}");
            assert_eq!(inspection.filtered, frame.ambient[i], "{name}");
            assert_eq!(inspection.ray_count(), frame.gbuffer[i].rays as usize, "{name}");
            seen.add(&inspection);
        }
    }
    seen.assert_all(name);
}

/// How often the interesting cases came up: a test that never met them would prove nothing.
#[derive(Debug, Default)]
struct Seen {
    hits: usize,
    chord_hits: usize,
    shadows_of_hits: usize,
    shadows_of_chords: usize,
    refused: usize,
}

impl Seen {
    fn add(&mut self, inspection: &Inspection) {
        let of = |source: fn(&ShadowSource) -> bool| {
            inspection.shadows.iter().filter(|shadow| source(&shadow.source)).count()
        };
        self.hits += inspection.rays.iter().filter(|ray| ray.hit.is_some()).count();
        self.chord_hits += inspection.chords.iter().filter(|chord| chord.hit.is_some()).count();
        self.shadows_of_hits += of(|source| matches!(source, ShadowSource::Ray(_)));
        self.shadows_of_chords += of(|source| matches!(source, ShadowSource::Chord(_)));
        self.refused += inspection.taps.iter().filter(|tap| !tap.verdict.is_accepted()).count();
    }

    fn assert_all(&self, name: &str) {
        let counts = [self.hits, self.chord_hits, self.shadows_of_hits, self.shadows_of_chords, self.refused];
        assert!(counts.iter().all(|&count| count > 0), "{name}: {self:?}");
    }
}

#[test]
fn rays_and_taps_of_the_atrium_add_up_to_its_picture() {
    check("atrium", atrium::atrium(), &variants(&small()));
}

#[test]
fn rays_and_taps_of_masked_and_blended_things_add_up_to_their_picture() {
    check("zoo", scenes::zoo(), &variants(&zoo()));
}

#[test]
fn rays_and_taps_of_a_bent_cloth_add_up_to_its_picture() {
    check("banner", moving::banner(), &variants(&Settings { time: Auto::Value(1.3), ..small() }));
}

/// Also on a device, up to what the parity of backends allows.
#[test]
fn inspections_agree_with_the_pictures_of_every_backend() {
    let scenes = [
        ("zoo", scenes::zoo(), zoo()),
        ("banner", moving::banner(), Settings { time: Auto::Value(1.3), ..small() }),
    ];
    for (name, scene, base) in scenes {
        backends::each(scene, |renderer| {
            let (mut count, mut unequal) = (0_u32, Vec::new());
            for thin in Thin::ALL {
                for source in [RadianceSource::Ambient, RadianceSource::Lit] {
                    let settings = Settings { thin: *thin, radiance_source: source, ..base.clone() };
                    let frame = parity::render(renderer, &settings);
                    for pixel in pixels(&frame, 101) {
                        let inspection = inspect(renderer, &settings, &frame, pixel);
                        let name = format!("{name} {thin:?} {source:?} {pixel:?}");
                        assert_sound(&name, &settings, &frame, &inspection);
                        assert_taps(&name, &settings, &frame, &inspection);
                        let i = index(&frame, pixel);
                        let off = (inspection.raw - frame.ambient_raw[i])
                            .abs()
                            .max((inspection.filtered - frame.ambient[i]).abs())
                            .max_element();
                        let rays = inspection.ray_count() == frame.gbuffer[i].rays as usize;
                        count += 1;
                        if off > parity::TOLERANCE || !rays {
                            unequal.push((name, off, rays));
                        }
                    }
                }
            }
            let most = (1.0 - parity::SHARE) * f64::from(count);
            assert!(unequal.len() as f64 <= most.max(1.0), "{name}: of {count} differ {unequal:?}");
        });
    }
}

#[test]
fn a_pixel_that_sees_nothing_has_done_nothing() {
    backends::each(Scene::default(), |renderer| {
        let settings = small();
        let frame = parity::render(renderer, &settings);
        let inspection = inspect(renderer, &settings, &frame, (3, 5));
        assert_sound("nothing", &settings, &frame, &inspection);
        assert_eq!(inspection.surface, None);
        assert_eq!(inspection.ray_count(), frame.gbuffer[index(&frame, (3, 5))].rays as usize);
        assert_eq!(inspection.raw, frame.ambient_raw[index(&frame, (3, 5))]);
        assert_eq!(inspection.filtered, frame.ambient[index(&frame, (3, 5))]);
    });
}

#[test]
fn a_pixel_outside_the_picture_is_an_error_that_says_so() {
    let mut renderer = Renderer::new(atrium::atrium());
    let frame = parity::render(&mut renderer, &small());
    for pixel in [(64, 0), (0, 36), (u32::MAX, u32::MAX)] {
        let error = renderer.inspect(&small(), &frame, pixel, Control::default()).expect_err("outside");
        assert!(matches!(error, RenderError::Pixel(_)));
        let said = format!("pixel {}, {} is outside the picture of 64 x 36 pixels", pixel.0, pixel.1);
        assert_eq!(error.to_string(), said);
    }
}
