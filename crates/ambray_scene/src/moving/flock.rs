//! Two thousand small things that fly around pillars.

use std::sync::Arc;

use glam::{DAffine3, DVec3, Vec2, Vec3};

use crate::animation::{Attachment, Channel, Clip, Interpolation, Local, Node, Property, Rig, Trs};
use crate::modelling::builder::{Builder, MeshId};
use crate::modelling::camera::look;
use crate::modelling::noise::Dice;
use crate::modelling::pose::Pose;
use crate::modelling::shapes::Shape;
use crate::{Motion, Scene};

use super::hall;
use super::paths::Path;

/// Things that fly.
const MEMBERS: usize = 2000;
/// Seconds until all are back.
const DURATION: f32 = 8.0;
/// Where pillars stand, x and z.
const PILLARS: [Vec2; 5] = [
    Vec2::new(-3.0, -2.2),
    Vec2::new(2.8, -2.6),
    Vec2::new(-0.3, 0.2),
    Vec2::new(-3.4, 2.6),
    Vec2::new(3.1, 2.3),
];
/// Height of the pillars.
const HEIGHT: f32 = 3.8;

/// Builds the scene: about 540 000 triangles, counting instances. It loops in 8 s.
#[must_use]
pub fn flock() -> Scene {
    let mut builder = Builder::default();
    hall::floor(&mut builder, Vec2::new(6.4, 5.6), 0.8);
    let stone = hall::paint(&mut builder, "stone", [0.78, 0.73, 0.64]);
    hall::columns(&mut builder, &PILLARS, HEIGHT, stone);
    let still = builder.scene.instances.len();
    let kinds = kinds(&mut builder);
    let mut dice = Dice::new(11);
    let mut rig = Rig {
        clips: vec![Clip { name: "flight".to_owned(), duration: DURATION, channels: Vec::new() }],
        instances: vec![Attachment { node: None, local: DAffine3::IDENTITY }; still],
        ..Rig::default()
    };
    for member in 0..MEMBERS {
        builder.place(kinds[member % kinds.len()], &Pose::at(Vec3::ZERO));
        let path = path(member, &mut dice);
        let scale = DVec3::splat(f64::from(dice.between(0.7, 1.3)));
        add_member(&mut rig, member as u32, &path, scale);
    }
    let mut scene = builder.scene;
    scene.instances[still..].iter_mut().for_each(|instance| instance.motion = Motion::Rigid);
    scene.name = "flock".to_owned();
    hall::light(&mut scene, Vec3::new(-0.45, 0.8, 0.5));
    scene.radius = Some(0.8);
    scene.cameras = vec![
        look("flock", Vec3::new(0.9, 2.5, 8.2), Vec3::new(-0.1, 1.6, 0.0), 46.0),
        look("above", Vec3::new(-1.0, 8.2, 6.6), Vec3::new(0.0, 0.8, 0.0), 48.0),
    ];
    let pose = rig.pose(None);
    scene.rig = Some(Arc::new(rig));
    scene.place(&pose);
    scene
}

/// Most fly around one pillar, some around two neighbours.
fn path(member: usize, dice: &mut Dice) -> Path {
    let pillar = |i: usize| DVec3::new(f64::from(PILLARS[i].x), 0.0, f64::from(PILLARS[i].y));
    let i = member / 4 % PILLARS.len();
    if member.is_multiple_of(5) && i != 2 {
        Path::eight(pillar(2), pillar(i), dice)
    } else {
        Path::around(pillar(i), dice)
    }
}

/// A node with an instance, and what moves it; at rest it is where the clip begins.
fn add_member(rig: &mut Rig, node: u32, path: &Path, scale: DVec3) {
    let (times, places, attitudes) = path.keyframes(DURATION);
    let number = |list: &[f32], i: usize| f64::from(list[i]);
    let translation = DVec3::from_array(std::array::from_fn(|i| number(&places, i)));
    let rotation = glam::DQuat::from_array(std::array::from_fn(|i| number(&attitudes, i))).normalize();
    rig.nodes.push(Node {
        name: format!("member {node}"),
        parent: None,
        local: Local::Trs(Trs { translation, rotation, scale }),
        weights: Vec::new(),
    });
    rig.instances.push(Attachment { node: Some(node), local: DAffine3::IDENTITY });
    for (property, values) in [(Property::Translation, places), (Property::Rotation, attitudes)] {
        let (interpolation, times) = (Interpolation::Linear, times.clone());
        rig.clips[0].channels.push(Channel { node, property, interpolation, times, values });
    }
}

/// What flies, z ahead and about 20 cm long: 120 to 400 triangles each.
fn kinds(builder: &mut Builder) -> [MeshId; 4] {
    let red = hall::paint(builder, "red", [0.82, 0.10, 0.05]);
    let blue = hall::paint(builder, "blue", [0.06, 0.22, 0.66]);
    let green = hall::paint(builder, "green", [0.16, 0.52, 0.12]);
    let gold = hall::paint(builder, "gold", [0.88, 0.56, 0.08]);
    [
        builder.smooth("fish", &fish(), red),
        builder.smooth("bird", &bird(), blue),
        builder.smooth("ring", &Shape::torus(0.085, 0.026, 20, 8).posed(&lying()), green),
        builder.smooth("ball", &Shape::sphere(0.075, 16), gold),
    ]
}

/// Turns what stands upright ahead.
fn lying() -> Pose {
    Pose::at(Vec3::ZERO).tilted(90.0)
}

/// A spindle with a tail fin.
fn fish() -> Shape {
    let profile: Vec<Vec2> = (0..=10)
        .map(|k| {
            let t = k as f32 / 10.0;
            let round = libm::sinf(core::f32::consts::PI * libm::powf(t, 0.75));
            Vec2::new(0.042 * round.max(0.0), 0.24 * (t - 0.5))
        })
        .collect();
    let body = Shape::lathe(&profile, 12).posed(&lying().scaled(Vec3::new(0.6, 1.0, 1.5)));
    let tail = Shape::sheet(4, 4, Vec2::ONE, |u, v| {
        let back = -0.105 - 0.075 * u;
        Vec3::new(0.004 * libm::sinf(6.0 * u), (v - 0.5) * (0.015 + 0.12 * u), back - 0.03 * (v - 0.5).abs())
    });
    let mut shape = body;
    shape.append(tail);
    shape
}

/// A slim body between two bent wings.
fn bird() -> Shape {
    let profile: Vec<Vec2> = (0..=8)
        .map(|k| {
            let t = k as f32 / 8.0;
            Vec2::new(0.024 * libm::sinf(core::f32::consts::PI * t).max(0.0), 0.22 * (t - 0.5))
        })
        .collect();
    let mut shape = Shape::lathe(&profile, 8).posed(&lying());
    shape.append(Shape::sheet(20, 4, Vec2::ONE, |u, v| {
        let x = 2.0 * u - 1.0;
        let out = x.abs();
        let chord = 0.085 * (1.0 - 0.75 * out * out);
        let rise = 0.07 * libm::sinf(2.2 * out) - 0.02 * out;
        Vec3::new(
            0.17 * x,
            rise + 0.004 * (1.0 - (2.0 * v - 1.0) * (2.0 * v - 1.0)),
            0.03 - 0.05 * out + chord * (0.5 - v),
        )
    }));
    shape
}
