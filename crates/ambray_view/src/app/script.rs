//! What a test or a script needs to know and to do, besides keys and the mouse.

use ambray::settings::{SetError, Settings, Temporal};

use super::{App, Severity};
use crate::model::{Resolution, Side};

impl App {
    /// Whether everything that was asked for is shown: final pictures, nothing loading, nothing being written.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        let is_open = self.failed.is_some()
            || self.shown.opened.as_ref().is_some_and(|opened| opened.scene == self.model.scene);
        let is_asked = self.asked.as_ref() == Some(&self.model.scene);
        let is_quiet = self.shown.loading.is_none() && self.shown.export.is_none() && self.errands.is_idle();
        is_asked && is_open && is_quiet && self.model.sides().iter().all(|&side| self.is_final(side))
    }

    /// Whether the picture of `side` is what was asked for, or cannot be.
    fn is_final(&self, side: Side) -> bool {
        let i = side as usize;
        if !self.shown.refused[i].is_empty() || self.shown.opened.is_none() {
            return true;
        }
        let wanted = self.sent.as_ref().and_then(|order| order.sides[i].as_ref());
        let Some((wanted, rendered)) = wanted.zip(self.shown.sides[i].as_ref()) else { return false };
        // Frames that are accumulated count on; others are those that were asked for.
        let accumulates = wanted.temporal == Temporal::On;
        let frame = if accumulates { wanted.frame } else { rendered.settings.frame };
        let is_same = Settings { frame, ..rendered.settings.clone() } == *wanted;
        is_same && rendered.level.is_final && rendered.aov == self.model.aov && !self.shown.is_stale[i]
    }

    /// Frames whose mean the final picture of `side` is; 0 while it is not what was asked for.
    #[must_use]
    pub fn frames(&self, side: Side) -> u32 {
        let rendered = self.shown.sides[side as usize].as_ref().filter(|_| self.is_final(side));
        rendered.map_or(0, |rendered| rendered.frames)
    }

    /// Whether the window is to be closed.
    #[must_use]
    pub const fn is_quitting(&self) -> bool {
        self.is_quitting
    }

    /// Whether the help is shown.
    #[must_use]
    pub const fn is_help_open(&self) -> bool {
        self.panels.is_help_open()
    }

    /// The last line that was put on the clipboard.
    #[must_use]
    pub fn copied(&self) -> Option<&str> {
        self.copied.as_deref()
    }

    /// The newest error that is shown.
    #[must_use]
    pub fn error(&self) -> Option<&str> {
        let notices = self.shown.notices.iter().rev();
        notices.filter(|notice| notice.severity == Severity::Error).map(|notice| notice.text.as_str()).next()
    }

    /// Changes a setting of the edited side by name, spelled as on the command line.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), SetError> {
        self.model.edited_mut().set(name, value)?;
        if name == "size" {
            self.model.resolution = Resolution::Fixed(self.model.edited().size);
        }
        Ok(())
    }
}
