//! A scene that tests make themselves: a little of everything that shading and tracing know.

use std::f32::consts::PI;
use std::sync::Arc;

use ambray::light::{Cone, Light};
use ambray_core::shape::{Shape, SignedDistanceField};
use ambray_scene::{
    AlphaMode, Checker, Filter, Image, Instance, Material, Mesh, Sampler, Scene, ShapeInstance, Texture,
    TextureRef, Wrap,
};
use glam::{Affine2, Affine3A, Quat, Vec2, Vec3, Vec4};

/// Materials of the scene, by their place in it.
#[derive(Clone, Copy)]
enum Paint {
    Floor,
    Leaves,
    Glass,
    Bricks,
    Lamp,
    Sign,
    Clay,
    Tiles,
    Ghost,
}

/// Shapes of all kinds on a checkered floor, masked and blended cards, mirrored and shared instances, normal maps, vertex
/// colours, unlit and emissive things; a sun, a lamp and a spot light.
#[must_use]
pub fn zoo() -> Scene {
    let mut scene = Scene {
        name: "zoo".into(),
        materials: materials(),
        textures: vec![
            texture(0, Filter::Linear, Wrap::Repeat),
            texture(1, Filter::Linear, Wrap::Mirror),
            texture(2, Filter::Nearest, Wrap::Clamp),
        ],
        images: [leaves(), bumps(), letters()].map(Arc::new).into(),
        lights: lights(),
        ..Scene::default()
    };
    add_cards(&mut scene);
    add_blocks(&mut scene);
    add_shapes(&mut scene);
    scene
}

fn materials() -> Vec<Material> {
    let color = |r, g, b| Material { base_color: Vec4::new(r, g, b, 1.0), ..Material::default() };
    let checker = |color, size| Some(Checker { color, size });
    let mut materials = vec![Material::default(); 9];
    materials[Paint::Floor as usize] =
        Material { checker: checker(Vec3::new(0.7, 0.2, 0.1), 0.5), ..color(0.8, 0.8, 0.7) };
    materials[Paint::Leaves as usize] =
        Material { base_color_texture: read(0, 0), alpha_mode: AlphaMode::Mask(0.5), ..color(0.9, 0.9, 0.9) };
    materials[Paint::Glass as usize] = Material {
        base_color: Vec4::new(0.2, 0.5, 0.9, 0.4),
        alpha_mode: AlphaMode::Blend,
        ..Material::default()
    };
    materials[Paint::Bricks as usize] = Material {
        normal_texture: read(1, 0),
        normal_scale: 0.8,
        base_color_texture: read(1, 1),
        ..color(0.8, 0.5, 0.4)
    };
    materials[Paint::Lamp as usize] = Material { emission: Vec3::new(2.0, 1.5, 0.5), ..color(0.3, 0.3, 0.3) };
    materials[Paint::Sign as usize] =
        Material { unlit: true, base_color_texture: read(2, 0), ..color(1.0, 1.0, 1.0) };
    materials[Paint::Clay as usize] = color(0.7, 0.35, 0.2);
    materials[Paint::Tiles as usize] =
        Material { checker: checker(Vec3::new(0.1, 0.3, 0.2), 0.2), ..color(0.9, 0.9, 0.6) };
    materials[Paint::Ghost as usize] = Material {
        base_color: Vec4::new(0.9, 0.9, 0.9, 0.5),
        alpha_mode: AlphaMode::Blend,
        ..Material::default()
    };
    materials
}

fn read(texture: u32, uv_set: u32) -> Option<TextureRef> {
    let transform = Affine2::from_scale_angle_translation(Vec2::new(1.5, 2.0), 0.3, Vec2::new(0.1, 0.2));
    Some(TextureRef { texture, uv_set, transform })
}

fn texture(image: u32, filter: Filter, wrap: Wrap) -> Texture {
    let sampler = Sampler { wrap: [wrap, Wrap::Repeat], mag: filter, min: filter, mip: Some(filter) };
    Texture { image, sampler }
}

fn image(name: &str, size: u32, srgb: bool, texel: impl Fn(u32, u32) -> [u8; 4]) -> Image {
    let texels = (0..size).flat_map(|y| (0..size).map(move |x| (x, y))).map(|(x, y)| texel(x, y));
    Image::new(name.into(), size, size, texels.collect(), srgb)
}

