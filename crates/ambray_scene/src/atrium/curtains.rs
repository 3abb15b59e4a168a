//! Curtains between the columns and banners from the balustrade: single sheets of no thickness.

use core::f32::consts::TAU;

use glam::{Vec2, Vec3};

use super::palette::Palette;
use super::{GALLERY, PITCH, Side};
use crate::modelling::builder::{Builder, MaterialId, MeshId};
use crate::modelling::noise::{Dice, smoothstep};
use crate::modelling::pose::Pose;
use crate::modelling::shapes::Shape;

/// Height of the rods' axes.
const ROD: f32 = 1.99;
/// Gap between the hem of the curtains and the floor.
pub(super) const GAP: f32 = 0.022;
/// Height of the ties above the hem.
const TIE: f32 = 0.98;
/// From the rods' axes to the upper seam.
const RING_DROP: f32 = 0.035;

/// A curtain that hangs in the plane z = 0 between `from` and `to` on the x axis.
#[derive(Clone, Copy, Debug)]
struct Curtain {
    name: &'static str,
    cloth: MaterialId,
    from: f32,
    to: f32,
    /// Width of a fold.
    fold: f32,
    /// How far the hem swings out in its folds.
    depth: f32,
    /// Tied together at this x at the height of a hand, or hanging free.
    tie: Option<f32>,
    seed: u32,
}

/// Hangs all curtains and banners.
pub(super) fn build(builder: &mut Builder, palette: &Palette) {
    let fittings = Fittings::new(builder, palette);
    let free = |name, cloth, from, to, seed| Curtain {
        name,
        cloth,
        from,
        to,
        fold: 0.20,
        depth: 0.065,
        tie: None,
        seed,
    };
    let tied =
        |name, cloth, from, to, at, seed| Curtain { tie: Some(at), ..free(name, cloth, from, to, seed) };
    let across =
        |side: Side, k: u32| side.pose().then(&Pose::xyz(side.column(k), 0.0, 0.5 * PITCH).turned(90.0));
    let front = |side: Side, k: u32| side.pose().then(&Pose::xyz(side.bay(k), 0.0, 0.0));

    // Seen along the south arcade from its east end.
    let hangings = [
        (front(Side::South, 4), free("blue curtain", palette.blue, -1.18, -0.2, 101)),
        (front(Side::South, 2), free("red curtain", palette.red, -1.2, 0.1, 103)),
        (front(Side::South, 0), tied("striped curtain", palette.striped, -1.2, 1.2, -1.05, 105)),
        (across(Side::South, 2), free("green curtain", palette.green, -1.12, -0.05, 107)),
        (front(Side::West, 1), free("blue west curtain", palette.blue, -1.2, 1.2, 109)),
        (front(Side::West, 2), tied("red west curtain", palette.red, -1.2, 1.2, -1.05, 111)),
        (front(Side::North, 1), tied("green north curtain", palette.green, -1.2, 1.2, -1.05, 113)),
        (front(Side::North, 3), tied("red north curtain", palette.red, -1.2, 1.2, 1.05, 115)),
        (front(Side::East, 1), free("striped east curtain", palette.striped, -0.2, 1.2, 117)),
    ];
    for (pose, curtain) in hangings {
        let mesh = builder.smooth(curtain.name, &curtain.shape(), curtain.cloth);
        builder.place(mesh, &pose);
        fittings.place(builder, &pose, &curtain);
    }
    banners(builder, palette);
}

