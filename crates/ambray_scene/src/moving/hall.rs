//! An open hall to see things move in: a floor, columns that carry beams, and light.

use ambray_core::light::Light;
use glam::{Vec2, Vec3};

use crate::modelling::builder::{Builder, MaterialId};
use crate::modelling::column::column;
use crate::modelling::pose::Pose;
use crate::modelling::shapes::Shape;
use crate::{Material, Scene};

/// Adds a material of one colour.
pub(super) fn paint(builder: &mut Builder, name: &str, colour: [f32; 3]) -> MaterialId {
    builder.material(Material {
        name: name.to_owned(),
        base_color: Vec3::from(colour).extend(1.0),
        ..Material::default()
    })
}

/// Lays a floor of slabs, pale and dark by turns, from −`half` to `half` (x, z); its top is y = 0.
pub(super) fn floor(builder: &mut Builder, half: Vec2, slab: f32) {
    const JOINT: f32 = 0.008;
    let paints =
        [paint(builder, "pale slabs", [0.76, 0.74, 0.70]), paint(builder, "dark slabs", [0.48, 0.46, 0.44])];
    let mut slabs = [Shape::default(), Shape::default()];
    let count = (2.0 * half / slab).map(libm::roundf);
    let size = 2.0 * half / count;
    for i in 0..count.x as u32 {
        for j in 0..count.y as u32 {
            let lo = -half + size * Vec2::new(i as f32, j as f32) + JOINT;
            let hi = lo + size - 2.0 * JOINT;
            let block = Shape::cuboid(Vec3::new(lo.x, -0.03, lo.y), Vec3::new(hi.x, 0.0, hi.y));
            slabs[((i + j) % 2) as usize].append(block);
        }
    }
    for (shape, paint) in slabs.iter().zip(paints) {
        builder.flat_once("slabs", shape, paint);
    }
    let bed = paint(builder, "bed", [0.4, 0.38, 0.36]);
    let bed_shape = Shape::cuboid(Vec3::new(-half.x, -0.2, -half.y), Vec3::new(half.x, -0.01, half.y));
    builder.flat_once("bed", &bed_shape, bed);
}

/// Sets up columns of the given `height` at each of `places` (x, z).
pub(super) fn columns(builder: &mut Builder, places: &[Vec2], height: f32, stone: MaterialId) {
    let mesh = builder.smooth("column", &column(18, 1), stone);
    for place in places {
        builder.place(mesh, &Pose::xyz(place.x, 0.0, place.y).sized(height / 2.5));
    }
}

/// Lights `scene` by the sun and a clear sky.
pub(super) fn light(scene: &mut Scene, to_sun: Vec3) {
    scene
        .lights
        .push(Light::Directional { to_light: to_sun.normalize(), irradiance: Vec3::new(3.4, 2.9, 2.2) });
    scene.ambient = Some(Vec3::new(0.36, 0.42, 0.50));
}
