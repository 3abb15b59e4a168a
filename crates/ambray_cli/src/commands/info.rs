//! `ambray info`: what is in a scene, or what program and machine this is.

use std::fmt::Write as _;

use ambray::{
    Control, Renderer,
    camera::Projection,
    light::Light,
    scene::{AlphaMode, Material, MaterialKind, Scene},
    settings::Settings,
    shape::Shape,
};
use anyhow::bail;
use glam::Vec3;
use serde::Serialize;

use super::movement::Movement;
use crate::{
    args::InfoArgs,
    failure::with_hint,
    machine::Machine,
    report::{
        self, AccelerationReport, BackendReport, BuildReport, SceneReport, ViewReport, bytes, grouped, triple,
    },
    scene_source, terminal,
};

/// Names listed in the text; JSON has them all.
const MOST_LISTED: usize = 32;

/// Tells about a scene, the devices or the program.
pub fn run(args: &InfoArgs) -> anyhow::Result<()> {
    check(args)?;
    if args.devices {
        return super::devices::run(args.json);
    }
    let Some(path) = &args.scene else { return about_program(args.json) };
    let source = scene_source::open(path, args.gltf_scene.as_deref())?;
    let scene = SceneReport::of(&source);
    let (contents, movement) = (Contents::of(&source.scene), Movement::of(&source.scene));
    let mut renderer = if args.acceleration {
        let options = args.device.options(args.grouping.grouping);
        Renderer::open(source.scene, &options, Control::default()).map_err(super::explained)?
    } else {
        Renderer::new(source.scene)
    };
    let view = renderer.view(&Settings::default()).map_err(super::explained)?;
    let info = SceneInfo {
        scene,
        build: BuildReport::of(&renderer.build_stats()),
        backend: BackendReport::of(&renderer),
        acceleration: renderer.acceleration_stats().as_ref().map(AccelerationReport::of),
        contents,
        movement,
        default_view: ViewReport::of(&view),
    };
    terminal::print(&if args.json { report::json(&info)? } else { info.text() })
}

/// Refuses options that do not go together.
fn check(args: &InfoArgs) -> anyhow::Result<()> {
    if args.devices && (args.scene.is_some() || args.acceleration) {
        bail!("--devices is not allowed with SCENE or --acceleration: it tells about this machine");
    }
    if args.acceleration && args.scene.is_none() {
        let error = anyhow::anyhow!("--acceleration needs a SCENE");
        return Err(with_hint(error, "for a built-in scene: ambray info atrium --acceleration"));
    }
    match args.device.asked(args.grouping.grouping) {
        Some(option) if !args.acceleration => {
            bail!("{option} is not allowed without --acceleration: nothing else of info needs a device")
        }
        _ => Ok(()),
    }
}

fn about_program(as_json: bool) -> anyhow::Result<()> {
    let machine = Machine::detect();
    if as_json {
        return terminal::print(&report::json(&machine)?);
    }
    let Machine { version, commit, optimized, cpu, cores, isa, os, architecture } = &machine;
    let build = if *optimized { "release build" } else { "debug build" };
    let commit = commit.map(|commit| format!(", commit {commit}")).unwrap_or_default();
    let cpu = cpu.as_deref().unwrap_or("unknown processor");
    terminal::print(&format!(
        "ambray {version} ({build}{commit})\n{cpu}, {cores} threads, kernels for {isa}\n{os} on {architecture}\n"
    ))
}

#[derive(Debug, Serialize)]
struct SceneInfo {
    scene: SceneReport,
    build: BuildReport,
    /// Who made the scene ready.
    backend: BackendReport,
    /// With `--acceleration`, else null.
    acceleration: Option<AccelerationReport>,
    #[serde(flatten)]
    contents: Contents,
    #[serde(flatten)]
    movement: Movement,
    /// What a frame with default settings would use.
    default_view: ViewReport,
}

#[derive(Debug, Serialize)]
struct Contents {
    bounds: Option<Bounds>,
    meshes: Vec<MeshInfo>,
    shapes: Vec<ShapeInfo>,
    materials: Vec<MaterialInfo>,
    images: Vec<ImageInfo>,
    lights: Vec<LightInfo>,
    cameras: Vec<CameraInfo>,
    /// Radius and ambient radiance that the scene itself asks for.
    asked_radius: Option<f32>,
    asked_ambient: Option<[f32; 3]>,
}

#[derive(Debug, Serialize)]
struct Bounds {
    low: [f32; 3],
    high: [f32; 3],
}

#[derive(Debug, Serialize)]
struct MeshInfo {
    name: String,
    triangles: usize,
    vertices: usize,
    uv_sets: usize,
    material: u32,
    instances: usize,
}

