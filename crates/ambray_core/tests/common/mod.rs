//! Golden files, and a world of planes, quads, discs, spheres and triangles traced by brute force in double precision.

#![allow(dead_code, unreachable_pub, reason = "shared by tests that each use a part of it")]

use ambray_core::{
    gather::{GatherParams, GatherScratch, Gathered, ShadedPoint, gather},
    offset::RayOffset,
    openness::Openness,
    sampling::{PixelKey, SampleSets},
    settings::{NearRadiance, RadianceSource, Thin},
    trace::{Diffuse, Hit, Motion, Ray, Trace, World},
};
use glam::{DVec3, Vec3};
use serde_json::Value;

/// Reads `tests/golden/<name>.json`.
pub fn golden(name: &str) -> Value {
    let path = format!("{}/tests/golden/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{path}: {error}"))
}

pub fn list(value: &Value) -> &[Value] {
    value.as_array().expect("a list")
}

pub fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

pub fn integer(value: &Value) -> u32 {
    value.as_u64().and_then(|v| v.try_into().ok()).expect("a 32-bit integer")
}

pub fn dvec3(value: &Value) -> DVec3 {
    DVec3::from_slice(&list(value).iter().map(number).collect::<Vec<_>>())
}

pub fn vec3(value: &Value) -> Vec3 {
    dvec3(value).as_vec3()
}

/// The fuzzy measure of a golden case, and its radius R (1 where it has none).
pub fn measure(value: &Value) -> (Openness, f32) {
    let field = |name: &str| number(&value[name]) as f32;
    let openness = match value["kind"].as_str().expect("a kind") {
        "poly" => Openness::Power { radius: field("R"), exponent: field("alpha") },
        "exp" => Openness::Exponential { sigma: field("sigma") },
        "exp_trunc" => Openness::ExponentialTruncated { radius: field("R"), sigma: field("sigma") },
        "step" => Openness::Step { radius: field("R") },
        other => panic!("unknown measure {other}"),
    };
    (openness, value.get("R").map_or(1.0, |r| number(r) as f32))
}

