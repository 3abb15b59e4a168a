//! What is to be done for one side, and how far it is.

use ambray::settings::{Method, Settings, Temporal};

use super::{levels, rate::Rate};
use crate::engine::contract::Level;

/// Most frames of a view that stands still.
pub const MOST_FRAMES: u32 = 256;

/// What of `settings` decides a frame; the rest decides how it is shown.
pub(in crate::engine) fn frame_settings(settings: &Settings) -> Settings {
    let any = Settings::default();
    Settings {
        exposure: any.exposure,
        tone_map: any.tone_map,
        ramp: any.ramp,
        range: any.range,
        ..settings.clone()
    }
}

/// Whether two settings are the same, NaN among them, which no picture can be made of.
pub(in crate::engine) fn is_same(a: &Settings, b: &Settings) -> bool {
    a == b || format!("{a:?}") == format!("{b:?}")
}

/// A picture to be made, and how far it is.
#[derive(Clone, Debug)]
pub(super) struct Work {
    /// What of the settings decides the frame.
    pub(super) settings: Settings,
    /// The levels that are still to be rendered, the next one first.
    pub(super) left: Vec<Level>,
    /// The finest level that there is.
    pub(super) shown: Option<Level>,
    /// Frames whose mean the last picture is, where light accumulates.
    pub(super) frames: u32,
    /// Whether nothing can be rendered with these settings.
    pub(super) is_refused: bool,
}

impl Work {
    pub(super) fn new(settings: Settings) -> Self {
        Self { settings, left: Vec::new(), shown: None, frames: 0, is_refused: false }
    }

    /// Rays a pixel that are asked for; 0 where the method looks at the depth buffer alone, so that they change nothing.
    pub(super) fn spp(&self) -> u32 {
        let method = self.settings.method;
        if method.is_screen_space() && method != Method::Hybrid { 0 } else { self.settings.spp }
    }

    /// The settings of a picture at `level`.
    pub(super) fn settings_at(&self, level: &Level) -> Settings {
        let spp = if level.spp > 0 { level.spp } else { self.settings.spp };
        Settings { size: levels::scaled(self.settings.size, level.scale), spp, ..self.settings.clone() }
    }

    /// Whether light accumulates over frames.
    pub(super) fn accumulates(&self) -> bool {
        self.settings.temporal == Temporal::On
    }

    /// Plans what is left to be done, from a picture that takes at most `quick` seconds; only that if something `is_moving`.
    pub(super) fn plan(&mut self, rate: Rate, quick: f64, is_moving: bool) {
        let mut levels = levels::plan(self.settings.size, self.spp(), rate, quick);
        if is_moving {
            levels.truncate(1);
        }
        if let Some(shown) = &self.shown {
            // While something moves, any picture will do.
            levels.retain(|level| !is_moving && is_finer(level, shown));
        }
        self.left = levels;
    }

    /// Whether more frames are to be accumulated.
    pub(super) fn goes_on(&self) -> bool {
        let is_complete = self.shown.is_some_and(|level| level.is_final);
        self.left.is_empty() && is_complete && self.accumulates() && self.frames < MOST_FRAMES
    }
}

fn is_finer(a: &Level, b: &Level) -> bool {
    (a.is_final, a.scale, a.spp) > (b.is_final, b.scale, b.spp)
}
