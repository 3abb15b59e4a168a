//! Capsules, tapered ones included: two spheres and the cone that touches both.

use glam::Vec3;

use super::cylinder::Cone;
use super::interval::Interval;
use super::sphere;

/// The cone that touches both spheres along a circle each; `None` if one sphere holds the other.
fn side(height: f32, bottom: f32, top: f32) -> Option<Cone> {
    let taper = bottom - top;
    if height <= taper.abs() {
        return None;
    }
    let sin = taper / height;
    Some(Cone { cos: ((1.0 - sin) * (1.0 + sin)).sqrt(), sin, offset: 0.5 * (bottom + top) })
}

pub(super) fn bounds(height: f32, bottom: f32, top: f32) -> (Vec3, Vec3) {
    let (half, radius) = (0.5 * height, bottom.max(top));
    let low = (-half - bottom).min(half - top);
    let high = (half + top).max(bottom - half);
    (Vec3::new(-radius, low, -radius), Vec3::new(radius, high, radius))
}

/// Where the line is within the hull: it is convex, so from the first to the last point on any of its parts.
pub(super) fn crossing(o: Vec3, d: Vec3, height: f32, bottom: f32, top: f32) -> Interval {
    let half = Vec3::new(0.0, 0.5 * height, 0.0);
    let mut hull = Interval::EMPTY;
    if bottom > 0.0 {
        hull = hull.hull(sphere::crossing(o + half, d, bottom));
    }
    if top > 0.0 {
        hull = hull.hull(sphere::crossing(o - half, d, top));
    }
    let Some(side) = side(height, bottom, top) else { return hull };
    // Heights of the circles of contact.
    let (low, high) = (side.sin * bottom - half.y, side.sin * top + half.y);
    if let Some(roots) = side.roots(o, d).t {
        for t in roots {
            let y = o.y + t * d.y;
            if y >= low && y <= high {
                hull = hull.hull(Interval { near: t, far: t });
            }
        }
    }
    hull
}

/// The part next to `p`.
enum Part {
    /// Of the sphere with this centre and radius.
    Sphere(Vec3, f32),
    Side(Cone),
}

fn part(p: Vec3, height: f32, bottom: f32, top: f32) -> Part {
    let half = Vec3::new(0.0, 0.5 * height, 0.0);
    let Some(side) = side(height, bottom, top) else {
        return if bottom >= top { Part::Sphere(-half, bottom) } else { Part::Sphere(half, top) };
    };
    // Position along the generator through p, from the foot of the lower centre (Quilez, "Round cone").
    let rho = (p.x * p.x + p.z * p.z).sqrt();
    let along = side.cos * (p.y + half.y) - side.sin * rho;
    if along < 0.0 {
        Part::Sphere(-half, bottom)
    } else if along > side.cos * height {
        Part::Sphere(half, top)
    } else {
        Part::Side(side)
    }
}

pub(super) fn normal(p: Vec3, height: f32, bottom: f32, top: f32) -> Vec3 {
    match part(p, height, bottom, top) {
        Part::Sphere(centre, _) => sphere::normal(p - centre),
        Part::Side(cone) => cone.normal(p),
    }
}

pub(super) fn project(p: Vec3, height: f32, bottom: f32, top: f32) -> Vec3 {
    match part(p, height, bottom, top) {
        Part::Sphere(centre, radius) => sphere::project(p - centre, radius) + centre,
        Part::Side(cone) => {
            let rho = (p.x * p.x + p.z * p.z).sqrt();
            p - cone.normal(p) * cone.distance(rho, p.y)
        }
    }
}
