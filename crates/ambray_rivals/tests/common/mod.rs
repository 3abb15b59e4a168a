//! Scenes of a few closed forms, seen and traced by brute force in double precision.
#![allow(dead_code, unreachable_pub, reason = "each test file uses its part")]

use ambray_core::{
    camera::{Camera, Projection},
    control::{Cancelled, Control},
    frame::GBufferPixel,
    gather::{GatherParams, GatherScratch, Gathered, ShadedPoint, gather},
    sampling::{PixelKey, SampleSets},
    settings::{Method, Sampling, ScreenQuality, Sequence, Settings},
    trace::{Diffuse, Hit, Motion, Ray, Trace, World},
    view::View,
};
use ambray_rivals::{Rival, Screen, rival};
use glam::{DVec3, Vec3};

/// A surface, two-sided.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// Corner and the two sides of a rectangle.
    Rectangle(DVec3, DVec3, DVec3),
    /// Centre and radius.
    Sphere(DVec3, f64),
}

impl Shape {
    /// The floor y = `height` for x in [`from`, `to`], long in z.
    pub fn level(height: f64, from: f64, to: f64) -> Self {
        let corner = DVec3::new(from, height, -50.0);
        Self::Rectangle(corner, DVec3::new(to - from, 0.0, 0.0), DVec3::new(0.0, 0.0, 100.0))
    }

    /// The wall x = `x` for y in [`from`, `to`], long in z.
    pub fn upright(x: f64, from: f64, to: f64) -> Self {
        let corner = DVec3::new(x, from, -50.0);
        Self::Rectangle(corner, DVec3::new(0.0, to - from, 0.0), DVec3::new(0.0, 0.0, 100.0))
    }

    /// Distance and unit normal of the first hit.
    fn hit(&self, origin: DVec3, direction: DVec3) -> Option<(f64, DVec3)> {
        match *self {
            Self::Rectangle(corner, u, v) => {
                let normal = u.cross(v).normalize();
                let t = normal.dot(corner - origin) / normal.dot(direction);
                let at = origin + direction * t - corner;
                let (s, r) = (at.dot(u) / u.length_squared(), at.dot(v) / v.length_squared());
                let inside = (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&r);
                (t > 0.0 && t.is_finite() && inside).then_some((t, normal))
            }
            Self::Sphere(centre, radius) => {
                let o = origin - centre;
                let b = o.dot(direction);
                let root = (b * b - o.length_squared() + radius * radius).sqrt();
                let t = [-b - root, -b + root].into_iter().find(|t| *t > 0.0)?;
                Some((t, (o + direction * t) / radius))
            }
        }
    }
}

/// Shapes; each is an instance.
#[derive(Clone, Debug)]
pub struct Scene(pub Vec<Shape>);

impl Scene {
    /// Distance, unit normal and number of the closest hit.
    pub fn closest(&self, origin: DVec3, direction: DVec3) -> Option<(f64, DVec3, usize)> {
        let hits = self.0.iter().enumerate();
        hits.filter_map(|(i, shape)| shape.hit(origin, direction).map(|(t, normal)| (t, normal, i)))
            .min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// What `camera` sees.
    pub fn gbuffer(&self, camera: &Camera) -> Vec<GBufferPixel> {
        let (width, height) = camera.size();
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        pixels.map(|(x, y)| self.pixel(camera, x, y)).collect()
    }

    fn pixel(&self, camera: &Camera, x: u32, y: u32) -> GBufferPixel {
        let ray = camera.primary_ray(x, y, 0);
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let Some((t, normal, instance)) = self.closest(origin, direction) else {
            return GBufferPixel::NOTHING;
        };
        let position = (origin + direction * t).as_vec3();
        let normal = if normal.dot(direction) > 0.0 { -normal } else { normal }.as_vec3();
        GBufferPixel {
            position,
            depth: camera.depth(position),
            geometric_normal: normal,
            shading_normal: normal,
            smooth_normal: normal,
            reach: position.abs().max_element(),
            instance: instance as u32,
            ..GBufferPixel::NOTHING
        }
    }
}

impl Trace for Scene {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit]) {
        for (ray, out) in rays.iter().zip(hits) {
            let hit = self.closest(ray.origin.as_dvec3(), ray.direction.as_dvec3());
            *out = match hit {
                Some((t, _, i)) if (t as f32) < ray.t_max => {
                    Hit { t: t as f32, instance: i as u32, ..Hit::MISS }
                }
                _ => Hit::MISS,
            };
        }
    }

    fn any_hits(&self, _rays: &[Ray], _blocked: &mut [bool]) {
        unreachable!("openness needs distances")
    }
}

