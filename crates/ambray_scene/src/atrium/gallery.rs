//! The upper floor: balustrades with turned balusters, the slender arcades, ceilings, cornice and roof.

use glam::{Vec2, Vec3};

use super::arches::{Opening, arch};
use super::palette::Palette;
use super::{CEILING, COURT, GALLERY, PITCH, Side, WALL};
use crate::modelling::builder::Builder;
use crate::modelling::column::column;
use crate::modelling::pose::{Pose, sin_cos};
use crate::modelling::shapes::{Profile, Shape};

/// Distance of the columns of the gallery.
const HALF_PITCH: f32 = 0.5 * PITCH;
/// Height of the balustrade over the floor, without the caps of its pedestals.
const RAIL: f32 = 0.92;
/// Height of the columns that stand on the balustrade.
const COLUMN: f32 = 1.38;
/// Height of the eaves.
const EAVES: f32 = CEILING + 0.54;
/// Rise of the roof, degrees.
const ROOF_SLOPE: f32 = 17.0;
/// How far the roof reaches into the court.
const OVERHANG: f32 = 0.52;

/// Builds everything above the floor of the gallery but its outer walls.
pub(super) fn build(builder: &mut Builder, palette: &Palette) {
    balustrades(builder, palette);
    upper_arcade(builder, palette);
    ceiling(builder, palette);
    roof(builder, palette);
}

fn balustrades(builder: &mut Builder, palette: &Palette) {
    let baluster = builder.smooth("baluster", &baluster(), palette.stone);
    let pedestal = builder.flat("pedestal", &pedestal(), palette.stone);
    for side in Side::ALL {
        let length = side.bays() as f32 * PITCH;
        let rails = builder.flat("rails", &rails(length), palette.stone);
        builder.place(rails, &side.pose().then(&Pose::xyz(0.0, GALLERY, 0.0)));
        let tall = Side::TALL.contains(&side);
        let (fields, field, per_field) =
            if tall { (2 * side.bays(), HALF_PITCH, 4) } else { (side.bays(), PITCH, 9) };
        for k in posts(side, fields) {
            let x = k as f32 * field - 0.5 * length;
            builder.place(pedestal, &side.pose().then(&Pose::xyz(x, GALLERY, 0.0)));
        }
        for k in 0..fields {
            for i in 0..per_field {
                let x = (k as f32 + 0.5) * field - 0.5 * length;
                let x = x + (i as f32 - 0.5 * (per_field - 1) as f32) * 0.275;
                builder.place(baluster, &side.pose().then(&Pose::xyz(x, GALLERY + 0.11, 0.0)));
            }
        }
    }
}

/// Numbers of the posts between and beside `fields`; the corners belong to the long sides.
fn posts(side: Side, fields: u32) -> std::ops::RangeInclusive<u32> {
    if matches!(side, Side::South | Side::North) { 0..=fields } else { 1..=fields - 1 }
}

/// A turned baluster, 0.67 m high and 0.15 m thick.
fn baluster() -> Shape {
    let profile = [
        (0.068, 0.0),
        (0.068, 0.050),
        (0.042, 0.080),
        (0.064, 0.150),
        (0.075, 0.215),
        (0.062, 0.300),
        (0.033, 0.480),
        (0.048, 0.520),
        (0.036, 0.550),
        (0.064, 0.600),
        (0.064, 0.670),
    ];
    Shape::lathe(&profile.map(|(r, y)| Vec2::new(r, y)), 7)
}

/// A pedestal of the balustrade, 0.3 m wide and 0.95 m high.
fn pedestal() -> Shape {
    let profile = Profile::from(0.15, -0.02)
        .to(0.15, 0.13)
        .to(0.13, 0.15)
        .to(0.13, 0.78)
        .to(0.16, 0.82)
        .to(0.16, RAIL + 0.015)
        .to(0.145, RAIL + 0.03)
        .to(0.0, RAIL + 0.03);
    Shape::moulding(Vec2::ZERO, &profile.0)
}