#[derive(Debug, Serialize)]
struct ShapeInfo {
    kind: &'static str,
    /// Size of its box, object units.
    size: [f32; 3],
    instances: usize,
}

#[derive(Debug, Serialize)]
struct MaterialInfo {
    name: String,
    kind: &'static str,
    alpha_mode: &'static str,
    alpha_cutoff: Option<f32>,
    base_color: [f32; 4],
    textures: Vec<&'static str>,
    is_emissive: bool,
    unlit: bool,
    double_sided: bool,
}

#[derive(Debug, Serialize)]
struct ImageInfo {
    name: String,
    width: u32,
    height: u32,
    srgb: bool,
}

#[derive(Debug, Serialize)]
struct LightInfo {
    kind: &'static str,
    /// Irradiance of directional lights, intensity of the others; linear RGB.
    strength: [f32; 3],
    position: Option<[f32; 3]>,
    /// Towards directional lights, along the axis of spot lights.
    direction: Option<[f32; 3]>,
}

#[derive(Debug, Serialize)]
struct CameraInfo {
    name: String,
    position: [f32; 3],
    forward: [f32; 3],
    vertical_fov_degrees: Option<f32>,
    orthographic_height: Option<f32>,
}

impl Contents {
    fn of(scene: &Scene) -> Self {
        let mut instances = vec![0; scene.meshes.len()];
        for instance in &scene.instances {
            instances[instance.mesh as usize] += 1;
        }
        let meshes = scene.meshes.iter().zip(instances).map(|(mesh, instances)| MeshInfo {
            name: mesh.name.clone(),
            triangles: mesh.triangles.len(),
            vertices: mesh.positions.len(),
            uv_sets: mesh.uvs.len(),
            material: mesh.material,
            instances,
        });
        let images = scene.images.iter().map(|image| ImageInfo {
            name: image.name.clone(),
            width: image.levels.first().map_or(0, |level| level.width),
            height: image.levels.first().map_or(0, |level| level.height),
            srgb: image.srgb,
        });
        let cameras = scene.cameras.iter().map(|camera| {
            let (fov, height) = match camera.projection {
                Projection::Perspective { vertical_fov } => (Some(vertical_fov.to_degrees()), None),
                Projection::Orthographic { height } => (None, Some(height)),
            };
            CameraInfo {
                name: camera.name.clone(),
                position: camera.position.to_array(),
                forward: camera.forward.to_array(),
                vertical_fov_degrees: fov,
                orthographic_height: height,
            }
        });
        Self {
            bounds: scene.bounds().map(|(low, high)| Bounds { low: low.to_array(), high: high.to_array() }),
            meshes: meshes.collect(),
            shapes: shapes(scene),
            materials: scene.materials.iter().map(material).collect(),
            images: images.collect(),
            lights: scene.lights.iter().map(light).collect(),
            cameras: cameras.collect(),
            asked_radius: scene.radius,
            asked_ambient: scene.ambient.map(|ambient| ambient.to_array()),
        }
    }
}

fn shapes(scene: &Scene) -> Vec<ShapeInfo> {
    let mut instances = vec![0; scene.shapes.len()];
    for instance in &scene.shape_instances {
        instances[instance.shape as usize] += 1;
    }
    let info = |(shape, instances): (&Shape, usize)| {
        let (low, high) = shape.bounds();
        let kind = match shape {
            Shape::Sphere { .. } => "sphere",
            Shape::Box { .. } => "box",
            Shape::Capsule { .. } => "capsule",
            Shape::Cylinder { .. } => "cylinder",
            Shape::Field(_) => "field",
        };
        ShapeInfo { kind, size: (high - low).to_array(), instances }
    };
    scene.shapes.iter().zip(instances).map(info).collect()
}

fn material(material: &Material) -> MaterialInfo {
    let (alpha_mode, alpha_cutoff) = match material.alpha_mode {
        AlphaMode::Opaque => ("opaque", None),
        AlphaMode::Mask(cutoff) => ("mask", Some(cutoff)),
        AlphaMode::Blend => ("blend", None),
    };
    let textures = [
        ("base-color", material.base_color_texture.is_some()),
        ("normal", material.normal_texture.is_some()),
        ("emission", material.emission_texture.is_some()),
    ];
    let kind = match material.kind() {
        MaterialKind::Lit => "lit",
        MaterialKind::Unlit => "unlit",
        MaterialKind::Emissive => "emissive",
        MaterialKind::Checker => "checker",
    };
    MaterialInfo {
        name: material.name.clone(),
        kind,
        alpha_mode,
        alpha_cutoff,
        base_color: material.base_color.to_array(),
        textures: textures.into_iter().filter_map(|(name, present)| present.then_some(name)).collect(),
        is_emissive: material.emission != Vec3::ZERO,
        unlit: material.unlit,
        double_sided: material.double_sided,
    }
}

