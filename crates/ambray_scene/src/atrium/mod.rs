//! The scene that Ambray shows first: a two-storey arcaded courtyard, made by code alone.
//!
//! A court of 14 × 8.4 m, one step below arcades of round arches and groin vaults. The sun comes from the north-east over
//! a terrace and reaches the south and west arcades; galleries stand above the other three sides. Curtains of no
//! thickness hang between the columns, two centimetres above the floor. x points east, y up and z south; the floor of the
//! arcades is y = 0, units are metres.
//!
//! The scene is the same on every machine, bit for bit: arithmetic is scalar, functions are `libm`'s and chance is a hash.

mod arches;
mod clutter;
mod columns;
mod curtains;
mod floor;
mod foliage;
mod fountain;
mod gallery;
mod lighting;
mod palette;
mod pots;
mod textures;
mod vaults;
mod walls;

#[cfg(test)]
mod tests;

use glam::Vec2;
use palette::Palette;

use crate::Scene;
use crate::modelling::builder::Builder;
use crate::modelling::pose::Pose;

/// Half the size of the court between the axes of its columns, x and z.
const COURT: Vec2 = Vec2::new(7.0, 4.2);
/// Distance of the columns of the ground floor from axis to axis, and depth of the arcades.
const PITCH: f32 = 2.8;
/// Height of the columns of the ground floor; the arches begin here.
const SPRINGING: f32 = 2.5;
/// Height of the floor of the gallery and the terrace.
const GALLERY: f32 = 4.2;
/// Height of the ceiling of the gallery.
const CEILING: f32 = 7.2;
/// Height of the floor of the court.
const COURT_FLOOR: f32 = -0.16;
/// Distance from the axes of the columns to the wall behind the arcade.
const WALL: f32 = 2.6;

/// The four fronts of the court. In the frame of a side the axes of its columns are the x axis, seen from the court
/// x runs to the right and z away into the arcade; y = 0 is the floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    South,
    North,
    West,
    East,
}

impl Side {
    const ALL: [Self; 4] = [Self::South, Self::North, Self::West, Self::East];

    /// Sides with a gallery above; the north has a terrace.
    const TALL: [Self; 3] = [Self::South, Self::West, Self::East];

    /// Frame of the side.
    fn pose(self) -> Pose {
        match self {
            Self::South => Pose::xyz(0.0, 0.0, COURT.y),
            Self::North => Pose::xyz(0.0, 0.0, -COURT.y).turned(180.0),
            Self::West => Pose::xyz(-COURT.x, 0.0, 0.0).turned(-90.0),
            Self::East => Pose::xyz(COURT.x, 0.0, 0.0).turned(90.0),
        }
    }

    /// Number of arches.
    const fn bays(self) -> u32 {
        match self {
            Self::South | Self::North => 5,
            Self::West | Self::East => 3,
        }
    }

    /// x of the axis of column `k`, the corner piers included.
    fn column(self, k: u32) -> f32 {
        (k as f32 - 0.5 * self.bays() as f32) * PITCH
    }

    /// x of the middle of arch `k`.
    fn bay(self, k: u32) -> f32 {
        self.column(k) + 0.5 * PITCH
    }
}

/// Builds the scene: about 145 000 triangles, counting instances.
#[must_use]
pub fn atrium() -> Scene {
    let mut builder = Builder::default();
    let palette = Palette::new(&mut builder);
    for build in [
        floor::build,
        columns::build,
        arches::build,
        vaults::build,
        walls::build,
        gallery::build,
        curtains::build,
        foliage::build,
        fountain::build,
        pots::build,
        clutter::build,
    ] {
        build(&mut builder, &palette);
    }
    let mut scene = builder.scene;
    scene.name = "atrium".to_owned();
    lighting::light(&mut scene);
    scene
}
