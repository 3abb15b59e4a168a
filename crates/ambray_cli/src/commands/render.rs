//! `ambray render`: a scene in, pictures out.

use std::time::Instant;

use anyhow::bail;

use super::{check_memory, control, explained, renderer};
use crate::{
    args::{Grouping, RenderArgs},
    output::{
        Plan,
        atomic::{Batch, Target},
    },
    progress::Progress,
    report::{self, RenderReport, SceneReport},
    scene_source, settings_file, signals, terminal,
};

/// Renders a scene.
pub fn run(args: &RenderArgs) -> anyhow::Result<()> {
    let settings = settings_file::resolve(&args.settings)?;
    let options = args.backend.options(Grouping::Auto)?;
    let plan = Plan::new(args.output.as_deref(), args.format, &args.aov)?;
    if args.json && plan.main == Target::Stdout {
        bail!("--json is not allowed with -o -: both write to stdout");
    }
    let saved = args.settings.save_settings.as_deref().map(Target::of);
    if args.json && saved == Some(Target::Stdout) {
        bail!("--json is not allowed with --save-settings -: both write to stdout");
    }
    check_saved(saved.as_ref(), &plan)?;
    check_memory(settings.size, plan.bytes_per_pixel())?;

    let source = scene_source::open(&args.scene.scene, args.scene.gltf_scene.as_deref())?;
    let scene = SceneReport::of(&source);
    let mut renderer = renderer(source.scene, &options, &args.run)?;
    let graceful = signals::Graceful::begin();
    let progress = Progress::new("rendering", args.run.quiet);
    let report_share = |share| progress.report(share);
    let frame = renderer.render(&settings, control(&args.run, &report_share)).map_err(explained)?;
    drop(progress);

    let start = Instant::now();
    let mut batch = Batch::default();
    plan.write(&frame, &settings, &scene.source, &mut batch)?;
    if let Some(target) = &saved {
        let toml = settings_file::write(&settings);
        batch.add(target, |out| Ok(out.write_all(toml.as_bytes())?))?;
    }
    signals::check()?;
    batch.commit()?;
    drop(graceful);

    let mut outputs: Vec<_> = plan.files().iter().map(|(target, _)| target.name()).collect();
    outputs.extend(saved.iter().map(Target::name));
    let report = RenderReport::of(scene, &renderer, &settings, &frame, start.elapsed(), outputs);
    if args.json {
        terminal::print(&report::json(&report)?)
    } else if args.run.quiet {
        Ok(())
    } else if plan.main == Target::Stdout || saved == Some(Target::Stdout) {
        terminal::say(report.text().trim_end());
        Ok(())
    } else {
        terminal::print(&report.text())
    }
}

fn check_saved(saved: Option<&Target>, plan: &Plan) -> anyhow::Result<()> {
    let Some(saved) = saved else { return Ok(()) };
    if plan.files().iter().any(|(target, _)| target == saved) {
        bail!("--save-settings {}: the picture goes there", saved.name());
    }
    saved.check()
}
