//! Screens made of closed forms, for tests of the methods that march along slices.

#![allow(dead_code, unreachable_pub, reason = "shared by tests that each use a part of it")]

use ambray_core::{
    camera::{Camera, Projection},
    control::Control,
    frame::GBufferPixel,
    openness::Openness,
    settings::{Method, ScreenQuality, Settings},
    view::View,
};
use ambray_rivals::{Screen, rival};
use glam::{DVec3, Vec3, dvec3};

/// A surface that a ray from the first along the unit second vector may meet: distance and unit normal, of either sign.
pub type Shape = Box<dyn Fn(DVec3, DVec3) -> Option<(f64, DVec3)>>;

/// The plane through `point` with `normal`, where `within` says it is.
pub fn plane(point: DVec3, normal: DVec3, within: impl Fn(DVec3) -> bool + 'static) -> Shape {
    Box::new(move |origin, direction| {
        let t = (point - origin).dot(normal) / direction.dot(normal);
        (t.is_finite() && t > 0.0 && within(origin + t * direction)).then_some((t, normal))
    })
}

/// A sphere.
pub fn sphere(centre: DVec3, radius: f64) -> Shape {
    Box::new(move |origin, direction| {
        let to_centre = centre - origin;
        let along = to_centre.dot(direction);
        let root = (along * along - to_centre.length_squared() + radius * radius).sqrt();
        let t = along - root;
        (t > 0.0).then(|| (t, (origin + t * direction - centre) / radius))
    })
}

/// The axis-aligned box from `low` to `high`.
pub fn cuboid(low: DVec3, high: DVec3) -> Shape {
    Box::new(move |origin, direction| {
        let (a, b) = ((low - origin) / direction, (high - origin) / direction);
        let (near, far) = (a.min(b), a.max(b));
        let (t, axis) = (0..3).map(|axis| (near[axis], axis)).max_by(|a, b| a.0.total_cmp(&b.0))?;
        (t > 0.0 && t <= far.min_element()).then(|| (t, DVec3::AXES[axis]))
    })
}

/// The nearest of `shapes` that the ray meets.
pub fn first_hit(shapes: &[Shape], origin: DVec3, direction: DVec3) -> Option<(f64, DVec3)> {
    shapes.iter().filter_map(|shape| shape(origin, direction)).min_by(|a, b| a.0.total_cmp(&b.0))
}

/// A camera at `position` that looks at `target`, y up unless it looks along y.
pub fn camera(position: DVec3, target: DVec3, projection: Projection, (width, height): (u32, u32)) -> Camera {
    let forward = (target - position).normalize().as_vec3();
    let up = if forward.y.abs() > 0.99 { Vec3::Z } else { Vec3::Y };
    Camera::new(position.as_vec3(), forward, up, projection, width, height)
}

/// What `camera` sees of `shapes`, for the near-field radius `radius`.
pub fn screen(camera: Camera, shapes: &[Shape], radius: f32, settings: &Settings) -> Screen {
    let (width, height) = camera.size();
    let mut gbuffer = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let ray = camera.primary_ray(x, y, 0);
            let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
            gbuffer.push(match first_hit(shapes, origin, direction) {
                None => GBufferPixel::NOTHING,
                Some((t, normal)) => {
                    let normal = if normal.dot(direction) > 0.0 { -normal } else { normal };
                    let forward = camera.forward().as_dvec3();
                    GBufferPixel {
                        position: (origin + t * direction).as_vec3(),
                        depth: (t * direction.dot(forward)) as f32,
                        shading_normal: normal.as_vec3(),
                        ..GBufferPixel::NOTHING
                    }
                }
            });
        }
    }
    let view = View { openness: Openness::Step { radius }, near_limit: 0.0, ..View::new(camera, radius) };
    Screen::new(&gbuffer, &view, settings)
}

/// Cosine-weighted openness at `point` with `normal` among `shapes`, by rays: quadrature over a square of `n` × `n` directions.
pub fn openness_by_rays(shapes: &[Shape], point: DVec3, normal: DVec3, n: u32) -> f64 {
    let (tangent, bitangent) = normal.any_orthonormal_pair();
    let origin = point + 1e-9 * normal;
    let mut open = 0;
    for i in 0..n {
        for j in 0..n {
            let (u, v) = ((f64::from(i) + 0.5) / f64::from(n), (f64::from(j) + 0.5) / f64::from(n));
            let (sin, cos) = (std::f64::consts::TAU * v).sin_cos();
            let direction = u.sqrt() * (cos * tangent + sin * bitangent) + (1.0 - u).sqrt() * normal;
            open += u32::from(first_hit(shapes, origin, direction).is_none());
        }
    }
    f64::from(open) / f64::from(n * n)
}