/// Gathers at the point of a golden case, with the radiance of its shapes as it is given, thin detection off, and
/// what `change` makes of that.
pub fn gather_at(case: &Value, samples: &SampleSets, change: impl Fn(&mut GatherParams<'_>)) -> Gathered {
    let (openness, radius) = measure(&case["mu"]);
    let mut params = GatherParams {
        openness,
        radius,
        near_radiance: NearRadiance::Averaged,
        near_limit: openness.reach(),
        source: RadianceSource::Albedo,
        thin: Thin::Off,
        thin_edge: false,
        ambient: Vec3::ONE,
        lights: &[],
        offset: RayOffset::UNIT,
        samples,
        temporal: false,
    };
    change(&mut params);
    let normal = vec3(&case["normal"]);
    let key = PixelKey::default();
    let point = ShadedPoint {
        position: vec3(&case["point"]),
        geometric_normal: normal,
        reach: 0.0,
        normal,
        instance: Hit::NONE,
        key,
    };
    let mut out = [Gathered::default()];
    gather(&Shapes::new(&case["geometry"]), &params, &[point], &mut GatherScratch::default(), &mut out);
    out[0]
}

enum Shape {
    Plane { point: DVec3, normal: DVec3 },
    Parallelogram { origin: DVec3, u: DVec3, v: DVec3, triangle: bool },
    Disc { center: DVec3, normal: DVec3, radius: f64 },
    Sphere { center: DVec3, radius: f64 },
}

impl Shape {
    fn new(value: &Value) -> Self {
        let v = |name: &str| dvec3(&value[name]);
        match value["type"].as_str().expect("a type") {
            "plane" => Self::Plane { point: v("point"), normal: v("normal") },
            "quad" => {
                Self::Parallelogram { origin: v("origin"), u: v("edge_u"), v: v("edge_v"), triangle: false }
            }
            "triangle" => {
                Self::Parallelogram { origin: v("a"), u: v("b") - v("a"), v: v("c") - v("a"), triangle: true }
            }
            "disc" => {
                Self::Disc { center: v("center"), normal: v("normal"), radius: number(&value["radius"]) }
            }
            "sphere" => Self::Sphere { center: v("center"), radius: number(&value["radius"]) },
            other => panic!("unknown shape {other}"),
        }
    }

    /// Smallest t > 0 and the normal there.
    fn intersect(&self, o: DVec3, d: DVec3) -> Option<(f64, DVec3)> {
        let plane = |point: DVec3, normal: DVec3| {
            let t = (point - o).dot(normal) / d.dot(normal);
            (t.is_finite() && t > 0.0).then_some(t)
        };
        match *self {
            Self::Plane { point, normal } => plane(point, normal).map(|t| (t, normal)),
            Self::Disc { center, normal, radius } => {
                plane(center, normal).filter(|t| (o + *t * d).distance(center) <= radius).map(|t| (t, normal))
            }
            Self::Parallelogram { origin, u, v, triangle } => {
                let n = u.cross(v);
                let t = plane(origin, n)?;
                let p = o + t * d - origin;
                let (a, b) = (p.cross(v).dot(n) / n.length_squared(), u.cross(p).dot(n) / n.length_squared());
                let inside =
                    a >= 0.0 && b >= 0.0 && if triangle { a + b <= 1.0 } else { a <= 1.0 && b <= 1.0 };
                inside.then_some((t, n.normalize()))
            }
            Self::Sphere { center, radius } => {
                let (b, c) = ((o - center).dot(d), (o - center).length_squared() - radius * radius);
                let root = (b * b - c).sqrt();
                let t = [-b - root, -b + root].into_iter().find(|t| *t > 0.0)?;
                Some((t, (o + t * d - center) / radius))
            }
        }
    }
}

/// Shapes with the radiance that leaves them.
pub struct Shapes {
    shapes: Vec<(Shape, Vec3)>,
}

impl Shapes {
    pub fn new(geometry: &Value) -> Self {
        let radiance = |g: &Value| g.get("radiance").map_or(Vec3::ONE, vec3);
        Self { shapes: list(geometry).iter().map(|g| (Shape::new(g), radiance(g))).collect() }
    }

    fn closest(&self, ray: &Ray) -> Option<(f64, DVec3, usize)> {
        let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let hits = self.shapes.iter().enumerate().filter_map(|(i, (shape, _))| {
            shape.intersect(o, d).filter(|hit| hit.0 <= f64::from(ray.t_max)).map(|(t, n)| (t, n, i))
        });
        hits.min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

impl Trace for Shapes {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit]) {
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = self.closest(ray).map_or(Hit::MISS, |(t, _, i)| Hit {
                t: t as f32,
                instance: i as u32,
                ..Hit::MISS
            });
        }
    }

    fn any_hits(&self, rays: &[Ray], blocked: &mut [bool]) {
        for (ray, blocked) in rays.iter().zip(blocked) {
            *blocked = self.closest(ray).is_some();
        }
    }
}

impl World for Shapes {
    fn motion(&self, _instance: u32) -> Motion {
        Motion::Static
    }

    fn diffuse_at(&self, ray: &Ray, hit: &Hit, _width: f32) -> Diffuse {
        let (t, normal, i) = self.closest(ray).expect("the ray hit something");
        assert_eq!(i, hit.instance as usize);
        let d = ray.direction.as_dvec3();
        let geometric_normal = if normal.dot(d) > 0.0 { -normal } else { normal }.as_vec3();
        Diffuse {
            position: (ray.origin.as_dvec3() + t * d).as_vec3(),
            geometric_normal,
            reach: 0.0,
            albedo: self.shapes[i].1,
        }
    }
}
