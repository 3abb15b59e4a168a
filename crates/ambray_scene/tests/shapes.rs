//! Shapes, checkers and motion in glTF files, and points on placed shapes.

mod common;

use std::sync::Arc;

use ambray_core::{
    offset::RayOffset,
    sampling::{pcg, unit_float},
    shape::Shape,
    trace::{Hit, Ray},
};
use ambray_scene::{
    Checker, Loaded, Material, MaterialKind, Mesh, Motion, Scene, ShapeInstance, surface::Surfaces,
};
use base64::Engine as _;
use common::{assert_refused, load_files, load_text};
use glam::{Affine3A, DVec3, Quat, Vec3, Vec4};

/// A file with the numbers −1.5, −0.5, … in accessors 0 (16 of them), 1 (8) and 2 (4 × 3), and `rest` in its root object.
fn gltf(rest: &str) -> String {
    let numbers: Vec<u8> = (0..16).flat_map(|i: i32| (i as f32 - 1.5).to_le_bytes()).collect();
    let data = base64::engine::general_purpose::STANDARD.encode(numbers);
    format!(
        r#"{{"asset":{{"version":"2.0"}},
        "buffers":[{{"byteLength":64,"uri":"data:application/octet-stream;base64,{data}"}}],
        "bufferViews":[{{"buffer":0,"byteLength":64}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":16,"type":"SCALAR"}},
            {{"bufferView":0,"componentType":5126,"count":8,"type":"SCALAR"}},
            {{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}}],
        {rest}}}"#
    )
}

#[track_caller]
fn load(rest: &str) -> Loaded {
    load_text(&gltf(rest))
}

#[track_caller]
fn check_refused(rest: &str, expected: &str) {
    assert_refused(&gltf(rest), expected);
}

/// A file that shows `shape`.
fn shown(shape: &str) -> String {
    format!(
        r#""extensions":{{"KHR_implicit_shapes":{{"shapes":[{shape}]}}}},
        "nodes":[{{"extensions":{{"AMBRAY_implicit_surface":{{"shape":0}}}}}}]"#
    )
}

#[test]
fn shapes_of_all_types() {
    let rest = r#""extensionsUsed":["KHR_implicit_shapes","AMBRAY_implicit_surface","KHR_physics_rigid_bodies"],
        "extensionsRequired":["KHR_implicit_shapes","AMBRAY_implicit_surface","AMBRAY_shape_field","AMBRAY_material_checker"],
        "extensions":{"KHR_implicit_shapes":{"shapes":[
            {"type":"sphere","sphere":{"radius":2}},
            {"type":"box","box":{"size":[1,2,3]}},
            {"type":"plane"},
            {"type":"capsule","capsule":{"height":1,"radiusTop":0.5,"radiusBottom":0}},
            {"type":"cylinder"},
            {"type":"field","extensions":{"AMBRAY_shape_field":{"samples":[2,2,4],"size":[1,1,2],"distances":0}}}]}},
        "materials":[{},{"name":"second"}],
        "nodes":[
            {"extensions":{"AMBRAY_implicit_surface":{"shape":1,"material":1}},"translation":[5,0,0],"children":[1]},
            {"extensions":{"AMBRAY_implicit_surface":{"shape":0,"material":0}},"scale":[2,2,-2]},
            {"extensions":{"AMBRAY_implicit_surface":{"shape":3}}},
            {"extensions":{"AMBRAY_implicit_surface":{"shape":4}}},
            {"extensions":{"AMBRAY_implicit_surface":{"shape":5}}},
            {"extensions":{"AMBRAY_implicit_surface":{"shape":1,"material":0}}},
            {"extensions":{"KHR_physics_rigid_bodies":{"collider":{"geometry":{"shape":2}}}}}]"#;
    let Loaded { scene, warnings, .. } = load(rest);
    assert_eq!(scene.shapes.len(), 5, "each is there once, and only what is shown");
    assert_eq!(scene.shapes[0], Shape::Box { half_extents: Vec3::new(0.5, 1.0, 1.5) });
    assert_eq!(scene.shapes[1], Shape::Sphere { radius: 2.0 });
    assert_eq!(scene.shapes[2], Shape::Capsule { height: 1.0, radius_bottom: 0.0, radius_top: 0.5 });
    assert_eq!(scene.shapes[3], Shape::Cylinder { height: 0.5, radius_bottom: 0.25, radius_top: 0.25 });
    let Shape::Field(field) = &scene.shapes[4] else { panic!("{:?}", scene.shapes[4]) };
    assert_eq!((field.samples(), field.distances()[3]), ([2, 2, 4], 1.5));
    let placed: Vec<_> = scene.shape_instances.iter().map(|i| (i.shape, i.material)).collect();
    assert_eq!(placed, [(0, 1), (1, 0), (2, 2), (3, 2), (4, 2), (0, 0)]);
    assert_eq!(scene.bounds(), Some((Vec3::new(-0.5, -4.0, -4.0), Vec3::new(9.0, 4.0, 4.0))));
    let ignored = "extension 'KHR_physics_rigid_bodies' is ignored: physics, and shapes that only collide are not shown";
    assert_eq!(warnings, [ignored]);
}

