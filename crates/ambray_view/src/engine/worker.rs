//! The thread that owns the renderer.

use std::{
    sync::{Arc, mpsc},
    time::Instant,
};

use ambray::{Aov, Control, Frame, Renderer, scene};

use super::contract::{
    AnimationInfo, CameraInfo, Content, EngineOptions, Event, Level, Opened, Order, Pixels, Rendered,
};
use crate::model::{SceneRef, Side};

/// What the window asks for.
#[derive(Debug)]
pub(super) enum Request {
    Open(SceneRef),
    Show(Box<Order>),
}

/// Works until nobody asks any more.
pub(super) fn run(options: &EngineOptions, requests: &mpsc::Receiver<Request>, events: &mpsc::Sender<Event>) {
    let mut renderer = None;
    let mut done: Option<Order> = None;
    while let Ok(first) = requests.recv() {
        let mut order = None;
        for request in std::iter::once(first).chain(requests.try_iter()) {
            match request {
                Request::Open(scene) => match open(options, &scene) {
                    Ok((made, opened)) => {
                        renderer = Some(made);
                        done = None;
                        let _ = events.send(Event::Opened(Arc::new(opened)));
                    }
                    Err(error) => {
                        let message = format!("{error:#}");
                        let _ = events.send(Event::OpenFailed { scene, message });
                    }
                },
                Request::Show(latest) => order = Some(*latest),
            }
        }
        if let (Some(renderer), Some(order)) = (&mut renderer, order)
            && done.as_ref() != Some(&order)
        {
            for side in Side::ALL {
                if let Some(settings) = &order.sides[side as usize] {
                    match renderer.render(settings, Control::default()) {
                        Ok(frame) => {
                            let _ = events
                                .send(Event::Picture(Box::new(rendered(side, settings, order.aov, frame))));
                        }
                        Err(error) => {
                            let _ = events.send(Event::Refused { side, messages: vec![error.to_string()] });
                        }
                    }
                }
            }
            done = Some(order);
        }
        (options.wake.0)();
    }
}

fn open(options: &EngineOptions, scene: &SceneRef) -> anyhow::Result<(Renderer, Opened)> {
    let start = Instant::now();
    let (made, warnings) = match scene.path.to_str() {
        Some("atrium") => (scene::atrium::atrium(), Vec::new()),
        Some("banner") => (scene::moving::banner(), Vec::new()),
        Some("flock") => (scene::moving::flock(), Vec::new()),
        _ => {
            let loaded = scene::load_with(&scene.path, &scene::LoadOptions::default())?;
            (loaded.scene, loaded.warnings)
        }
    };
    let load_time = start.elapsed();
    let renderer = Renderer::open(made, &options.renderer, Control::default())?;
    let scene_info = renderer.scene();
    let named = |name: &str, i: usize| if name.is_empty() { i.to_string() } else { name.to_owned() };
    let cameras = scene_info.cameras.iter().enumerate();
    let clips = scene_info.rig.iter().flat_map(|rig| rig.clips.iter().enumerate());
    let opened = Opened {
        scene: scene.clone(),
        warnings,
        load_time,
        build: renderer.build_stats(),
        machine: renderer.machine(),
        cameras: cameras.map(|(i, camera)| CameraInfo { name: named(&camera.name, i) }).collect(),
        animations: clips
            .map(|(i, clip)| AnimationInfo { name: named(&clip.name, i), duration: clip.duration })
            .collect(),
        bounds: scene_info.bounds().unwrap_or_default(),
        is_reload: false,
    };
    Ok((renderer, opened))
}

fn rendered(side: Side, settings: &ambray::settings::Settings, aov: Aov, frame: Frame) -> Rendered {
    let linear = frame.plane(Aov::Beauty);
    let rgba = linear
        .chunks_exact(3)
        .flat_map(|c| [c[0], c[1], c[2], 1.0])
        .map(|v| (v.min(1.0).sqrt() * 255.0) as u8);
    let pixels = Arc::new(Pixels { width: frame.width, height: frame.height, rgba: rgba.collect() });
    Rendered {
        side,
        settings: settings.clone(),
        aov,
        view: frame.view.clone(),
        level: Level { scale: 1.0, spp: settings.spp, is_final: true },
        frames: 1,
        stats: frame.stats,
        content: Content::Host { frame: Arc::new(frame), pixels },
        statistics: None,
    }
}