fn leaves() -> Image {
    image("leaves", 32, true, |x, y| {
        let r = Vec2::new((x % 16) as f32 - 7.5, (y % 16) as f32 - 7.5).length();
        [60 + 5 * x as u8, 140, 40, if r < 6.0 { 255 } else { (15.0 * (14.0 - r).max(0.0)) as u8 }]
    })
}

fn bumps() -> Image {
    image("bumps", 16, false, |x, y| {
        let wave = |i: u32| (128.0 + 60.0 * (i as f32 * PI / 4.0).sin()) as u8;
        [wave(x), wave(y), 230, 255]
    })
}

fn letters() -> Image {
    image("letters", 8, true, |x, y| if (x * y) % 3 == 0 { [250, 240, 20, 255] } else { [20, 30, 200, 255] })
}

fn lights() -> Vec<Light> {
    let point = |position, intensity, cone| Light::Point { position, intensity, range: 8.0, cone };
    let cone = Cone { axis: Vec3::new(0.0, -1.0, 0.0), cos_inner: 0.9, cos_outer: 0.6 };
    vec![
        Light::Directional { to_light: Vec3::new(0.4, 0.8, 0.45).normalize(), irradiance: Vec3::splat(1.5) },
        point(Vec3::new(-1.5, 1.2, 1.0), Vec3::new(1.0, 0.8, 0.5), None),
        point(Vec3::new(1.0, 2.5, 0.5), Vec3::new(0.5, 0.8, 2.0), Some(cone)),
    ]
}

/// A square of two triangles in the plane z = 0, of unit half size, with all attributes.
fn card(material: Paint, rich: bool) -> Mesh {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let uvs: Vec<Vec2> = corners.iter().map(|&[x, y]| Vec2::new(0.5 + 0.5 * x, 0.5 - 0.5 * y)).collect();
    let colors = corners.iter().map(|&[x, y]| Vec4::new(0.7 + 0.3 * x, 0.8, 0.7 - 0.3 * y, 1.0));
    Mesh {
        positions: corners.iter().map(|&[x, y]| Vec3::new(x, y, 0.0)).collect(),
        normals: if rich { vec![Vec3::new(0.1, 0.0, 1.0).normalize(); 4] } else { Vec::new() },
        tangents: if rich { vec![Vec4::new(1.0, 0.0, 0.0, 1.0); 4] } else { Vec::new() },
        uvs: vec![uvs.clone(), uvs.iter().map(|&uv| 2.0 * uv + 0.25).collect()],
        colors: if rich { colors.collect() } else { Vec::new() },
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        material: material as u32,
        ..Mesh::default()
    }
}

fn place(scene: &mut Scene, mesh: u32, turned: Quat, scale: Vec3, at: Vec3) {
    let world_from_object = Affine3A::from_scale_rotation_translation(scale, turned, at);
    scene.instances.push(Instance { mesh, world_from_object, ..Instance::default() });
}

fn add_cards(scene: &mut Scene) {
    let papers = [Paint::Floor, Paint::Leaves, Paint::Glass, Paint::Bricks, Paint::Sign];
    scene
        .meshes
        .extend(papers.map(|paint| card(paint, matches!(paint, Paint::Bricks | Paint::Leaves)).into()));
    let flat = Quat::from_rotation_x(-0.5 * PI);
    place(scene, 0, flat, Vec3::splat(6.0), Vec3::ZERO);
    for i in 0..5 {
        let i = i as f32;
        let turned = Quat::from_rotation_y(0.5 * i);
        place(scene, 1, turned, Vec3::splat(0.4), Vec3::new(i - 2.2, 0.5, -1.4));
    }
    place(scene, 2, Quat::from_rotation_y(0.2), Vec3::splat(0.7), Vec3::new(-0.6, 0.8, 1.2));
    place(scene, 2, Quat::from_rotation_y(0.3), Vec3::splat(0.7), Vec3::new(-0.5, 0.8, 1.3));
    // The second is its mirror image.
    place(scene, 3, Quat::from_rotation_y(0.3), Vec3::splat(0.8), Vec3::new(-2.6, 0.8, -2.2));
    place(scene, 3, Quat::from_rotation_y(-0.3), Vec3::new(-0.8, 0.8, 0.8), Vec3::new(2.6, 0.8, -2.2));
    place(scene, 4, Quat::from_rotation_y(-0.7), Vec3::splat(0.3), Vec3::new(2.0, 0.4, 0.8));
}