/// Foot and hand rail of a balustrade of the given length.
fn rails(length: f32) -> Shape {
    let half = Vec2::new(0.5 * length, 0.0);
    let foot = Profile::from(0.11, -0.02).to(0.11, 0.09).to(0.09, 0.115).to(0.0, 0.115);
    let hand = Profile::from(0.0, 0.765)
        .to(0.08, 0.765)
        .to(0.08, 0.80)
        .to(0.12, 0.83)
        .to(0.12, RAIL - 0.02)
        .to(0.10, RAIL)
        .to(0.0, RAIL);
    let mut shape = Shape::moulding(half, &foot.0);
    shape.append(Shape::moulding(half, &hand.0));
    shape
}

/// Columns and arches of the gallery.
fn upper_arcade(builder: &mut Builder, palette: &Palette) {
    let column = builder.smooth("gallery column", &column(9, 3), palette.stone);
    let pier = Shape::block(Vec3::new(0.26, COLUMN + 0.02, 0.26));
    let pier = builder.flat("gallery pier", &pier, palette.stone);
    let springing = GALLERY + RAIL + COLUMN + 0.02;
    let opening = Opening { half_width: 0.5 * HALF_PITCH, hole: 0.62, height: EAVES - springing, steps: 14 };
    let wall = builder.flat("gallery arch wall", &opening.wall(0.12), palette.plaster);
    let profile = Profile::from(0.66, 0.11)
        .to(0.66, 0.14)
        .to(0.57, 0.14)
        .to(0.56, 0.13)
        .to(0.56, -0.13)
        .to(0.575, -0.145)
        .to(0.64, -0.155)
        .to(0.665, -0.175)
        .to(0.68, -0.11);
    let angles: Vec<f32> = (0..=12).map(|k| 180.0 * k as f32 / 12.0).collect();
    let ring = builder.smooth("gallery archivolt", &arch(&profile.0, &angles), palette.stone);
    for side in Side::TALL {
        let place = |x: f32, y: f32| side.pose().then(&Pose::xyz(x, y, 0.0));
        let fields = 2 * side.bays();
        for k in posts(side, fields) {
            let x = (k as f32 - 0.5 * fields as f32) * HALF_PITCH;
            if k == 0 || k == fields {
                builder.place(pier, &place(x, GALLERY + RAIL + 0.02));
            } else {
                builder.place(column, &place(x, GALLERY + RAIL + 0.03).sized(COLUMN / 2.5));
            }
        }
        for k in 0..fields {
            let x = (k as f32 + 0.5 - 0.5 * fields as f32) * HALF_PITCH;
            builder.place(wall, &place(x, springing));
            builder.place(ring, &place(x, springing));
        }
    }
}

/// A boarded ceiling with beams both ways: square coffers.
fn ceiling(builder: &mut Builder, palette: &Palette) {
    let outer = COURT + WALL + 0.05;
    let inner = COURT + 0.05;
    let (lo, hi) = (CEILING, CEILING + 0.12);
    let mut boards = Shape::default();
    for (x0, x1, z0, z1) in [
        (-outer.x, outer.x, inner.y, outer.y),
        (-outer.x, -inner.x, -outer.y, inner.y),
        (inner.x, outer.x, -outer.y, inner.y),
    ] {
        boards.append(Shape::cuboid(Vec3::new(x0, lo, z0), Vec3::new(x1, hi, z1)));
    }
    builder.flat_once("gallery ceiling", &boards, palette.wood);

    let beam = Shape::cuboid(Vec3::new(-0.06, -0.15, 0.0), Vec3::new(0.06, 0.02, WALL + 0.02));
    let beam = builder.flat("gallery beam", &beam, palette.dark_wood);
    for side in Side::TALL {
        // The south side takes the corners, the others go on to the gables in the north.
        let bays = side.bays() as i32;
        let (from, to) = match side {
            Side::South => (-2 * bays - 3, 2 * bays + 3),
            Side::West => (-2 * bays - 3, 2 * bays),
            _ => (-2 * bays, 2 * bays + 3),
        };
        for k in from..=to {
            let x = 0.25 * PITCH * (k as f32);
            builder.place(beam, &side.pose().then(&Pose::xyz(x, CEILING, 0.05)));
        }
        let (x0, x1) = (0.25 * PITCH * (from as f32 - 0.5), 0.25 * PITCH * (to as f32 + 0.5));
        let mut purlins = Shape::default();
        for z in [0.9, 1.75] {
            purlins.append(Shape::cuboid(Vec3::new(x0, -0.11, z - 0.05), Vec3::new(x1, 0.02, z + 0.05)));
        }
        let purlins = builder.flat("gallery purlins", &purlins, palette.dark_wood);
        builder.place(purlins, &side.pose().then(&Pose::xyz(0.0, CEILING, 0.05)));
    }
}