impl World for Scene {
    fn motion(&self, _instance: u32) -> Motion {
        Motion::Static
    }

    fn diffuse_at(&self, _ray: &Ray, _hit: &Hit, _width: f32) -> Diffuse {
        unreachable!("openness needs no colours")
    }
}

/// Parallel projection at `eye` along `forward`, of `pixels` to a scene unit.
pub fn parallel(eye: DVec3, forward: DVec3, (width, height): (u32, u32), pixels: f32) -> Camera {
    let projection = Projection::Orthographic { height: height as f32 / pixels };
    // Looking down, x stays to the right.
    let up = if forward.x == 0.0 && forward.z == 0.0 { Vec3::NEG_Z } else { Vec3::Y };
    Camera::new(eye.as_vec3(), forward.normalize().as_vec3(), up, projection, width, height)
}

/// Perspective at `eye` towards `target`, 60° high.
pub fn perspective(eye: DVec3, target: DVec3, (width, height): (u32, u32)) -> Camera {
    let projection = Projection::Perspective { vertical_fov: std::f32::consts::FRAC_PI_3 };
    let forward = (target - eye).normalize().as_vec3();
    Camera::new(eye.as_vec3(), forward, Vec3::Y, projection, width, height)
}

/// What a camera knows of a scene.
pub struct Seen {
    pub gbuffer: Vec<GBufferPixel>,
    pub screen: Screen,
    pub view: View,
}

/// `scene` as `camera` sees it, with near-field radius `radius`, μ(d) = d/R and `settings`.
pub fn see(scene: &Scene, camera: Camera, radius: f32, settings: &Settings) -> Seen {
    let view = View::new(camera, radius);
    let gbuffer = scene.gbuffer(&camera);
    let screen = Screen::new(&gbuffer, &view, settings);
    Seen { gbuffer, screen, view }
}

/// Openness of the pixels by tracing every ray of `settings`.
pub fn traced(scene: &Scene, seen: &Seen, settings: &Settings) -> Vec<f32> {
    let samples = SampleSets::of(settings);
    let params = GatherParams::new(settings, &seen.view, &samples);
    let width = seen.view.camera.size().0;
    let points: Vec<(usize, ShadedPoint)> = (0..seen.gbuffer.len())
        .filter(|i| seen.gbuffer[*i].is_surface())
        .map(|i| {
            let key = PixelKey::new(i as u32 % width, i as u32 / width, settings.frame, settings.seed);
            (i, seen.gbuffer[i].shaded_point(key))
        })
        .collect();
    let shaded: Vec<ShadedPoint> = points.iter().map(|(_, point)| *point).collect();
    let mut out = vec![Gathered::default(); points.len()];
    gather(scene, &params, &shaded, &mut GatherScratch::default(), &mut out);
    let mut openness = vec![1.0; seen.gbuffer.len()];
    for ((i, _), gathered) in points.iter().zip(&out) {
        openness[*i] = gathered.openness;
    }
    openness
}

/// Settings of a converged truth: 1024 rays that differ from pixel to pixel, without colour bleeding.
pub fn truth() -> Settings {
    Settings { spp: 1024, sampling: Sampling::Random, sequence: Sequence::Owen, ..rays() }
}

/// Settings without colour bleeding.
pub fn rays() -> Settings {
    Settings { near_radiance: ambray_core::settings::NearRadiance::Off, ..Settings::default() }
}

pub fn mean(values: impl IntoIterator<Item = f32>) -> f64 {
    let (sum, count) =
        values.into_iter().fold((0.0, 0.0), |(sum, count), v| (sum + f64::from(v), count + 1.0));
    sum / count
}