fn light(light: &Light) -> LightInfo {
    match light {
        Light::Directional { to_light, irradiance } => LightInfo {
            kind: "directional",
            strength: irradiance.to_array(),
            position: None,
            direction: Some(to_light.to_array()),
        },
        Light::Point { position, intensity, cone, .. } => LightInfo {
            kind: if cone.is_some() { "spot" } else { "point" },
            strength: intensity.to_array(),
            position: Some(position.to_array()),
            direction: cone.map(|cone| cone.axis.to_array()),
        },
    }
}

impl SceneInfo {
    fn text(&self) -> String {
        let Contents { bounds, meshes, shapes, materials, images, lights, cameras, .. } = &self.contents;
        let mut text = report::scene_line(&self.scene, &self.build);
        if let Some(acceleration) = &self.acceleration {
            text.push_str(&self.backend.line());
            text.push_str(&acceleration.text());
        }
        let mut line = |name: &str, rest: String| {
            let _ = writeln!(text, "{name:<9}{rest}"); // writing to a string cannot fail
        };
        if let Some(Bounds { low, high }) = bounds {
            line("bounds", format!("{} to {}", triple(*low), triple(*high)));
        }
        let view = &self.default_view;
        line("radius", format!("{} (auto)", report::length(view.radius)));
        line("ambient", format!("{} (auto)", triple(view.ambient)));
        line("view", format!("{} (auto)", view.camera.origin));

        line("meshes", grouped(meshes.len() as u64));
        let shared = |mesh: &MeshInfo| match mesh.instances {
            1 => String::new(),
            count => format!(" x {count} instances"),
        };
        let mesh = |mesh: &MeshInfo| {
            let triangles = grouped(mesh.triangles as u64);
            format!("{}: {triangles} triangles{}", named(&mesh.name), shared(mesh))
        };
        entries(meshes, mesh).for_each(|entry| line("", entry));
        if !shapes.is_empty() {
            line("shapes", grouped(shapes.len() as u64));
            let shape = |shape: &ShapeInfo| {
                let count = if shape.instances == 1 {
                    String::new()
                } else {
                    format!(" x {} instances", shape.instances)
                };
                format!("{}: size {}{count}", shape.kind, triple(shape.size))
            };
            entries(shapes, shape).for_each(|entry| line("", entry));
        }
        line("materials", format!(" {}", materials.len()));
        entries(materials, material_line).for_each(|entry| line("", entry));
        let texels: u64 = images.iter().map(|i| u64::from(i.width) * u64::from(i.height)).sum();
        line("images", format!("{}, {} of texels", images.len(), bytes(texels * 4)));
        let image = |image: &ImageInfo| format!("{}: {}x{}", named(&image.name), image.width, image.height);
        entries(images, image).for_each(|entry| line("", entry));
        line("lights", lights.len().to_string());
        let light = |light: &LightInfo| format!("{}: {}", light.kind, triple(light.strength));
        entries(lights, light).for_each(|entry| line("", entry));
        line("cameras", cameras.len().to_string());
        let numbered: Vec<_> = cameras.iter().enumerate().collect();
        let camera = |(number, camera): &(usize, &CameraInfo)| {
            format!("{number} {}: at {}", named(&camera.name), triple(camera.position))
        };
        entries(&numbered, camera).for_each(|entry| line("", entry));
        self.movement.lines().into_iter().for_each(|(name, rest)| line(name, rest));
        text
    }
}

/// One line for each of the `items`, the last for those left out.
pub(super) fn entries<'a, T>(
    items: &'a [T],
    entry: impl Fn(&T) -> String + 'a,
) -> impl Iterator<Item = String> + 'a {
    let left_out = items.len().saturating_sub(MOST_LISTED);
    let more = (left_out > 0).then(|| format!("  and {left_out} more (--json lists all)"));
    items.iter().take(MOST_LISTED).map(move |item| format!("  {}", entry(item))).chain(more)
}

/// A name that may be empty or hold anything, on a line.
pub(super) fn named(name: &str) -> String {
    if name.is_empty() { "(unnamed)".to_owned() } else { name.escape_debug().to_string() }
}

fn material_line(material: &MaterialInfo) -> String {
    let mut words = vec![material.alpha_mode];
    words.extend(material.is_emissive.then_some("emissive"));
    words.extend(material.unlit.then_some("unlit"));
    words.extend((material.kind == "checker").then_some("checker"));
    words.extend(material.double_sided.then_some("double-sided"));
    let textures = match material.textures.as_slice() {
        [] => String::new(),
        textures => format!("; textures: {}", textures.join(", ")),
    };
    format!("{}: {}{textures}", named(&material.name), words.join(", "))
}
