//! Floors: slightly uneven tiles with open joints, and the step around the court.

use glam::{Vec2, Vec3};

use super::palette::Palette;
use super::{COURT, COURT_FLOOR, GALLERY, WALL};
use crate::modelling::builder::Builder;
use crate::modelling::noise::Dice;
use crate::modelling::shapes::{Profile, Shape};

/// Edge of a tile with its joint.
const TILE: f32 = 0.7;
/// Width of a joint.
const JOINT: f32 = 0.012;
/// Depth of the joints below the highest tiles.
const DEPTH: f32 = 0.012;
/// From the axis of the columns to the edge of the step.
const STEP: f32 = 0.42;

/// Lays the floors of both storeys.
pub(super) fn build(builder: &mut Builder, palette: &Palette) {
    let inner = COURT - STEP;
    let outer = COURT + WALL;
    let mut dice = Dice::new(7);
    let [mut pale, mut dark] = [Shape::default(), Shape::default()];

    // The court: a border of dark tiles one tile from the edge.
    let (columns, rows) = grid(inner);
    for i in 0..columns {
        for j in 0..rows {
            let at_border = |k: u32, n: u32| k == 1 || k + 2 == n;
            let inside = |k: u32, n: u32| k >= 1 && k + 2 <= n;
            let border =
                inside(i, columns) && inside(j, rows) && (at_border(i, columns) || at_border(j, rows));
            let size = 2.0 * inner / Vec2::new(columns as f32, rows as f32);
            let lo = -inner + size * Vec2::new(i as f32, j as f32);
            let shape = if border { &mut dark } else { &mut pale };
            shape.append(tile(lo, lo + size, COURT_FLOOR, &mut dice));
        }
    }

    // The arcades, a field at a time; the fields do not overlap.
    let edge = inner + 0.30; // behind the stone of the step
    let strips = [
        (Vec2::new(-outer.x, edge.y), Vec2::new(outer.x, outer.y)),
        (Vec2::new(-outer.x, -outer.y), Vec2::new(outer.x, -edge.y)),
        (Vec2::new(-outer.x, -edge.y), Vec2::new(-edge.x, edge.y)),
        (Vec2::new(edge.x, -edge.y), Vec2::new(outer.x, edge.y)),
    ];
    for (lo, hi) in strips {
        pale.append(field(lo, hi, TILE, 0.0, &mut dice));
    }
    builder.flat_once("floor tiles", &pale, palette.tiles);
    builder.flat_once("border tiles", &dark, palette.dark_tiles);

    let mut bed = Shape::cuboid(
        Vec3::new(-inner.x, COURT_FLOOR - 0.3, -inner.y),
        Vec3::new(inner.x, COURT_FLOOR - DEPTH, inner.y),
    );
    for (lo, hi) in strips {
        bed.append(Shape::cuboid(Vec3::new(lo.x, -0.4, lo.y), Vec3::new(hi.x, -DEPTH, hi.y)));
    }
    builder.flat_once("floor bed", &bed, palette.mortar);

    // The stone edge of the arcades: a rounded nosing over a riser, from under the court up to behind the nosing.
    let nosing = Profile::from(0.01, COURT_FLOOR - 0.05).to(0.01, -0.045);
    let nosing = nosing.torus(0.02, -0.04, 0.018, 5).to(0.01, 0.0).to(-0.30, 0.0).to(-0.30, -0.3);
    builder.smooth_once("court step", &Shape::inner_moulding(inner, &nosing.0), palette.stone);
    upper_floor(builder, palette);
}

/// Floor of gallery and terrace: larger tiles on 14 cm of mortar over the vaults.
fn upper_floor(builder: &mut Builder, palette: &Palette) {
    let (outer, inner) = (COURT + WALL, COURT - 0.18);
    let mut dice = Dice::new(17);
    let [mut tiles, mut bed] = [Shape::default(), Shape::default()];
    for (lo, hi) in [
        (Vec2::new(-outer.x, inner.y), outer),
        (-outer, Vec2::new(outer.x, -inner.y)),
        (Vec2::new(-outer.x, -inner.y), Vec2::new(-inner.x, inner.y)),
        (Vec2::new(inner.x, -inner.y), Vec2::new(outer.x, inner.y)),
    ] {
        tiles.append(field(lo, hi, 1.33 * TILE, GALLERY, &mut dice));
        let (bottom, top) = (GALLERY - 0.15, GALLERY - DEPTH);
        bed.append(Shape::cuboid(Vec3::new(lo.x, bottom, lo.y), Vec3::new(hi.x, top, hi.y)));
    }
    builder.flat_once("gallery tiles", &tiles, palette.tiles);
    builder.flat_once("gallery floor bed", &bed, palette.mortar);
}

/// Tiles of about `size` that fill the rectangle from `lo` to `hi`.
fn field(lo: Vec2, hi: Vec2, size: f32, height: f32, dice: &mut Dice) -> Shape {
    let count = ((hi - lo) / size).map(libm::roundf);
    let size = (hi - lo) / count;
    let mut shape = Shape::default();
    for i in 0..count.x as u32 {
        for j in 0..count.y as u32 {
            let lo = lo + size * Vec2::new(i as f32, j as f32);
            shape.append(tile(lo, lo + size, height, dice));
        }
    }
    shape
}

/// Number of tiles along both sides of the court.
fn grid(inner: Vec2) -> (u32, u32) {
    let count = (2.0 * inner / TILE).map(libm::roundf);
    (count.x as u32, count.y as u32)
}

/// One tile between `lo` and `hi` with chamfered edges: its top is up to 3 mm below `height`, and not quite level.
fn tile(lo: Vec2, hi: Vec2, height: f32, dice: &mut Dice) -> Shape {
    let (lo, hi) = (lo + 0.5 * JOINT, hi - 0.5 * JOINT);
    let top = height - dice.between(0.0008, 0.0022);
    let mut tilt = || dice.between(-0.0006, 0.0006);
    let heights = [top + tilt(), top + tilt(), top + tilt(), top + tilt()];
    let corners = [(lo.x, hi.y), (hi.x, hi.y), (hi.x, lo.y), (lo.x, lo.y)];
    let (middle, foot) = (0.5 * (lo + hi), height - DEPTH - 0.01);
    let top: [Vec3; 4] = core::array::from_fn(|k| {
        let (x, z) = corners[k];
        let inset = 0.005;
        let toward = |x: f32, middle: f32| if x < middle { x + inset } else { x - inset };
        Vec3::new(toward(x, middle.x), heights[k], toward(z, middle.y))
    });
    let mut shape = Shape::default();
    shape.panel(top);
    for k in 0..4 {
        let n = (k + 1) % 4;
        let foot = |k: usize| Vec3::new(corners[k].0, foot, corners[k].1);
        shape.panel([foot(k), foot(n), top[n], top[k]]);
    }
    shape.with_uv_offset(Vec2::new(dice.between(0.0, 2.0), dice.between(0.0, 2.0)))
}
