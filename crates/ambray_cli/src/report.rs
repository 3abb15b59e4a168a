//! What was done, as text for people and as JSON for programs. Keys carry their unit; they are never renamed.

mod acceleration;
mod backend;
mod sequence;
mod spread;

use std::{fmt::Write as _, time::Duration};

use ambray::{
    BuildStats, Frame, RayCounts, Renderer, StageTimes, View, camera::Projection, scene::Scene,
    settings::Settings,
};
use serde::Serialize;

pub use self::{
    acceleration::AccelerationReport,
    backend::BackendReport,
    sequence::{FrameReport, SequenceReport, Tally},
    spread::{Spread, quantile},
};
use crate::scene_source::Source;

/// Milliseconds to a thousandth.
#[must_use]
pub fn milliseconds(time: Duration) -> f64 {
    (time.as_secs_f64() * 1e6).round() / 1e3
}

/// A count with its thousands set apart.
#[must_use]
pub fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// A size in memory.
#[must_use]
pub fn bytes(count: u64) -> String {
    match count {
        0..10_000 => format!("{count} B"),
        10_000..1_000_000 => format!("{:.1} kB", count as f64 * 1e-3),
        1_000_000..1_000_000_000 => format!("{:.1} MB", count as f64 * 1e-6),
        _ => format!("{:.1} GB", count as f64 * 1e-9),
    }
}

/// A length to five significant digits; the JSON report has all of them.
#[must_use]
pub fn length(value: f32) -> String {
    format!("{value:.4e}").parse::<f32>().unwrap_or(value).to_string()
}

/// Rays a second, in millions where there are many.
#[must_use]
pub fn rate(rays: u64, time: Duration) -> String {
    let rate = rays as f64 / time.as_secs_f64().max(1e-9);
    if rate < 1e5 {
        format!("{} rays", grouped(rate as u64))
    } else {
        format!("{:.1} million rays", rate * 1e-6)
    }
}

/// A count and what is counted, in the singular or the plural.
#[must_use]
pub fn counted(count: u64, thing: &str) -> String {
    format!("{} {thing}{}", grouped(count), if count == 1 { "" } else { "s" })
}

/// The scene in numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneReport {
    /// Name of the scene.
    pub name: String,
    /// Path of the file, or `atrium`.
    pub source: String,
    /// Triangles, instances counted each time.
    pub triangles: u64,
    /// Placed meshes.
    pub instances: u64,
    /// Placed shapes.
    pub shape_instances: u64,
    /// Distinct meshes.
    pub meshes: usize,
    /// Distinct shapes.
    pub shapes: usize,
    /// Materials.
    pub materials: usize,
    /// Images.
    pub images: usize,
    /// Lights of the scene.
    pub lights: usize,
    /// Cameras of the scene.
    pub cameras: usize,
    /// What the loader had to say.
    pub warnings: Vec<String>,
    /// Time to read the file and decode its textures.
    pub load_ms: f64,
}

impl SceneReport {
    /// Counts what is in `source`.
    #[must_use]
    pub fn of(source: &Source) -> Self {
        let scene: &Scene = &source.scene;
        Self {
            name: scene.name.clone(),
            source: source.path.clone(),
            triangles: scene.triangle_count(),
            instances: scene.instances.len() as u64,
            shape_instances: scene.shape_instances.len() as u64,
            meshes: scene.meshes.len(),
            shapes: scene.shapes.len(),
            materials: scene.materials.len(),
            images: scene.images.len(),
            lights: scene.lights.len(),
            cameras: scene.cameras.len(),
            warnings: source.warnings.clone(),
            load_ms: milliseconds(source.load_time),
        }
    }
}

/// The acceleration structures in numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BuildReport {
    /// Time to build them.
    pub build_ms: f64,
    /// Their memory.
    pub acceleration_bytes: u64,
}

impl BuildReport {
    /// From the renderer's numbers.
    #[must_use]
    pub fn of(stats: &BuildStats) -> Self {
        Self { build_ms: milliseconds(stats.build_time), acceleration_bytes: stats.acceleration_bytes }
    }
}

/// The camera of a frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CameraReport {
    /// Where it came from, in words.
    pub origin: String,
    /// Eye point, world space.
    pub position: [f32; 3],
    /// Unit viewing direction.
    pub forward: [f32; 3],
    /// Unit vector to the right in the picture.
    pub right: [f32; 3],
    /// Unit vector up in the picture.
    pub up: [f32; 3],
    /// Full vertical angle of view, of a perspective camera.
    pub vertical_fov_degrees: Option<f32>,
    /// Height of the view in scene units, of an orthographic camera.
    pub orthographic_height: Option<f32>,
}

impl CameraReport {
    /// The camera of `view`.
    #[must_use]
    pub fn of(view: &View) -> Self {
        let camera = &view.camera;
        let (fov, height) = match camera.projection() {
            Projection::Perspective { vertical_fov } => (Some(vertical_fov.to_degrees()), None),
            Projection::Orthographic { height } => (None, Some(height)),
        };
        Self {
            origin: view.camera_origin.clone(),
            position: camera.position().to_array(),
            forward: camera.forward().to_array(),
            right: camera.right().to_array(),
            up: camera.up().to_array(),
            vertical_fov_degrees: fov,
            orthographic_height: height,
        }
    }
}