/// The cornice of the gallery and the roofs behind it, tiles laid in rows from wall to eaves.
fn roof(builder: &mut Builder, palette: &Palette) {
    let north = -COURT.y - WALL - 0.4;
    let along = |out: f32, y: f32| {
        let (x, z) = (COURT.x - out, COURT.y - out);
        [Vec3::new(x, y, north), Vec3::new(x, y, z), Vec3::new(-x, y, z), Vec3::new(-x, y, north)]
    };
    let sweep = |profile: &[Vec2]| {
        let points: Vec<[Vec3; 4]> = profile.iter().map(|p| along(p.x, p.y)).collect();
        Shape::loft(&[0, 1, 2, 3].map(|k| points.iter().map(|p| p[k]).collect::<Vec<_>>()))
    };
    let cornice = Profile::from(0.11, EAVES - 0.30)
        .to(0.15, EAVES - 0.29)
        .to(0.15, EAVES - 0.22)
        .to(0.20, EAVES - 0.20)
        .to(0.20, EAVES - 0.13)
        .curve(Vec2::new(0.34, EAVES - 0.12), Vec2::new(0.38, EAVES - 0.05), 3)
        .to(0.40, EAVES - 0.05)
        .to(0.40, EAVES)
        .to(-0.1, EAVES + 0.001);
    builder.smooth_once("gallery cornice", &sweep(&cornice.0), palette.stone);

    let depth = OVERHANG + WALL + 0.45;
    let (sin, cos) = sin_cos(ROOF_SLOPE);
    let rise = depth * sin / cos;
    let surface =
        [(OVERHANG, EAVES + 0.01), (OVERHANG - depth, EAVES + 0.01 + rise), (OVERHANG - depth, EAVES - 0.1)];
    builder.flat_once("roof", &sweep(&surface.map(|(x, y)| Vec2::new(x, y))), palette.roof);

    let ring = |z: f32| -> Vec<Vec3> {
        let point = |k| {
            let (sin, cos) = sin_cos(180.0 * k as f32 / 5.0);
            Vec3::new(0.085 * cos, 0.075 * sin - 0.01, z)
        };
        (0..=5).map(point).collect()
    };
    let row = builder.smooth("roof tiles", &Shape::loft(&[ring(1.0), ring(0.0)]), palette.roof);
    for side in Side::TALL {
        let half = 0.5 * side.bays() as f32 * PITCH;
        let south = |x: f32| side == Side::South || (side == Side::West) == (x > 0.0);
        for k in -50..50 {
            let x = 0.2 * (k as f32 + 0.5);
            // Towards a corner the row begins in the valley; in the north it goes on to the gable.
            let valley = if south(x) { (x.abs() - half + OVERHANG).max(0.0) } else { 0.0 };
            let reach = if south(x) { half + WALL + 0.4 } else { -north };
            if x.abs() < reach && valley < depth - 0.05 {
                let pose = Pose::xyz(x, EAVES + 0.02 + valley * sin / cos, valley - OVERHANG);
                let length = (depth - valley) / cos;
                let pose = pose.tilted(-ROOF_SLOPE).scaled(Vec3::new(1.0, 1.0, length));
                builder.place(row, &side.pose().then(&pose));
            }
        }
    }
}
