//! Writing the rays of a scene to files.

use std::{path::Path, sync::Arc};

use ambray::{
    BackendChoice, RendererOptions,
    cpu::rays::{FrameRays, Triangles},
    scene::surface::Surfaces,
    settings::Settings,
};
use anyhow::{anyhow, bail};

use super::{RaysFolder, SourceReport};
use crate::{
    args::BenchArgs,
    commands::{bench::opened, check_animation, control, explained, renderer},
    machine,
    progress::Progress,
    report::{self, SceneReport, ViewReport},
};

/// Memory of a ray while it is recorded, bytes: with its place, and once more with its tag.
const RAY_BYTES: u64 = 80;

/// Writes triangles and rays of `scene`, seen as `settings` say, to the `folder`.
pub(super) fn write(
    scene: &Path,
    folder: &RaysFolder,
    args: &BenchArgs,
    settings: &Settings,
    options: &RendererOptions,
) -> anyhow::Result<SourceReport> {
    if options.backend == BackendChoice::Vulkan {
        bail!("--backend vulkan is not allowed with --rays: the processor traces them");
    }
    check_memory(settings)?;
    folder.prepare()?;
    let source = opened(scene, args)?;
    check_animation(settings, &source)?;
    let scene = SceneReport::of(&source);
    let options = RendererOptions { backend: BackendChoice::Cpu, ..options.clone() };
    let mut renderer = renderer(source.scene, &options, &args.run)?;
    let progress = Progress::new("tracing", args.run.quiet);
    let view = renderer.view(settings).map_err(explained)?;
    let told = |share: f32| progress.report(share);
    let rays = renderer.record_rays(settings, control(&args.run, &told)).map_err(explained)?;
    let surfaces = Surfaces::new(Arc::new(renderer.scene().clone()));
    let (triangles, left_out) = Triangles::of(renderer.scene(), &surfaces)
        .ok_or_else(|| anyhow!("{}: more corners than a file of triangles can hold", scene.source))?;
    let triangles = match args.rays.triangles {
        Some(count) => triangles.resized(usize::try_from(count)?),
        None => triangles,
    };
    let FrameRays { primary, ambient, paper_chords, sheet_chords } = rays;
    let batches = [
        ("primary", primary),
        ("ambient", ambient),
        ("chords-paper", paper_chords),
        ("chords-sheet", sheet_chords),
    ];
    folder.write(&triangles, &batches)?;
    Ok(SourceReport {
        scene,
        view: ViewReport::of(&view),
        settings: settings.clone(),
        triangles: triangles.indices.len() as u64,
        masked_triangles: left_out.masked,
        shapes: left_out.shapes,
        rays: batches.iter().map(|(name, batch)| (*name, batch.rays.len() as u64)).collect(),
    })
}

/// Refuses pictures whose rays the free memory cannot hold.
fn check_memory(settings: &Settings) -> anyhow::Result<()> {
    let (size, spp) = (settings.size, u64::from(settings.spp));
    let rays = 1 + spp + spp * spp / 2 + spp / 2;
    let pixels = u64::from(size.width) * u64::from(size.height);
    let needed = pixels.saturating_mul(rays).saturating_mul(RAY_BYTES);
    match machine::free_memory() {
        Some(free) if needed > free => bail!(
            "--size {size} with --spp {spp} is not allowed here: all rays need up to {} of memory, and {} are free",
            report::bytes(needed),
            report::bytes(free)
        ),
        _ => Ok(()),
    }
}
