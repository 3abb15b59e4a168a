//! A cloth of no thickness, and the shapes it takes.

use core::f32::consts::{PI, TAU};

use glam::{Vec3, Vec4};

use crate::Mesh;
use crate::animation::MorphTarget;
use crate::modelling::noise::smoothstep;

/// Quadrilaterals across and down.
const COLUMNS: u32 = 112;
const ROWS: u32 = 160;
/// Size in metres.
const WIDTH: f32 = 2.3;
const LENGTH: f32 = 2.75;
/// Height of the upper seam.
pub(super) const TOP: f32 = 2.95;

/// Where the point `x` across (−½ to ½) and `d` down (0 to 1) goes.
type Form = fn(x: f32, d: f32) -> Vec3;

/// The shapes besides the one at rest.
const FORMS: [Form; 6] = [billow, twist, lift, gather, surge, swing];
/// Number of morph targets.
pub(super) const TARGETS: usize = FORMS.len();

/// The cloth at rest, and its other shapes as displacements from it.
pub(super) fn cloth(material: u32) -> (Mesh, [MorphTarget; TARGETS]) {
    let triangles = triangles();
    let positions = grid(hang);
    let normals = normals(&positions, &triangles);
    let targets = FORMS.map(|form| {
        let to = grid(form);
        let to_normals = self::normals(&to, &triangles);
        let less = |to: Vec<Vec3>, from: &[Vec3]| to.iter().zip(from).map(|(&a, &b)| a - b).collect();
        MorphTarget {
            positions: less(to, &positions),
            normals: less(to_normals, &normals),
            tangents: Vec::new(),
        }
    });
    let colors = points().map(|(x, d)| stripe(x, d)).collect();
    let mesh =
        Mesh { name: "cloth".to_owned(), positions, normals, colors, triangles, material, ..Mesh::default() };
    (mesh, targets)
}

/// Hanging still, in wide folds.
fn hang(x: f32, d: f32) -> Vec3 {
    let fold = 0.07 * (0.25 + 0.75 * d) * libm::sinf(TAU * 3.5 * x + 0.6 * d);
    Vec3::new(WIDTH * x * (1.0 - 0.05 * d), TOP - LENGTH * d, fold)
}

/// Filled by the wind like a sail.
fn billow(x: f32, d: f32) -> Vec3 {
    let belly = libm::sinf(PI * smoothstep(0.0, 1.35, d)) * libm::cosf(PI * 0.85 * x);
    Vec3::new(WIDTH * x * (1.0 - 0.15 * d), TOP - LENGTH * d * (1.0 - 0.16 * d), 1.15 * belly)
}

/// Wrung about its upright middle, by most of a turn at the hem.
fn twist(x: f32, d: f32) -> Vec3 {
    let (sin, cos) = libm::sincosf(1.6 * PI * d * d);
    let (across, out) = (WIDTH * x * (1.0 - 0.45 * d), 0.05 * libm::sinf(TAU * 3.0 * x));
    Vec3::new(across * cos - out * sin, TOP - LENGTH * d * 0.97, across * sin + out * cos)
}

/// Folded up: the lower part lies over the upper one, in front of it.
fn lift(x: f32, d: f32) -> Vec3 {
    const BEND: f32 = 0.5; // where it turns
    const RADIUS: f32 = 0.22;
    let turned = ((d - BEND) * LENGTH / RADIUS).clamp(0.0, PI);
    let beyond = ((d - BEND) * LENGTH - PI * RADIUS).max(0.0);
    let drop = LENGTH * d.min(BEND) + RADIUS * libm::sinf(turned) - beyond;
    let out = RADIUS * (1.0 - libm::cosf(turned)) + 0.25 * beyond;
    Vec3::new(WIDTH * x, TOP - drop, out + 0.03 * libm::sinf(TAU * 2.5 * x))
}

/// Drawn to one side, in deep and narrow pleats.
fn gather(x: f32, d: f32) -> Vec3 {
    let drawn = smoothstep(0.0, 0.3, d);
    let pleat = libm::sinf(TAU * 8.0 * x);
    let across = WIDTH * (x * (1.0 - 0.68 * drawn) - 0.34 * drawn);
    Vec3::new(across, TOP - LENGTH * d, (0.05 + 0.14 * drawn) * pleat)
}

/// Waves that run down and across.
fn surge(x: f32, d: f32) -> Vec3 {
    let wave = libm::sinf(TAU * (1.6 * d + 0.7 * x));
    let ripple = libm::sinf(TAU * (3.7 * d - 1.9 * x));
    let hold = smoothstep(0.0, 0.25, d);
    Vec3::new(WIDTH * x, TOP - LENGTH * d * 0.9, hold * (0.34 * wave + 0.09 * ripple))
}

/// Blown backwards and up.
fn swing(x: f32, d: f32) -> Vec3 {
    let (sin, cos) = libm::sincosf(1.15 * smoothstep(0.0, 0.6, d));
    let flutter = 0.16 * d * libm::sinf(TAU * (1.2 * d + 1.4 * x));
    Vec3::new(
        WIDTH * x * (1.0 - 0.2 * d),
        TOP - LENGTH * d * cos + flutter * sin,
        -LENGTH * d * sin * 0.8 + flutter * cos,
    )
}

/// Red with bands of yellow, and a blue hem.
fn stripe(x: f32, d: f32) -> Vec4 {
    let band = (d * 10.0) as u32 % 3 == 1;
    let colour = if d > 0.93 || x.abs() > 0.46 {
        [0.06, 0.16, 0.62]
    } else if band {
        [0.90, 0.55, 0.05]
    } else {
        [0.80, 0.06, 0.04]
    };
    Vec3::from(colour).extend(1.0)
}

/// Places across and down, row by row.
fn points() -> impl Iterator<Item = (f32, f32)> {
    let across = |i: u32| i as f32 / COLUMNS as f32 - 0.5;
    (0..=ROWS).flat_map(move |j| (0..=COLUMNS).map(move |i| (across(i), j as f32 / ROWS as f32)))
}

fn grid(form: Form) -> Vec<Vec3> {
    points().map(|(x, d)| form(x, d)).collect()
}

fn triangles() -> Vec<[u32; 3]> {
    let row = COLUMNS + 1;
    let quads = (0..ROWS).flat_map(|j| (0..COLUMNS).map(move |i| j * row + i));
    quads.flat_map(|a| [[a, a + row, a + 1], [a + 1, a + row, a + row + 1]]).collect()
}

/// Means of the adjacent faces' normals, weighted by area.
fn normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; positions.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| positions[i as usize]);
        let normal = (b - a).cross(c - a);
        triangle.iter().for_each(|&i| sums[i as usize] += normal);
    }
    sums.iter().map(|sum| sum.normalize_or(Vec3::Z)).collect()
}
