//! What the engine has delivered so far.

use std::{collections::VecDeque, sync::Arc};

use ambray::FrameStats;

use crate::{
    engine::{Content, Difference, Event, Inspected, Level, Opened, Rendered},
    model::SceneRef,
};

/// How bad news is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Something was done.
    Done,
    /// Something to know.
    Warning,
    /// Something failed.
    Error,
}

/// A message for the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Notice {
    /// How bad it is.
    pub severity: Severity,
    /// One line.
    pub text: String,
    /// When it was first seen, seconds of the window's clock.
    pub since: Option<f64>,
}

/// What a picture took.
#[derive(Clone, Copy, Debug)]
pub struct Timing {
    /// Times and rays.
    pub stats: FrameStats,
    /// How far it was refined.
    pub level: Level,
}

/// Pictures whose times are kept.
pub const TIMINGS: usize = 240;

/// A scene on its way.
#[derive(Clone, Debug, PartialEq)]
pub struct Loading {
    /// Which.
    pub scene: SceneRef,
    /// What is being done, in words.
    pub stage: &'static str,
    /// Share that is done, where it is known.
    pub share: Option<f32>,
}

/// What the engine has delivered.
#[derive(Clone, Debug, Default)]
pub struct Shown {
    /// The scene that the pictures show.
    pub opened: Option<Arc<Opened>>,
    /// The scene on its way.
    pub loading: Option<Loading>,
    /// The newest picture of each side.
    pub sides: [Option<Rendered>; 2],
    /// Whether the picture of a side still shows the scene that was open before.
    pub is_stale: [bool; 2],
    /// Both compared.
    pub difference: Option<Difference>,
    /// What the pixel did that was asked for last.
    pub inspected: Option<Arc<Inspected>>,
    /// Share of the picture under way, of each side.
    pub progress: [Option<f32>; 2],
    /// Why a side cannot be rendered.
    pub refused: [Vec<String>; 2],
    /// Share of the export under way.
    pub export: Option<f32>,
    /// Messages, the newest last.
    pub notices: Vec<Notice>,
    /// What the last pictures took, the newest last.
    pub timings: VecDeque<Timing>,
}

impl Shown {
    /// Takes in what has happened.
    pub fn take(&mut self, event: Event) {
        match event {
            Event::Loading { scene, stage, share } => self.loading = Some(Loading { scene, stage, share }),
            Event::Opened(opened) => {
                self.loading = None;
                for warning in &opened.warnings {
                    self.notify(Severity::Warning, warning);
                }
                self.is_stale = [true; 2];
                self.difference = None;
                self.opened = Some(opened);
            }
            Event::OpenFailed { message, .. } => {
                self.loading = None;
                self.notify(Severity::Error, message);
            }
            Event::Picture(rendered) => {
                let side = rendered.side as usize;
                self.refused[side].clear();
                self.progress[side] = None;
                if self.timings.len() == TIMINGS {
                    self.timings.pop_front();
                }
                self.timings.push_back(Timing { stats: rendered.stats, level: rendered.level });
                self.is_stale[side] = false;
                self.sides[side] = Some(*rendered);
            }
            Event::Copied { side, frame: copy, aov, statistics } => {
                if let Some(rendered) = &mut self.sides[side as usize]
                    && let Content::Device { frame, .. } = &mut rendered.content
                {
                    *frame = Some(copy);
                    rendered.statistics = Some(statistics).filter(|_| rendered.aov == aov);
                }
            }
            Event::Difference(difference) => self.difference = Some(*difference),
            Event::Inspected(inspected) => self.inspected = Some(Arc::from(inspected)),
            Event::Progress { side, share } => self.progress[side as usize] = Some(share),
            Event::Refused { side, messages } => self.refused[side as usize] = messages,
            Event::InspectFailed { message, .. } => self.notify(Severity::Error, message),
            Event::Exporting { share } => self.export = Some(share),
            Event::Exported { path } => {
                self.export = None;
                self.notify(Severity::Done, format!("{} is written", path.display()));
            }
            Event::ExportFailed { path, message } => {
                self.export = None;
                self.notify(Severity::Error, format!("{}: {message}", path.display()));
            }
        }
    }

    /// Adds a message.
    pub fn notify(&mut self, severity: Severity, text: impl Into<String>) {
        self.notices.push(Notice { severity, text: text.into(), since: None });
    }
}
