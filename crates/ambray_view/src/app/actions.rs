//! What the application does when a panel or a key asks for it.

use ambray::settings::{Preset, Temporal};
use ambray_files::settings_file::SettingsFile;

use super::{App, Severity, clock, command, drop, errands::Outcome};
use crate::{
    engine::Export,
    model::{Bookmark, Side},
    panels::action::{Action, Question},
};

impl App {
    /// Does what is asked for.
    pub fn perform(&mut self, ctx: &egui::Context, action: Action) {
        match action {
            Action::Open(scene) if scene != self.model.scene => self.model.scene = scene,
            Action::Open(_) | Action::Reload => self.asked = None,
            Action::Ask(question) => self.ask(question),
            Action::LoadSettings(path) => self.errands.load(ctx, path),
            Action::SaveSettings(path) => {
                let path = with_extension(path, "toml");
                self.errands.save(ctx, path, self.model.edited());
            }
            Action::Screenshot(path) => {
                let path = with_extension(path, "png");
                let settings = self.valid[self.model.editing as usize].clone();
                self.engine.export(Export::Screenshot { path, settings, aov: self.model.aov });
            }
            Action::Turntable { path, frames, fps } => {
                let path = with_extension(path, "png");
                let settings = self.valid[self.model.editing as usize].clone();
                self.engine.export(Export::Turntable { path, settings, aov: self.model.aov, frames, fps });
            }
            Action::CancelExport => self.engine.cancel_export(),
            Action::Quit => self.is_quitting = true,
            Action::ToggleFullscreen => {
                let is_full = ctx.input(|input| input.viewport().fullscreen).unwrap_or(false);
                ctx.send_viewport_cmd(egui::ViewportCommand::Fullscreen(!is_full));
            }
            Action::Undo => self.undo(),
            Action::Redo => self.redo(),
            Action::Keep(digit) => self.keep_bookmark(digit),
            Action::Recall(digit) => self.recall_bookmark(digit),
            Action::Copy(side) => self.copy(ctx, side),
            Action::TogglePanels => {
                self.toggle_panels();
                // The key has moved the focus, too, into a field that would take the next keys.
                ctx.memory_mut(|memory| {
                    memory.move_focus(egui::FocusDirection::None);
                    if let Some(focused) = memory.focused() {
                        memory.surrender_focus(focused);
                    }
                });
            }
            Action::ToggleHelp => self.panels.toggle_help(),
            Action::TogglePlay => self.toggle_play(),
            Action::Step(frames) => clock::step(&mut self.model, self.shown.opened.as_deref(), frames),
            Action::Drop(path) => match drop::purpose(path) {
                Ok(action) => self.perform(ctx, action),
                Err(message) => self.shown.notify(Severity::Error, message),
            },
        }
        ctx.request_repaint();
    }

    fn ask(&mut self, question: Question) {
        let path = &self.model.scene.path;
        let name = path.file_stem().map_or_else(|| "ambray".to_owned(), |name| name.to_string_lossy().into());
        self.panels.ask(question, &name);
    }

    fn undo(&mut self) {
        if !self.history.undo(&mut self.model.settings) {
            self.shown.notify(Severity::Done, "There is nothing to undo");
        }
    }

    fn redo(&mut self) {
        if !self.history.redo(&mut self.model.settings) {
            self.shown.notify(Severity::Done, "There is nothing to redo");
        }
    }

    fn keep_bookmark(&mut self, digit: u8) {
        self.model.bookmarks.insert(digit, Bookmark::of(self.model.edited()));
        self.shown.notify(Severity::Done, format!("View {digit} is kept: press {digit} to come back"));
    }

    fn recall_bookmark(&mut self, digit: u8) {
        match self.model.bookmarks.get(&digit).cloned() {
            Some(bookmark) => bookmark.apply(self.model.edited_mut()),
            None => self.shown.notify(
                Severity::Done,
                format!("No view is kept under {digit}: Shift+{digit} keeps this one"),
            ),
        }
    }

    fn copy(&mut self, ctx: &egui::Context, side: Side) {
        let line = self.command_line(side);
        ctx.copy_text(line.clone());
        // While time goes on, light comes from moments before, which no line names.
        let is_blended = self.model.playback.is_playing && self.model.of(side).temporal == Temporal::On;
        let alone =
            if is_blended { ": it renders this moment alone, without light of those before" } else { "" };
        self.shown.notify(Severity::Done, format!("The command line is on the clipboard{alone}"));
        self.copied = Some(line);
    }

    /// The call of `ambray render` that makes the picture of `side`.
    #[must_use]
    pub fn command_line(&self, side: Side) -> String {
        // What cannot be rendered is not seen: the line is that of the picture.
        command::line(&self.model, &self.shown, side, &self.valid[side as usize], self.frames(side))
    }

    const fn toggle_panels(&mut self) {
        let panels = &mut self.memory.panels;
        let is_any_open = panels.settings || panels.facts;
        panels.settings = !is_any_open;
        panels.facts = !is_any_open;
        panels.timeline = !is_any_open;
    }

    fn toggle_play(&mut self) {
        let has_animation = self.shown.opened.as_ref().is_some_and(|opened| !opened.animations.is_empty());
        if has_animation {
            self.model.playback.is_playing = !self.model.playback.is_playing;
        } else {
            self.shown.notify(Severity::Done, "The scene has no animation");
        }
    }

    /// Takes what has come of errands.
    pub(super) fn take_outcomes(&mut self) {
        for outcome in self.errands.poll() {
            match outcome {
                Outcome::Loaded(path, file) => {
                    self.load(*file);
                    self.shown.notify(Severity::Done, format!("{} is loaded", path.display()));
                }
                Outcome::Written(path) => {
                    self.shown.notify(Severity::Done, format!("{} is written", path.display()));
                }
                Outcome::Failed(message) => self.shown.notify(Severity::Error, message),
            }
        }
    }

    /// Lays settings over those of the edited side, as `ambray render --settings` does over the defaults.
    fn load(&mut self, file: SettingsFile) {
        let size = self.model.edited().size;
        let mut settings = ambray::settings::Settings::default();
        file.preset.map(Preset::patch).unwrap_or_default().apply(&mut settings);
        file.patch.apply(&mut settings);
        if file.patch.size.is_some() && settings.size != size {
            self.model.resolution = crate::model::Resolution::Fixed(settings.size);
        } else {
            settings.size = size;
        }
        *self.model.edited_mut() = settings;
    }
}

/// Gives files without an extension the usual one.
fn with_extension(path: std::path::PathBuf, extension: &str) -> std::path::PathBuf {
    if path.extension().is_some() { path } else { path.with_extension(extension) }
}
