//! Scenes of a few closed forms, seen and traced by brute force in double precision.
#![allow(dead_code, unreachable_pub, reason = "each test file uses its part")]

use ambray_core::{
    camera::{Camera, Projection},
    control::Control,
    frame::GBufferPixel,
    gather::{GatherParams, GatherScratch, Gathered, ShadedPoint, gather},
    offset::RayOffset,
    openness::Openness,
    sampling::{PixelKey, SampleSets},
    settings::{Sampling, Sequence, Settings},
    trace::{Diffuse, Hit, Motion, Ray, Trace, World},
    view::View,
};
use ambray_rivals::Screen;
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
    let view = View {
        camera,
        camera_origin: String::new(),
        radius,
        openness: Openness::Power { radius, exponent: 1.0 },
        near_limit: radius,
        ambient: Vec3::ONE,
        background: Vec3::ZERO,
        offset: RayOffset::UNIT,
        lights: Vec::new(),
    };
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