/// Many instances of one block, of which two are stretched.
fn add_blocks(scene: &mut Scene) {
    let mut block = Mesh { material: Paint::Clay as u32, ..Mesh::default() };
    for axis in 0..3 {
        for sign in [-1.0_f32, 1.0] {
            let first = block.positions.len() as u32;
            for [u, v] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
                let mut p = [sign; 3];
                (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (u, v);
                block.positions.push(Vec3::from_array(p));
            }
            block.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
    }
    let mesh = scene.meshes.len() as u32;
    scene.meshes.push(block.into());
    for i in 0..24 {
        let angle = i as f32 * PI / 12.0;
        let scale = if i % 12 == 5 { Vec3::new(0.05, 0.6, 0.1) } else { Vec3::splat(0.12) };
        let at = Vec3::new(3.2 * angle.cos(), scale.y, 3.2 * angle.sin() - 0.5);
        place(scene, mesh, Quat::from_rotation_y(1.3 * angle), scale, at);
    }
}

fn add_shapes(scene: &mut Scene) {
    scene.shapes = vec![
        Shape::Sphere { radius: 0.4 },
        Shape::Box { half_extents: Vec3::new(0.3, 0.2, 0.4) },
        Shape::Capsule { height: 0.6, radius_bottom: 0.25, radius_top: 0.12 },
        Shape::Cylinder { height: 0.8, radius_bottom: 0.3, radius_top: 0.15 },
        Shape::Field(torus()),
    ];
    let mut place = |shape: u32, material: Paint, turned: Quat, scale: Vec3, at: Vec3| {
        let world_from_object = Affine3A::from_scale_rotation_translation(scale, turned, at);
        let material = material as u32;
        scene.shape_instances.push(ShapeInstance {
            shape,
            material,
            world_from_object,
            ..ShapeInstance::default()
        });
    };
    let upright = Quat::IDENTITY;
    place(0, Paint::Clay, upright, Vec3::ONE, Vec3::new(0.0, 0.4, 0.0));
    place(0, Paint::Lamp, upright, Vec3::splat(0.3), Vec3::new(-1.5, 0.7, 0.8));
    place(0, Paint::Ghost, upright, Vec3::ONE, Vec3::new(1.2, 0.5, 1.6));
    place(1, Paint::Tiles, Quat::from_rotation_y(0.6), Vec3::ONE, Vec3::new(1.0, 0.21, -0.2));
    place(2, Paint::Clay, Quat::from_rotation_z(0.4), Vec3::ONE, Vec3::new(-1.2, 0.6, -0.4));
    place(3, Paint::Tiles, upright, Vec3::new(1.0, 1.2, 0.7), Vec3::new(0.2, 0.48, -1.1));
    place(4, Paint::Clay, Quat::from_rotation_x(0.9), Vec3::splat(0.8), Vec3::new(1.9, 0.5, -0.9));
    place(1, Paint::Sign, Quat::from_rotation_y(0.2), Vec3::splat(0.5), Vec3::new(-2.2, 0.1, 0.4));
}

/// A ring of radius 0.5 and thickness 0.3, sampled.
fn torus() -> SignedDistanceField {
    const SIDE: u32 = 24;
    let size = Vec3::new(1.6, 0.6, 1.6);
    let at = |i: u32, size: f32| (i as f32 / (SIDE - 1) as f32 - 0.5) * size;
    let mut distances = Vec::new();
    for k in 0..SIDE {
        for j in 0..SIDE {
            for i in 0..SIDE {
                let p = Vec3::new(at(i, size.x), at(j, size.y), at(k, size.z));
                distances.push(Vec2::new(Vec2::new(p.x, p.z).length() - 0.5, p.y).length() - 0.15);
            }
        }
    }
    SignedDistanceField::new([SIDE; 3], size, distances).unwrap_or_else(|error| panic!("{error}"))
}