/// Everything that was chosen for a frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ViewReport {
    /// The camera.
    pub camera: CameraReport,
    /// Near-field radius R, scene units.
    pub radius: f32,
    /// Ambient radiance, linear RGB.
    pub ambient: [f32; 3],
    /// Colour where nothing is seen, linear RGB.
    pub background: [f32; 3],
    /// Lights that shine.
    pub lights: usize,
}

impl ViewReport {
    /// What `view` holds.
    #[must_use]
    pub fn of(view: &View) -> Self {
        Self {
            camera: CameraReport::of(view),
            radius: view.radius,
            ambient: view.ambient.to_array(),
            background: view.background.to_array(),
            lights: view.lights.len(),
        }
    }
}

/// Time of the stages: on the processor wall time, on a device as its own clock has it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct StageReport {
    /// Primary rays and surface attributes.
    pub primary_ms: f64,
    /// Direct light with its shadow rays.
    pub direct_ms: f64,
    /// Ambient rays of both batches.
    pub ambient_ms: f64,
    /// Filter and composition.
    pub filter_ms: f64,
    /// Bending the vertices of what deforms.
    pub deformation_ms: f64,
    /// Refitting or rebuilding bottom-level structures of what deforms.
    pub bottom_level_ms: f64,
    /// Building the top-level structure.
    pub top_level_ms: f64,
    /// Copying the frame from a device, wall time.
    pub transfer_ms: f64,
    /// Tracing rays, part of the stages above; 0 on a device.
    pub tracing_ms: f64,
    /// Wall time of the passes that a thread spent outside their stages, mean over the threads; 0 on a device.
    pub idle_ms: f64,
    /// The whole frame, wall time. The first frame of a device compiles its programs.
    pub total_ms: f64,
}

impl StageReport {
    /// From the renderer's times.
    #[must_use]
    pub fn of(times: &StageTimes) -> Self {
        Self {
            primary_ms: milliseconds(times.primary),
            direct_ms: milliseconds(times.direct),
            ambient_ms: milliseconds(times.ambient),
            filter_ms: milliseconds(times.filter),
            deformation_ms: milliseconds(times.deformation),
            bottom_level_ms: milliseconds(times.bottom_level),
            top_level_ms: milliseconds(times.top_level),
            transfer_ms: milliseconds(times.transfer),
            tracing_ms: milliseconds(times.tracing),
            idle_ms: milliseconds(times.idle),
            total_ms: milliseconds(times.total),
        }
    }
}

/// Rays of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RayReport {
    /// By type.
    #[serde(flatten)]
    pub by_type: RayCounts,
    /// Of all types.
    pub total: u64,
    /// Rays of all types per second of the whole frame, millions.
    pub mrays_per_s: f64,
}

impl RayReport {
    /// `rays` traced in `time`.
    #[must_use]
    pub fn of(rays: RayCounts, time: Duration) -> Self {
        let rate = rays.total() as f64 * 1e-6 / time.as_secs_f64().max(1e-9);
        Self { by_type: rays, total: rays.total(), mrays_per_s: (rate * 1e3).round() / 1e3 }
    }
}

/// The report of `ambray render`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RenderReport {
    /// Version of ambray.
    pub version: &'static str,
    /// The scene.
    pub scene: SceneReport,
    /// The acceleration structures.
    pub build: BuildReport,
    /// Who rendered.
    pub backend: BackendReport,
    /// What was chosen for the frame.
    pub view: ViewReport,
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Ambient rays per pixel.
    pub spp: u32,
    /// Threads used; 0 on a device.
    pub threads: usize,
    /// Time of the frame.
    pub times: StageReport,
    /// Rays of the frame.
    pub rays: RayReport,
    /// Time to encode and write the files.
    pub write_ms: f64,
    /// Files written, the picture first.
    pub outputs: Vec<String>,
    /// All settings.
    pub settings: Settings,
}

impl RenderReport {
    /// About a `frame` that `renderer` made.
    #[must_use]
    pub fn of(
        scene: SceneReport,
        renderer: &Renderer,
        settings: &Settings,
        frame: &Frame,
        write_time: Duration,
        outputs: Vec<String>,
    ) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION"),
            scene,
            build: BuildReport::of(&renderer.build_stats()),
            backend: BackendReport::with(renderer, settings),
            view: ViewReport::of(&frame.view),
            width: frame.width,
            height: frame.height,
            spp: settings.spp,
            threads: frame.stats.threads,
            times: StageReport::of(&frame.stats.times),
            rays: RayReport::of(frame.stats.rays, frame.stats.times.total),
            write_ms: milliseconds(write_time),
            outputs,
            settings: settings.clone(),
        }
    }

    /// For people.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = scene_line(&self.scene, &self.build);
        text.push_str(&self.backend.line());
        let Self { view, times, rays, .. } = self;
        let threads = match self.threads {
            0 => String::new(),
            threads => format!(", {}", counted(threads as u64, "thread")),
        };
        let _ = writeln!(text, "view     {}", camera_line(&view.camera)); // writing to a string cannot fail
        let _ = writeln!(
            text,
            "frame    {}x{}, {} rays/pixel, radius {}{threads}",
            self.width,
            self.height,
            self.spp,
            length(view.radius)
        );
        let _ = writeln!(text, "time     {}", times_line(times));
        let _ = writeln!(text, "rays     {}", rays_line(rays));
        let _ = writeln!(text, "wrote    {} ({:.0} ms)", self.outputs.join(", "), self.write_ms);
        text
    }
}