/// The pixel of `screen` that sees the world's `point`.
pub fn pixel_of(screen: &Screen, point: DVec3) -> (usize, usize) {
    let (place, _) = screen.camera().project(point.as_vec3()).expect("in front of the camera");
    (place.x.round() as usize, place.y.round() as usize)
}

/// The mean of `values` over the pixels around (x, y), `reach` to every side.
pub fn mean_around(screen: &Screen, values: &[f32], (x, y): (usize, usize), reach: usize) -> f32 {
    let width = screen.size().0;
    let rows = y - reach..=y + reach;
    let values: Vec<f32> =
        rows.flat_map(|y| values[y * width + x - reach..=y * width + x + reach].to_vec()).collect();
    values.iter().sum::<f32>() / values.len() as f32
}

/// The scene of golden/xegtao.py.
pub fn golden_screen() -> Screen {
    let projection = Projection::Perspective { vertical_fov: 0.9 };
    let looking = camera(DVec3::ZERO, DVec3::NEG_Z, projection, (96, 64));
    let floor = plane(DVec3::NEG_Y, DVec3::Y, |_| true);
    let ball = sphere(DVec3::new(0.3, -0.4, -4.0), 0.6);
    screen(looking, &[floor, ball], 1.6, &Settings::default())
}

/// Compares with a golden file of `golden_screen`. Rounding may decide for another pixel or sector: a few may differ.
#[track_caller]
pub fn check_golden(golden: &str, raw: &[f32], filtered: &[f32]) {
    let (mut count, mut different) = (0, 0);
    for line in golden.lines().skip(1) {
        let fields: Vec<f32> = line.split(',').map(|field| field.parse().unwrap()).collect();
        let i = fields[1] as usize * 96 + fields[0] as usize;
        let same = (raw[i] - fields[2]).abs() < 1e-4 && (filtered[i] - fields[3]).abs() < 1e-4;
        different += u32::from(!same);
        count += 1;
        assert!((raw[i] - fields[2]).abs() < 0.15, "{} for {} at {i}", raw[i], fields[2]);
    }
    assert_eq!(count, 304);
    assert!(different < 5, "{different} of {count} differ");
}

/// `work` with one thread, and with two.
pub fn with_one_and_two_threads<T: Send>(work: impl Fn() -> T + Sync) -> [T; 2] {
    [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(&work)
    })
}

/// No limits.
pub fn free() -> Control<'static> {
    Control::default()
}

/// A perspective view.
pub const PERSPECTIVE: Projection = Projection::Perspective { vertical_fov: 0.9 };

/// A ball on a floor, seen obliquely.
pub fn ball(settings: &Settings) -> Screen {
    let camera = camera(dvec3(0.0, 2.0, 4.0), dvec3(0.0, 0.3, 0.0), PERSPECTIVE, (97, 65));
    let shapes = [plane(DVec3::ZERO, DVec3::Y, |p| p.length() < 6.0), sphere(dvec3(0.0, 0.7, 0.0), 0.7)];
    screen(camera, &shapes, 1.0, settings)
}

/// The mean of `method` after its filter is that of ultra quality up to `bound`, for every quality.
#[track_caller]
pub fn every_quality_has_the_same_mean(method: Method, bound: f32) {
    let screen = ball(&Settings::default());
    let mean = |screen_quality| {
        let rival = rival(&Settings { method, screen_quality, ..Settings::default() }).unwrap();
        let values = rival.estimate(&screen, &free()).unwrap();
        let values = rival.filter(&screen, &values, &free()).unwrap();
        values.iter().sum::<f32>() / values.len() as f32
    };
    let ultra = mean(ScreenQuality::Ultra);
    for screen_quality in ScreenQuality::ALL {
        let mean = mean(*screen_quality);
        assert!((mean - ultra).abs() < bound, "{mean} with {screen_quality}, {ultra} with ultra");
    }
}
