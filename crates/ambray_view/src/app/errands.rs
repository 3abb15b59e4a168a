//! Small work with files that the window does not wait for.

use std::{
    path::{Path, PathBuf},
    sync::mpsc,
};

use ambray::settings::Settings;
use ambray_files::{
    atomic::{Batch, Target},
    settings_file::{self, SettingsFile},
};

/// What came of an errand.
#[derive(Debug)]
pub(super) enum Outcome {
    /// Settings were read.
    Loaded(PathBuf, Box<SettingsFile>),
    /// A file was written.
    Written(PathBuf),
    /// It failed; one line.
    Failed(String),
}

/// Runs errands, each on a thread of its own.
#[derive(Debug)]
pub(super) struct Errands {
    sender: mpsc::Sender<Outcome>,
    receiver: mpsc::Receiver<Outcome>,
    running: usize,
}

impl Default for Errands {
    fn default() -> Self {
        let (sender, receiver) = mpsc::channel();
        Self { sender, receiver, running: 0 }
    }
}

impl Errands {
    /// Reads settings from TOML or from a picture.
    pub(super) fn load(&mut self, ctx: &egui::Context, path: PathBuf) {
        self.run(ctx, move || settings_file::read(&path).map(|file| Outcome::Loaded(path, Box::new(file))));
    }

    /// Writes settings as TOML.
    pub(super) fn save(&mut self, ctx: &egui::Context, path: PathBuf, settings: &Settings) {
        let text = settings_file::write(settings);
        self.run(ctx, move || write(&path, &text).map(|()| Outcome::Written(path)));
    }

    /// What has come of errands since the last call.
    pub(super) fn poll(&mut self) -> Vec<Outcome> {
        let outcomes: Vec<_> = self.receiver.try_iter().collect();
        self.running -= outcomes.len();
        outcomes
    }

    /// Whether nothing is under way.
    pub(super) const fn is_idle(&self) -> bool {
        self.running == 0
    }

    fn run(&mut self, ctx: &egui::Context, work: impl FnOnce() -> anyhow::Result<Outcome> + Send + 'static) {
        self.running += 1;
        let (sender, ctx) = (self.sender.clone(), ctx.clone());
        std::thread::spawn(move || {
            let outcome = work().unwrap_or_else(|error| Outcome::Failed(format!("{error:#}")));
            let _ = sender.send(outcome); // nobody listens once the window is closed
            ctx.request_repaint();
        });
    }
}

/// Replaces the file at `path`, which appears complete or not at all.
pub(crate) fn write(path: &Path, text: &str) -> anyhow::Result<()> {
    let mut batch = Batch::default();
    batch.add(&Target::File(path.to_owned()), |file| Ok(file.write_all(text.as_bytes())?))?;
    batch.commit()
}