/// Runs `work` with 1 and 2 threads, and asserts the same bits.
#[track_caller]
pub fn same_bits_for_any_threads(work: impl Fn(&Control<'_>) -> Vec<f32> + Sync) {
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let values = pool.install(|| work(&Control::default()));
        values.into_iter().map(f32::to_bits).collect::<Vec<_>>()
    };
    assert_eq!(run(1), run(2));
}

/// A ball before a wall.
pub fn ball_before_a_wall() -> (Scene, Camera) {
    let ball = Shape::Sphere(DVec3::new(0.0, 0.5, 0.0), 0.5);
    let scene = Scene(vec![Shape::level(0.0, -50.0, 50.0), ball, Shape::upright(-1.0, 0.0, 50.0)]);
    (scene, perspective(DVec3::new(2.0, 1.5, 1.0), DVec3::new(0.0, 0.3, 0.0), (96, 64)))
}

/// A ball on a floor.
pub fn ball_on_a_floor() -> (Scene, Camera) {
    let ball = Shape::Sphere(DVec3::new(0.0, 0.5, 0.0), 0.5);
    let scene = Scene(vec![Shape::level(0.0, -50.0, 50.0), ball]);
    (scene, perspective(DVec3::new(2.0, 1.5, 1.0), DVec3::ZERO, (48, 32)))
}

/// A floor from 0.1 to 1.7 beside a wall that is outside the picture.
pub fn beside_a_wall_that_is_not_seen() -> (Scene, Camera) {
    let scene = Scene(vec![Shape::level(0.0, 0.0, 50.0), Shape::upright(0.0, 0.0, 50.0)]);
    (scene, parallel(DVec3::new(0.9, 5.0, 0.0), DVec3::NEG_Y, (32, 20), 20.0))
}

/// The mean of `method` is that of ultra quality up to `bound`, for every quality.
#[track_caller]
pub fn any_quality_has_the_same_mean(method: Method, bound: f64) {
    let (scene, camera) = ball_before_a_wall();
    let of = |screen_quality| {
        let settings = Settings { method, screen_quality, ..Settings::default() };
        let screen = see(&scene, camera, 0.8, &settings).screen;
        mean(rival(&settings).unwrap().estimate(&screen, &Control::default()).unwrap())
    };
    let best = of(ScreenQuality::Ultra);
    assert!(best < 0.97, "{best}");
    for quality in [ScreenQuality::Low, ScreenQuality::Medium, ScreenQuality::High] {
        assert!((of(quality) - best).abs() < bound, "{quality}: {} for {best}", of(quality));
    }
}

/// One and two threads give the same bits, and a cancelled estimate ends.
#[track_caller]
pub fn threads_change_nothing_and_work_can_be_stopped(rival: &dyn Rival) {
    let (scene, camera) = ball_on_a_floor();
    let screen = see(&scene, camera, 0.8, &Settings::default()).screen;
    same_bits_for_any_threads(|control| {
        let raw = rival.estimate(&screen, control).unwrap();
        rival.filter(&screen, &raw, control).unwrap()
    });
    let cancel = true.into();
    let control = Control { cancel: &cancel, ..Control::default() };
    assert_eq!(rival.estimate(&screen, &control), Err(Cancelled));
}

/// Values are in [0, 1], and 1 where nothing is seen, before and after the filter.
#[track_caller]
pub fn where_nothing_is_seen_it_is_open(rival: &dyn Rival) {
    let scene = Scene(vec![Shape::Sphere(DVec3::ZERO, 0.5)]);
    let camera = parallel(DVec3::new(0.0, 5.0, 0.0), DVec3::NEG_Y, (24, 24), 12.0);
    let screen = see(&scene, camera, 0.5, &Settings::default()).screen;
    let values = rival.estimate(&screen, &Control::default()).unwrap();
    let filtered = rival.filter(&screen, &values, &Control::default()).unwrap();
    assert!(values.iter().chain(&filtered).all(|o| (0.0..=1.0).contains(o)));
    assert_eq!((values[0], filtered[0]), (1.0, 1.0));
}