/// Scene and acceleration structures in a line.
#[must_use]
pub fn scene_line(scene: &SceneReport, build: &BuildReport) -> String {
    let shapes = match scene.shape_instances {
        0 => String::new(),
        count => format!(", {}", counted(count, "shape")),
    };
    format!(
        "scene    {}: {}, {}{shapes}; loaded in {:.0} ms, built in {:.0} ms, {}\n",
        scene.source,
        counted(scene.triangles, "triangle"),
        counted(scene.instances, "instance"),
        scene.load_ms,
        build.build_ms,
        bytes(build.acceleration_bytes),
    )
}

/// A point or colour, rounded to thousandths.
#[must_use]
pub fn triple(v: [f32; 3]) -> String {
    v.map(|x| ((f64::from(x) * 1e3).round() / 1e3 + 0.0).to_string()).join(",")
}

fn camera_line(camera: &CameraReport) -> String {
    let projection = match (camera.vertical_fov_degrees, camera.orthographic_height) {
        (Some(degrees), _) => format!("{degrees:.1}° upright"),
        (None, height) => format!("orthographic, height {}", height.unwrap_or_default()),
    };
    let (position, forward) = (triple(camera.position), triple(camera.forward));
    format!("{}: at {position}, looking along {forward}, {projection}", camera.origin)
}

/// Times of the stages in a line; those of motion and transfer, and what part is tracing, only where they are something.
#[must_use]
pub fn times_line(times: &StageReport) -> String {
    let stages = [
        ("primary", times.primary_ms, true),
        ("direct", times.direct_ms, true),
        ("ambient", times.ambient_ms, true),
        ("filter", times.filter_ms, true),
        ("deformation", times.deformation_ms, false),
        ("bottom level", times.bottom_level_ms, false),
        ("top level", times.top_level_ms, false),
        ("transfer", times.transfer_ms, false),
    ];
    let told = stages.into_iter().filter(|&(_, ms, always)| always || ms > 0.0);
    let told: Vec<_> = told.map(|(name, ms, _)| format!("{name} {}", short(ms))).collect();
    let mut line = format!("{} ms: {}", short(times.total_ms), told.join(", "));
    if times.tracing_ms > 0.0 {
        let share = |ms: f64| 100.0 * ms / times.total_ms.max(f64::MIN_POSITIVE);
        let (tracing, idle) = (share(times.tracing_ms), share(times.idle_ms));
        let _ = write!(line, "; tracing {tracing:.0} %, threads idle {idle:.0} %");
    }
    line
}

/// Milliseconds, with hundredths where they are few.
#[must_use]
pub fn short(ms: f64) -> String {
    if ms < 10.0 { format!("{ms:.2}") } else { format!("{ms:.1}") }
}

/// Rays by type in a line.
#[must_use]
pub fn rays_line(rays: &RayReport) -> String {
    let RayCounts { primary, ambient, chord, shadow } = rays.by_type;
    format!(
        "{}: primary {}, ambient {}, chord {}, shadow {}; {:.1} million a second",
        grouped(rays.total),
        grouped(primary),
        grouped(ambient),
        grouped(chord),
        grouped(shadow),
        rays.mrays_per_s
    )
}

/// `report` as JSON over several lines, with a newline.
pub fn json(report: &impl Serialize) -> anyhow::Result<String> {
    Ok(serde_json::to_string_pretty(report)? + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_readable() {
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(999), "999");
        assert_eq!(grouped(1_234_567), "1 234 567");
        assert_eq!(bytes(27_000_000), "27.0 MB");
        assert_eq!([192_700, 4_473_300, 1_500_000_000].map(bytes), ["192.7 kB", "4.5 MB", "1.5 GB"]);
        assert_eq!([54.880_005, 0.036_658_335, 1.0, 1e7].map(length), ["54.88", "0.036658", "1", "10000000"]);
        assert_eq!([1, 2].map(|n| counted(n, "triangle")), ["1 triangle", "2 triangles"]);
        assert_eq!(rate(16, Duration::from_millis(5)), "3 200 rays");
        assert_eq!(rate(4_600_000, Duration::from_secs(2)), "2.3 million rays");
        assert_eq!(triple([-0.0, 3.688, -0.815_000_06]), "0,3.688,-0.815");
        assert_eq!([0.234, 9.99, 12.34].map(short), ["0.23", "9.99", "12.3"]);
        assert_eq!(milliseconds(Duration::from_nanos(1_234_567)), 1.235);
    }
}