impl Curtain {
    /// The sheet; its lowest point is [`GAP`] above the floor.
    fn shape(&self) -> Shape {
        let width = self.to - self.from;
        let folds = libm::roundf(width / self.fold).max(1.0);
        let mut dice = Dice::new(self.seed);
        let phases: [f32; 4] = core::array::from_fn(|_| dice.between(0.0, TAU));
        let top = ROD - RING_DROP;
        let columns = folds as u32 * 8;
        Shape::sheet(columns, 8, Vec2::new(width * 1.4, top - GAP), |u, v| {
            // v runs from the hem to the seam; folds wander a little on their way down.
            let drop = 1.0 - v;
            let wander =
                0.35 * libm::sinf(TAU * u + phases[0]) + 0.25 * drop * libm::sinf(2.6 * TAU * u + phases[1]);
            let turn = TAU * folds * u + wander;
            let swing =
                self.depth * (0.45 + 0.55 * drop) * (0.8 + 0.2 * libm::sinf(1.7 * TAU * u + phases[2]));
            let mut x = self.from + width * u - 0.22 * swing * libm::sinf(2.0 * turn);
            let mut z = swing * libm::sinf(turn) + 0.02 * drop * libm::sinf(0.8 * TAU * u + phases[3]);
            if let Some(tie) = self.tie {
                // Narrow at the tie, fuller again below.
                let height = v * (top - GAP);
                let above = ((height - TIE) / (top - GAP - TIE)).max(0.0);
                let below = 0.10 + 0.22 * smoothstep(TIE, 0.0, height);
                let open = below.max(above * (1.85 - 0.85 * above));
                x = tie + (x - tie) * open;
                z *= 0.55 + 0.45 * open;
            }
            let hem = if v == 0.0 { 0.006 * (1.0 + libm::sinf(turn + 1.0)) } else { 0.0 };
            Vec3::new(x, GAP + hem * 0.5 + (top - GAP) * v, z)
        })
    }
}

/// Rods and rings, shared by all curtains.
#[derive(Clone, Copy, Debug)]
struct Fittings {
    rod: MeshId,
    ring: MeshId,
    tie: MeshId,
}

impl Fittings {
    fn new(builder: &mut Builder, palette: &Palette) -> Self {
        let half = 0.5 * PITCH - 0.12;
        let path = [Vec3::new(-half, ROD, 0.0), Vec3::new(half, ROD, 0.0)];
        let ring = Shape::torus(0.026, 0.005, 7, 3).posed(&Pose::xyz(0.0, 0.0, 0.0).rolled(90.0));
        Self {
            rod: builder.smooth("curtain rod", &Shape::tube(&path, 0.014, 10), palette.bronze),
            ring: builder.smooth("curtain ring", &ring, palette.bronze),
            tie: builder.smooth("curtain tie", &Shape::torus(0.115, 0.016, 16, 6), palette.bronze),
        }
    }

    /// Hangs the fittings of one curtain: a ring at each fold.
    fn place(&self, builder: &mut Builder, pose: &Pose, curtain: &Curtain) {
        builder.place(self.rod, pose);
        let folds = libm::roundf((curtain.to - curtain.from) / curtain.fold) as u32;
        for k in 0..=folds {
            let x = curtain.from + (curtain.to - curtain.from) * k as f32 / folds as f32;
            builder.place(self.ring, &pose.then(&Pose::xyz(x, ROD - 0.012, 0.0)));
        }
        if let Some(x) = curtain.tie {
            let x = x - 0.045 * x.signum();
            let squeezed = Pose::xyz(x, TIE + GAP, 0.0).scaled(Vec3::new(1.0, 2.2, 0.45));
            builder.place(self.tie, &pose.then(&squeezed));
        }
    }
}

/// Long cloths that hang from poles on the balustrade, over the cornice and in front of the spandrels.
fn banners(builder: &mut Builder, palette: &Palette) {
    let (top, length, width) = (GALLERY + 0.86, 2.2, 0.62);
    let pole_out = -0.195;
    let sheet = Shape::sheet(6, 24, Vec2::ONE, |u, v| {
        let (x, hang) = (u - 0.5, (1.0 - v) * length);
        let point = 0.22 * (1.0 - 2.0 * x.abs()) * smoothstep(1.5, length, hang);
        let wave = 0.022 * libm::sinf(3.0 * x + 2.1 * hang) * smoothstep(0.9, 1.5, hang);
        // The cornice holds the cloth off the wall.
        let out = pole_out - 0.215 * smoothstep(0.0, 0.72, hang) + wave;
        Vec3::new(x * width, top - hang - point, out)
    });
    let banner = builder.smooth("banner", &sheet, palette.banner);
    let half = 0.5 * width + 0.04;
    let pole = Shape::tube(&[Vec3::new(-half, top, pole_out), Vec3::new(half, top, pole_out)], 0.016, 8);
    let pole = builder.smooth("banner pole", &pole, palette.bronze);
    for (side, k) in [(Side::South, 1), (Side::South, 4), (Side::West, 1), (Side::West, 2), (Side::East, 1)] {
        let place = side.pose().then(&Pose::xyz(side.column(k), 0.0, 0.0));
        builder.place(banner, &place);
        builder.place(pole, &place);
    }
}
