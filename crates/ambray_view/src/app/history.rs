//! Undo and redo of settings. A drag is one step, and so is a walk of the camera.

use ambray::settings::Settings;

use crate::model::Bookmark;

/// Steps that are kept.
const STEPS: usize = 200;

type Both = [Settings; 2];

/// The past of the settings of both sides.
#[derive(Debug, Default)]
pub(super) struct History {
    past: Vec<Step>,
    future: Vec<Both>,
    /// The settings as they were after the last step.
    rest: Option<Both>,
}

#[derive(Debug)]
struct Step {
    before: Both,
    is_camera: bool,
}

impl History {
    /// Looks at the settings after a frame. While something `is_dragged` the change is not over.
    pub(super) fn observe(&mut self, settings: &Both, is_dragged: bool) {
        let Some(rest) = &self.rest else {
            self.rest = Some(settings.clone());
            return;
        };
        if is_dragged {
            return;
        }
        if without(rest, false) != without(settings, false) {
            let is_camera = without(rest, true) == without(settings, true);
            let before = rest.clone();
            // A walk of the camera is one step, so that it does not bury the settings.
            if !(is_camera && self.past.last().is_some_and(|step| step.is_camera)) {
                self.past.push(Step { before, is_camera });
            }
            if self.past.len() > STEPS {
                self.past.remove(0);
            }
            self.future.clear();
        }
        self.rest = Some(settings.clone());
    }

    /// Takes back the last step.
    pub(super) fn undo(&mut self, settings: &mut Both) -> bool {
        let Some(step) = self.past.pop() else { return false };
        self.future.push(settings.clone());
        self.go(settings, step.before);
        true
    }

    /// Makes the step that was taken back.
    pub(super) fn redo(&mut self, settings: &mut Both) -> bool {
        let Some(after) = self.future.pop() else { return false };
        let is_camera = without(settings, true) == without(&after, true);
        self.past.push(Step { before: settings.clone(), is_camera });
        self.go(settings, after);
        true
    }

    /// Goes to other settings; the size is the window's, and time goes its own way.
    fn go(&mut self, settings: &mut Both, to: Both) {
        for (settings, to) in settings.iter_mut().zip(to) {
            let (size, time) = (settings.size, settings.time.clone());
            *settings = Settings { size, time, ..to };
        }
        self.rest = Some(settings.clone());
    }
}

/// The settings apart from size and time, and from the camera where that is asked for.
fn without(settings: &Both, camera: bool) -> Both {
    settings.each_ref().map(|settings| {
        let Settings { size, time, .. } = Settings::default();
        let mut settings = Settings { size, time, ..settings.clone() };
        if camera {
            Bookmark::default().apply(&mut settings);
        }
        settings
    })
}

#[cfg(test)]
mod tests {
    use ambray::settings::{Auto, Size, Triple};

    use super::*;

    fn spp(spp: u32) -> Both {
        [Settings { spp, ..Settings::default() }, Settings::default()]
    }

    #[test]
    fn a_drag_is_one_step() {
        let (mut history, mut settings) = (History::default(), spp(8));
        history.observe(&settings, false);
        for n in 9..20 {
            settings = spp(n);
            history.observe(&settings, true);
        }
        history.observe(&settings, false);
        assert!(history.undo(&mut settings));
        assert_eq!(settings, spp(8));
        assert!(!history.undo(&mut settings));
        assert!(history.redo(&mut settings));
        assert_eq!(settings, spp(19));
        assert!(!history.redo(&mut settings));
    }

    #[test]
    fn a_walk_of_the_camera_is_one_step_and_the_size_is_none() {
        let (mut history, mut settings) = (History::default(), spp(8));
        history.observe(&settings, false);
        settings[0].spp = 4;
        history.observe(&settings, false);
        for x in 1..5 {
            settings[0].camera_position = Auto::Value(Triple([x as f32, 0.0, 0.0]));
            history.observe(&settings, false);
        }
        settings[0].size = Size { width: 7, height: 5 };
        history.observe(&settings, false);
        assert!(history.undo(&mut settings));
        assert_eq!(settings[0].camera_position, Auto::Auto);
        assert_eq!((settings[0].spp, settings[0].size.width), (4, 7));
        assert!(history.undo(&mut settings));
        assert_eq!(settings[0].spp, 8);
    }

    #[test]
    fn a_new_change_ends_what_could_be_redone() {
        let (mut history, mut settings) = (History::default(), spp(8));
        history.observe(&settings, false);
        settings = spp(9);
        history.observe(&settings, false);
        history.undo(&mut settings);
        settings = spp(10);
        history.observe(&settings, false);
        assert!(!history.redo(&mut settings));
        history.undo(&mut settings);
        assert_eq!(settings, spp(8));
    }
}