#[test]
fn hostile_shapes() {
    let refused = |shape: &str, at: &str| {
        check_refused(&shown(shape), &format!("extensions.KHR_implicit_shapes.shapes[0]{at}"));
    };
    refused(r#"{"type":"sphere","sphere":{"radius":0}}"#, ".sphere.radius: 0 is not positive");
    refused(r#"{"type":"sphere","sphere":{"radius":-1}}"#, ".sphere.radius: -1 is not positive");
    refused(
        r#"{"type":"sphere","sphere":{"radius":1e30}}"#,
        ".sphere.radius: 1e30 is not within 1e-6 and 1e9",
    );
    refused(r#"{"type":"box","box":{"size":[1,0,1]}}"#, ".box.size: 0 is not positive");
    refused(r#"{"type":"capsule","capsule":{"height":0}}"#, ".capsule.height: 0 is not positive");
    refused(
        r#"{"type":"cylinder","cylinder":{"radiusTop":-0.5}}"#,
        ".cylinder.radiusTop: -0.5 is not positive",
    );
    refused(
        r#"{"type":"cylinder","cylinder":{"radiusTop":0,"radiusBottom":0}}"#,
        ".cylinder: both radii are 0",
    );
    refused(r#"{"type":"plane"}"#, ".type: shapes of type 'plane' cannot be shown");
    refused(r#"{}"#, ".type: shapes of type '' cannot be shown");
    refused(r#"{"type":"field"}"#, ".extensions.AMBRAY_shape_field: field without its samples");
    let field = |samples: &str, size: &str, distances: u32, rest: &str| {
        let shape = format!(
            r#"{{"type":"field","extensions":{{"AMBRAY_shape_field":{{"samples":{samples},"size":{size},"distances":{distances}}}}}}}"#
        );
        refused(&shape, &format!(".extensions.AMBRAY_shape_field.{rest}"));
    };
    field("[1,8,1]", "[1,1,1]", 1, "samples: 1 × 8 × 1, each must be 2 at least");
    field(
        "[4294967296,4294967296,2]",
        "[1,1,1]",
        1,
        "samples: 4294967296 × 4294967296 × 2 samples, at most 4096 an axis and 268435456 in all are allowed",
    );
    field(
        "[4096,4096,4096]",
        "[1,1,1]",
        1,
        "samples: 4096 × 4096 × 4096 samples, at most 4096 an axis and 268435456 in all are allowed",
    );
    field("[2,2,2]", "[1,-1,1]", 1, "size: -1 is not positive");
    field("[2,2,3]", "[1,1,1]", 1, "distances: 8 values for 2 × 2 × 3 samples");
    field("[2,2,2]", "[1,1,1]", 9, "distances: accessor 9 does not exist");
    check_refused(
        &shown(
            r#"{"type":"field","extensions":{"AMBRAY_shape_field":{"samples":[2,2,1],"size":[1,1,1],"distances":2}}}"#,
        ),
        "samples: 2 × 2 × 1, each must be 2 at least",
    );
    let node = |surface: &str| {
        format!(
            r#""extensions":{{"KHR_implicit_shapes":{{"shapes":[{{"type":"sphere"}}]}}}},
            "nodes":[{{"extensions":{{"AMBRAY_implicit_surface":{surface}}}}}]"#
        )
    };
    let at = "nodes[0].extensions.AMBRAY_implicit_surface";
    check_refused(&node(r#"{"shape":1}"#), &format!("{at}.shape: shape 1 does not exist"));
    check_refused(&node(r#"{"shape":0,"material":3}"#), &format!("{at}.material: material 3 does not exist"));
    check_refused(
        r#""nodes":[{"extensions":{"AMBRAY_implicit_surface":{"shape":0}}}]"#,
        &format!("{at}.shape: shape 0 does not exist"),
    );
    let checker = |json: &str, reason: &str| {
        check_refused(
            &format!(r#""materials":[{{"extensions":{{"AMBRAY_material_checker":{json}}}}}]"#),
            &format!("materials[0].extensions.AMBRAY_material_checker.{reason}"),
        );
    };
    checker(r#"{"size":0}"#, "size: 0 is not positive");
    checker(r#"{"size":-2}"#, "size: -2 is not positive");
    checker(r#"{"colorFactor":[0,-1,0]}"#, "colorFactor: negative or beyond the range of numbers");
}

#[test]
fn singular_and_textured_shapes_are_told_about() {
    let rest = r#""extensions":{"KHR_implicit_shapes":{"shapes":[{"type":"sphere"}]}},
        "images":[{"uri":"x.png"}],"textures":[{"source":0}],
        "nodes":[{"scale":[0,1,1],"extensions":{"AMBRAY_implicit_surface":{"shape":0}}}]"#;
    let Loaded { scene, warnings, .. } = load(rest);
    assert!(scene.shape_instances.is_empty());
    assert_eq!(
        warnings,
        [
            "the scene shows no triangles",
            "instances whose transform is singular or not finite are dropped (1)"
        ]
    );
}

#[test]
fn checkers_and_kinds_of_materials() {
    let rest = r#""materials":[
        {},
        {"emissiveFactor":[1,0,0]},
        {"emissiveFactor":[1,0,0],"extensions":{"AMBRAY_material_checker":{"colorFactor":[0.5,2,0],"size":0.25}}},
        {"extensions":{"KHR_materials_unlit":{},"AMBRAY_material_checker":{}}}]"#;
    let Loaded { scene, warnings, .. } = load(rest);
    let kinds: Vec<_> = scene.materials.iter().map(Material::kind).collect();
    use MaterialKind::{Checker as Checkered, Emissive, Lit, Unlit};
    assert_eq!(kinds, [Lit, Emissive, Checkered, Unlit]);
    assert_eq!(Checkered as u32, 3);
    assert_eq!(scene.materials[2].checker, Some(Checker { color: Vec3::new(0.5, 1.0, 0.0), size: 0.25 }));
    assert_eq!(scene.materials[3].checker, Some(Checker { color: Vec3::ZERO, size: 1.0 }));
    assert!(warnings.iter().any(|line| line.starts_with("base colours above 1")), "{warnings:?}");
}

#[test]
fn motion_of_instances() {
    // Node 0 turns and has a child; 3 morphs; 4 is skinned to joint 1, 5 to the unmoved 6; 7 is told to move along nothing.
    let rest = r#""meshes":[{"primitives":[{"attributes":{"POSITION":2}}]},
            {"primitives":[{"attributes":{"POSITION":2},"targets":[{"POSITION":2}]}],"weights":[0]},
            {"primitives":[{"attributes":{"POSITION":2,"JOINTS_0":3,"WEIGHTS_0":4}}]}],
        "extensions":{"KHR_implicit_shapes":{"shapes":[{"type":"sphere"}]}},
        "skins":[{"joints":[1]},{"joints":[6]}],
        "animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"rotation"}},
            {"sampler":1,"target":{"node":3,"path":"weights"}},
            {"sampler":0,"target":{"node":7,"path":"pointer"}},
            {"sampler":0,"target":{"path":"scale"}}],
            "samplers":[{"input":5,"output":6},{"input":5,"output":5}]},{}],
        "nodes":[{"mesh":0,"children":[1]},
            {"mesh":0,"extensions":{"AMBRAY_implicit_surface":{"shape":0}}},
            {"mesh":0},{"mesh":1},{"mesh":2,"skin":0},{"mesh":2,"skin":1},
            {"extensions":{"AMBRAY_implicit_surface":{"shape":0}}},{"mesh":1}]"#;
    let text = gltf(rest)
        .replace(r#""count":4,"type":"VEC3"}"#, r#""count":3,"type":"VEC3"},
            {"bufferView":1,"componentType":5121,"count":3,"type":"VEC4"},
            {"bufferView":2,"componentType":5126,"count":3,"type":"VEC4"},
            {"bufferView":0,"componentType":5126,"count":2,"type":"SCALAR"},
            {"bufferView":0,"componentType":5126,"count":2,"type":"VEC4"}"#)
        .replace(
            r#""bufferViews":[{"buffer":0,"byteLength":64}]"#,
            r#""bufferViews":[{"buffer":0,"byteLength":64},{"buffer":1,"byteLength":12},{"buffer":2,"byteLength":48}]"#,
        )
        .replace(
            r#""buffers":["#,
            &format!(
                r#""buffers":[{{"byteLength":64,"uri":"{}"}},{{"byteLength":12,"uri":"{}"}},{{"byteLength":48,"uri":"{}"}}],"unused":["#,
                uri(&(0..16).flat_map(|i: i32| ((i * i) as f32).to_le_bytes()).collect::<Vec<u8>>()),
                uri(&[0; 12]),
                uri(&(0..3).flat_map(|_| [1.0_f32, 0.0, 0.0, 0.0].map(f32::to_le_bytes).concat()).collect::<Vec<u8>>()),
            ),
        );
    let scene = load_files(&[("x.gltf", text.as_bytes())]).unwrap_or_else(|error| panic!("{error}")).scene;
    let motions: Vec<_> = scene.instances.iter().map(|i| i.motion).collect();
    use Motion::{Deforming, Rigid, Static};
    assert_eq!(motions, [Rigid, Rigid, Static, Deforming, Deforming, Static, Static]);
    let motions: Vec<_> = scene.shape_instances.iter().map(|i| i.motion).collect();
    assert_eq!(motions, [Rigid, Static]);
}

fn uri(bytes: &[u8]) -> String {
    format!(
        "data:application/octet-stream;base64,{}",
        base64::engine::general_purpose::STANDARD.encode(bytes)
    )
}

struct Random(u32);

impl Random {
    fn unit(&mut self) -> f32 {
        self.0 = pcg(self.0.wrapping_add(0x9E37_79B9));
        unit_float(self.0)
    }

    fn cube(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
    }
}

fn one_shape(shape: Shape, material: Material, world_from_object: Affine3A) -> Surfaces {
    Surfaces::new(Arc::new(Scene {
        shapes: vec![shape],
        shape_instances: vec![ShapeInstance { world_from_object, ..ShapeInstance::default() }],
        materials: vec![material],
        ..Scene::default()
    }))
}

/// The ray in the space of the only shape, and where it meets it.
fn trace(surfaces: &Surfaces, ray: &Ray) -> Option<Hit> {
    let scene = surfaces.scene();
    let object_from_world = scene.shape_instances[0].world_from_object.inverse();
    let origin = object_from_world.transform_point3(ray.origin);
    let direction = object_from_world.transform_vector3(ray.direction);
    let t = scene.shapes[0].intersect(origin, direction, ray.t_max)?;
    Some(Hit { t, u: 0.0, v: 0.0, instance: 0, triangle: 0 })
}

fn ray(origin: Vec3, direction: Vec3) -> Ray {
    Ray { origin, t_max: f32::INFINITY, direction, seed: 0 }
}

#[test]
fn points_on_placed_shapes() {
    let placement = Affine3A::from_scale_rotation_translation(
        Vec3::new(2.0, 2.0, -2.0),
        Quat::from_rotation_x(0.5),
        Vec3::new(10.0, 20.0, -30.0),
    );
    let material = Material {
        base_color: Vec4::new(0.5, 0.25, 1.0, 0.75),
        emission: Vec3::X,
        checker: Some(Checker { color: Vec3::Z, size: 100.0 }),
        ..Material::default()
    };
    let surfaces = one_shape(Shape::Sphere { radius: 0.5 }, material, placement);
    let down = ray(Vec3::new(10.0, 30.0, -30.0), Vec3::NEG_Y);
    let hit = trace(&surfaces, &down).expect("from above");
    assert!((hit.t - 9.0).abs() < 1e-5, "{}", hit.t);
    let point = surfaces.surface_at(&down, &hit, 0.0).facing(down.direction);
    assert!(point.position.abs_diff_eq(Vec3::new(10.0, 21.0, -30.0), 1e-5), "{}", point.position);
    assert!(point.geometric_normal.abs_diff_eq(Vec3::Y, 1e-5), "{}", point.geometric_normal);
    assert_eq!((point.smooth_normal, point.shading_normal), (point.geometric_normal, point.geometric_normal));
    assert_eq!((point.emission, point.material, point.unlit), (Vec3::X, 0, false));
    assert!(point.reach >= 31.0, "{}", point.reach);
    let diffuse = surfaces.diffuse_at(&down, &hit, 0.0).facing(down.direction);
    assert_eq!((diffuse.position, diffuse.reach), (point.position, point.reach));
    assert_eq!((diffuse.geometric_normal, diffuse.albedo), (point.geometric_normal, point.albedo));
    assert_eq!(surfaces.alpha(0, 0, 0.0, 0.0), 0.75);
    assert!(surfaces.accepts(0, 0, 0.0, 0.0, 9));
}

#[test]
fn checkers_follow_the_object() {
    let checker = Checker { color: Vec3::ZERO, size: 0.5 };
    let material = Material { checker: Some(checker), ..Material::default() };
    let unlit = Material { unlit: true, ..material.clone() };
    let cube = Shape::Box { half_extents: Vec3::ONE };
    let placement = Affine3A::from_scale_rotation_translation(
        Vec3::splat(4.0),
        Quat::from_rotation_y(1.0),
        Vec3::new(100.0, 0.0, 7.0),
    );
    let mut random = Random(1);
    let surfaces = one_shape(cube.clone(), material, placement);
    for _ in 0..2000 {
        // On the upper face, which lies between two layers of cubes.
        let on = Vec3::new(random.cube().x, 1.0, random.cube().x);
        let above = ray(placement.transform_point3(on) + Vec3::Y * 5.0, Vec3::NEG_Y);
        let hit = trace(&surfaces, &above).expect("from above");
        let seen = surfaces.surface_at(&above, &hit, 0.0).albedo;
        let cell = |x: f32| (2.0 * x + 1.0 / 1024.0).floor();
        let edge = |x: f32| (2.0 * x + 1.0 / 1024.0 - (2.0 * x).round()).abs() < 1e-3;
        let even = (cell(on.x) + cell(on.z) + 2.0).rem_euclid(2.0) == 0.0;
        assert!(edge(on.x) || edge(on.z) || seen == if even { Vec3::ONE } else { Vec3::ZERO }, "{on}");
    }
    let plain = one_shape(cube, unlit, Affine3A::IDENTITY);
    let above = ray(Vec3::new(0.6, 5.0, 0.1), Vec3::NEG_Y);
    assert_eq!(plain.surface_at(&above, &trace(&plain, &above).expect("hit"), 0.0).albedo, Vec3::ONE);

    // The same pattern on triangles.
    let scene = Scene {
        meshes: vec![Arc::new(Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        })],
        instances: vec![ambray_scene::Instance::default()],
        materials: vec![Material { checker: Some(checker), ..Material::default() }],
        ..Scene::default()
    };
    let surfaces = Surfaces::new(Arc::new(scene));
    let at = |u, v| {
        let hit = Hit { t: 1.0, u, v, instance: 0, triangle: 0 };
        surfaces.diffuse_at(&above, &hit, 0.0).albedo
    };
    assert_eq!((at(0.2, 0.2), at(0.7, 0.2)), (Vec3::ONE, Vec3::ZERO));
}

#[test]
fn rays_leave_convex_shapes_for_good() {
    let mut random = Random(99);
    let mut rays = 0;
    for size in [0.01_f32, 0.3, 1.0, 20.0, 1000.0] {
        let shapes = [
            Shape::Sphere { radius: size },
            Shape::Box { half_extents: Vec3::new(1.0, 0.3, 2.0) * size },
            Shape::Capsule { height: 2.0 * size, radius_bottom: 0.5 * size, radius_top: 0.5 * size },
            Shape::Capsule { height: 2.0 * size, radius_bottom: 1.0 * size, radius_top: 0.2 * size },
            Shape::Cylinder { height: 2.0 * size, radius_bottom: 0.5 * size, radius_top: 0.5 * size },
            Shape::Cylinder { height: 1.0 * size, radius_bottom: 0.2 * size, radius_top: 1.5 * size },
            Shape::Cylinder { height: 3.0 * size, radius_bottom: 1.0 * size, radius_top: 0.0 },
        ];
        for far in [0.0, 3.0, 500.0, 20_000.0] {
            for (i, shape) in shapes.iter().enumerate() {
                let rotation = Quat::from_scaled_axis(random.cube() * 3.0);
                let scale = if i % 2 == 0 { Vec3::ONE } else { Vec3::ONE * 0.4 + random.cube().abs() };
                let placement =
                    Affine3A::from_scale_rotation_translation(scale, rotation, random.cube() * far);
                // Things smaller than the rounding of their place have no surface to speak of.
                if far * 1e-5 > size {
                    continue;
                }
                rays += check_leaving(shape, placement, &mut random);
            }
        }
    }
    assert!(rays > 100_000, "{rays}");
}

/// Rays from points all over the placed shape to all sides; returns their number.
fn check_leaving(shape: &Shape, placement: Affine3A, random: &mut Random) -> u32 {
    let surfaces = one_shape(shape.clone(), Material::default(), placement);
    let (low, high) = surfaces.scene().bounds().expect("a shape");
    let (middle, extent) = (0.5 * (low + high), (high - low).max_element());
    let offset = RayOffset::for_extent(low.abs().max(high.abs()).max_element());
    let mut rays = 0;
    for _ in 0..120 {
        let from = middle + random.cube().normalize() * (2.0 * extent);
        let seen = ray(from, (low + (high - low) * (0.5 * random.cube() + 0.5) - from).normalize());
        let Some(hit) = trace(&surfaces, &seen) else { continue };
        let point = surfaces.surface_at(&seen, &hit, 0.0);
        let n = point.geometric_normal;
        assert!(n.dot(seen.direction) <= 1e-3, "{shape:?}: the outer side is seen from without");
        let origin = offset.apply(point.position, n, point.reach);
        for i in 0..20 {
            let mut direction = random.cube().normalize();
            // Some graze the surface.
            if i % 4 == 0 {
                direction = (direction - n * n.dot(direction)).normalize() + n * (1e-6 * random.unit());
            }
            if direction.as_dvec3().dot(n.as_dvec3()) < 0.0 {
                direction = -direction;
            }
            let again = trace(&surfaces, &ray(origin, direction));
            let cosine = direction.as_dvec3().dot(n.as_dvec3());
            assert!(again.is_none(), "{shape:?} {placement:?} from {origin} ({cosine:e}): {again:?}");
            rays += 1;
        }
    }
    rays
}

#[test]
fn closed_shapes_are_closed_from_within() {
    let mut random = Random(5);
    for shape in [
        Shape::Sphere { radius: 2.0 },
        Shape::Box { half_extents: Vec3::new(1.0, 2.0, 3.0) },
        Shape::Capsule { height: 2.0, radius_bottom: 1.0, radius_top: 0.4 },
        // Not tapered: where faces meet at an acute angle, the offset from one crosses the other.
        Shape::Cylinder { height: 2.0, radius_bottom: 1.0, radius_top: 1.0 },
    ] {
        let placement =
            Affine3A::from_rotation_translation(Quat::from_rotation_z(0.7), Vec3::new(3.0, 40.0, 5.0));
        let surfaces = one_shape(shape.clone(), Material::default(), placement);
        for _ in 0..5000 {
            let seen = ray(Vec3::new(3.0, 40.0, 5.0), random.cube().normalize());
            let hit = trace(&surfaces, &seen).expect("closed");
            let point = surfaces.surface_at(&seen, &hit, 0.0).facing(seen.direction);
            let left = DVec3::from(seen.origin) + DVec3::from(seen.direction) * f64::from(hit.t);
            assert!(left.distance(point.position.into()) < 1e-4);
            let origin = RayOffset::UNIT.apply(point.position, point.geometric_normal, point.reach);
            let mut direction = random.cube().normalize();
            if direction.dot(point.geometric_normal) < 0.0 {
                direction = -direction;
            }
            assert!(trace(&surfaces, &ray(origin, direction)).is_some(), "{shape:?}: {origin} {direction}");
        }
    }
}
