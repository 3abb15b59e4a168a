//! Questions for a file: the dialog that asks, and what the answer becomes.

use std::{
    fmt,
    path::{Path, PathBuf},
};

use egui::{Align2, Context, DragValue, Grid, Window};
use egui_file_dialog::{DialogState, FileDialog};

use super::{
    Desk,
    action::{Action, Question},
};
use crate::model::SceneRef;

/// The question that is open, if any.
#[derive(Default)]
pub(super) struct Dialogs {
    open: Option<(Question, FileDialog)>,
    turntable: Option<Turntable>,
    /// The folder of the last answer.
    folder: Option<PathBuf>,
}

/// The plan of a turntable, before its file is asked for.
#[derive(Clone, Debug)]
struct Turntable {
    frames: u32,
    fps: f32,
    name: String,
}

impl fmt::Debug for Dialogs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let question = self.open.as_ref().map(|(question, _)| question);
        f.debug_struct("Dialogs").field("question", &question).field("turntable", &self.turntable).finish()
    }
}

impl Dialogs {
    pub(super) const fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// Begins to ask; `name` is what files are called unless the user says otherwise.
    pub(super) fn ask(&mut self, question: Question, name: &str) {
        match question {
            // Its plan comes first; one that is being made is not begun anew.
            Question::Turntable { frames, fps } => {
                let begin = || Turntable { frames, fps, name: format!("{name}_####.png") };
                self.turntable.get_or_insert_with(begin);
            }
            Question::Save => self.ask_for_file(question, &format!("{name}.toml")),
            Question::Scene | Question::Load | Question::Screenshot => {
                self.ask_for_file(question, &format!("{name}.png"));
            }
        }
    }

    fn ask_for_file(&mut self, question: Question, file_name: &str) {
        let mut dialog = FileDialog::new().title(title(question)).default_file_name(file_name);
        dialog = dialog.anchor(Align2::CENTER_CENTER, [0.0, 0.0]);
        if let Some(folder) = &self.folder {
            dialog = dialog.initial_directory(folder.clone());
        }
        dialog = match question {
            Question::Scene => {
                let scenes = vec!["gltf", "glb", "obj", "GLTF", "GLB", "OBJ"];
                dialog.add_file_filter_extensions("Scenes", scenes).default_file_filter("Scenes")
            }
            Question::Load => dialog
                .add_file_filter_extensions("Settings and pictures", vec!["toml", "png", "exr"])
                .default_file_filter("Settings and pictures"),
            Question::Save | Question::Screenshot | Question::Turntable { .. } => dialog,
        };
        match question {
            Question::Scene | Question::Load => dialog.pick_file(),
            Question::Save | Question::Screenshot | Question::Turntable { .. } => dialog.save_file(),
        }
        self.open = Some((question, dialog));
    }

    pub(super) fn show(&mut self, ctx: &Context, desk: &mut Desk<'_>) {
        self.plan_turntable(ctx);
        let Some((question, dialog)) = &mut self.open else { return };
        dialog.update(ctx);
        if let Some(path) = dialog.take_picked() {
            self.folder = path.parent().map(Path::to_owned);
            desk.actions.push(answer(*question, path));
            self.open = None;
        } else if matches!(dialog.state(), DialogState::Closed | DialogState::Cancelled) {
            self.open = None;
        }
    }

    fn plan_turntable(&mut self, ctx: &Context) {
        let Some(turntable) = &mut self.turntable else { return };
        let (mut is_open, mut is_decided, mut is_cancelled) = (true, false, false);
        let window = Window::new("Turntable").open(&mut is_open).collapsible(false).resizable(false);
        window.default_pos([420.0, 120.0]).show(ctx, |ui| {
            Grid::new("turntable").num_columns(2).show(ui, |ui| {
                ui.label("frames of the turn");
                ui.add(DragValue::new(&mut turntable.frames).range(2..=10_000));
                ui.end_row();
                ui.label("frames a second");
                ui.add(DragValue::new(&mut turntable.fps).range(1.0..=240.0).max_decimals(3));
                ui.end_row();
                ui.label("name");
                ui.text_edit_singleline(&mut turntable.name);
                ui.end_row();
            });
            ui.weak("#### is the number of a picture; .gif, .mp4 and .webm are videos");
            ui.horizontal(|ui| {
                is_decided = ui.button("Choose where\u{2026}").clicked();
                is_cancelled = ui.button("Cancel").clicked();
            });
        });
        if is_decided {
            let Turntable { frames, fps, ref name } = *turntable;
            let name = name.clone();
            self.turntable = None;
            self.ask_for_file(Question::Turntable { frames, fps }, &name);
        } else if !is_open || is_cancelled {
            self.turntable = None;
        }
    }
}

const fn title(question: Question) -> &'static str {
    match question {
        Question::Scene => "Open a scene",
        Question::Load => "Load settings: TOML, or a picture that holds them",
        Question::Save => "Save settings",
        Question::Screenshot => "Save a screenshot: .png or .exr",
        Question::Turntable { .. } => "Write a turntable",
    }
}

fn answer(question: Question, path: PathBuf) -> Action {
    match question {
        Question::Scene => Action::Open(SceneRef::new(path)),
        Question::Load => Action::LoadSettings(path),
        Question::Save => Action::SaveSettings(path),
        Question::Screenshot => Action::Screenshot(path),
        Question::Turntable { frames, fps } => Action::Turntable { path, frames, fps },
    }
}
