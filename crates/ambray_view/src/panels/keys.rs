//! The keys of the window: one list, for the input and for the help.

use egui::{Event, Key, Modifiers};

use super::action::{Action, Question};
use crate::model::Side;

/// What sets a shortcut off.
#[derive(Clone, Copy, Debug)]
enum Trigger {
    /// A key with exactly these modifiers, apart from Shift where the key itself needs it.
    Key(Modifiers, Key),
    /// A digit from 1 to 9.
    Digit(Modifiers),
}

/// A key and what it does.
#[derive(Clone, Copy, Debug)]
pub struct Shortcut {
    /// The key in words.
    pub keys: &'static str,
    /// What it does, in words.
    pub meaning: &'static str,
    /// Any of them.
    triggers: &'static [Trigger],
    /// Made from the digit, or from 0.
    action: fn(u8) -> Action,
}

const fn shortcut(
    keys: &'static str,
    meaning: &'static str,
    triggers: &'static [Trigger],
    action: fn(u8) -> Action,
) -> Shortcut {
    Shortcut { keys, meaning, triggers, action }
}

const NONE: Modifiers = Modifiers::NONE;
const CTRL: Modifiers = Modifiers::COMMAND;
const SHIFT: Modifiers = Modifiers::SHIFT;

/// All shortcuts of the panels; where two match, the first one counts.
pub const SHORTCUTS: &[Shortcut] = &[
    shortcut("Ctrl+O", "Open a scene", &[Trigger::Key(CTRL, Key::O)], |_| Action::Ask(Question::Scene)),
    shortcut("F5", "Read the scene again", &[Trigger::Key(NONE, Key::F5)], |_| Action::Reload),
    shortcut("Ctrl+L", "Load settings", &[Trigger::Key(CTRL, Key::L)], |_| Action::Ask(Question::Load)),
    shortcut("Ctrl+Shift+S", "Save settings", &[Trigger::Key(CTRL.plus(SHIFT), Key::S)], |_| {
        Action::Ask(Question::Save)
    }),
    shortcut("Ctrl+S", "Save a screenshot", &[Trigger::Key(CTRL, Key::S)], |_| {
        Action::Ask(Question::Screenshot)
    }),
    shortcut("Ctrl+Shift+C", "Copy as command line", &[Trigger::Key(CTRL.plus(SHIFT), Key::C)], |_| {
        Action::Copy(Side::A)
    }),
    shortcut("Ctrl+Z", "Undo the last change of the settings", &[Trigger::Key(CTRL, Key::Z)], |_| {
        Action::Undo
    }),
    shortcut(
        "Ctrl+Y, Ctrl+Shift+Z",
        "Redo the change of the settings",
        &[Trigger::Key(CTRL, Key::Y), Trigger::Key(CTRL.plus(SHIFT), Key::Z)],
        |_| Action::Redo,
    ),
    shortcut("Ctrl+Q", "Quit", &[Trigger::Key(CTRL, Key::Q)], |_| Action::Quit),
    shortcut("Space", "Play or pause the animation", &[Trigger::Key(NONE, Key::Space)], |_| {
        Action::TogglePlay
    }),
    shortcut(".", "Step the animation forward", &[Trigger::Key(NONE, Key::Period)], |_| Action::Step(1)),
    shortcut(",", "Step the animation back", &[Trigger::Key(NONE, Key::Comma)], |_| Action::Step(-1)),
    shortcut("Tab", "Show or hide the panels", &[Trigger::Key(NONE, Key::Tab)], |_| Action::TogglePanels),
    shortcut("F11", "Fill the screen, or not", &[Trigger::Key(NONE, Key::F11)], |_| Action::ToggleFullscreen),
    shortcut("Shift+1 to 9", "Keep the view under the digit", &[Trigger::Digit(SHIFT)], Action::Keep),
    shortcut("1 to 9", "Go back to the view of the digit", &[Trigger::Digit(NONE)], Action::Recall),
    shortcut(
        "?, F1, H",
        "Show or hide this help",
        &[Trigger::Key(NONE, Key::Questionmark), Trigger::Key(NONE, Key::F1), Trigger::Key(NONE, Key::H)],
        |_| Action::ToggleHelp,
    ),
];

const DIGITS: [Key; 9] =
    [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7, Key::Num8, Key::Num9];

/// Takes the shortcuts out of the input of this frame. While text is typed only those with Ctrl count.
pub fn pressed(ctx: &egui::Context) -> Vec<Action> {
    let is_typing = ctx.text_edit_focused();
    ctx.input_mut(|input| {
        let mut actions = Vec::new();
        input.events.retain(|event| match action_of(event, is_typing) {
            Some(action) => {
                actions.push(action);
                false
            }
            None => true,
        });
        actions
    })
}

fn action_of(event: &Event, is_typing: bool) -> Option<Action> {
    let Event::Key { key, physical_key, pressed: true, repeat, modifiers } = event else { return None };
    if is_typing && !modifiers.command && !matches!(key, Key::F1 | Key::F5 | Key::F11) {
        return None;
    }
    let action = SHORTCUTS.iter().find_map(|shortcut| {
        let digit = shortcut.triggers.iter().find_map(|trigger| match *trigger {
            Trigger::Key(wanted, wanted_key) => {
                (*key == wanted_key && matches(*modifiers, wanted, wanted_key)).then_some(0)
            }
            // With Shift the key of a digit means another character.
            Trigger::Digit(wanted) => DIGITS
                .iter()
                .position(|digit| key == digit || *physical_key == Some(*digit))
                .filter(|_| modifiers.shift == wanted.shift && !modifiers.command && !modifiers.alt)
                .map(|i| i as u8 + 1),
        })?;
        Some((shortcut.action)(digit))
    })?;
    // What goes there and back would flicker while its key is held.
    let goes_on = matches!(action, Action::Step(_) | Action::Undo | Action::Redo);
    (!repeat || goes_on).then_some(action)
}

fn matches(modifiers: Modifiers, wanted: Modifiers, key: Key) -> bool {
    let shift = modifiers.shift == wanted.shift || key == Key::Questionmark;
    shift && modifiers.command == wanted.command && !modifiers.alt
}

#[cfg(test)]
mod tests {
    use super::*;

    fn press(key: Key, physical_key: Option<Key>, modifiers: Modifiers) -> Option<Action> {
        action_of(&Event::Key { key, physical_key, pressed: true, repeat: false, modifiers }, false)
    }

    #[test]
    fn keys_do_what_the_list_says() {
        assert_eq!(press(Key::O, None, CTRL), Some(Action::Ask(Question::Scene)));
        assert_eq!(press(Key::O, None, NONE), None);
        assert_eq!(press(Key::F11, None, NONE), Some(Action::ToggleFullscreen));
        let held = |key| Event::Key { key, physical_key: None, pressed: true, repeat: true, modifiers: NONE };
        assert_eq!(action_of(&held(Key::F11), false), None);
        assert_eq!(action_of(&held(Key::Period), false), Some(Action::Step(1)));
        assert_eq!(press(Key::S, None, CTRL), Some(Action::Ask(Question::Screenshot)));
        assert_eq!(press(Key::S, None, CTRL.plus(SHIFT)), Some(Action::Ask(Question::Save)));
        assert_eq!(press(Key::Z, None, CTRL), Some(Action::Undo));
        for (key, modifiers) in [(Key::Z, CTRL.plus(SHIFT)), (Key::Y, CTRL)] {
            assert_eq!(press(key, None, modifiers), Some(Action::Redo));
        }
        assert_eq!(press(Key::Questionmark, Some(Key::Slash), SHIFT), Some(Action::ToggleHelp));
        assert_eq!(press(Key::Num3, Some(Key::Num3), NONE), Some(Action::Recall(3)));
        assert_eq!(press(Key::Exclamationmark, Some(Key::Num1), SHIFT), Some(Action::Keep(1)));
    }

    #[test]
    fn letters_that_are_typed_are_no_shortcuts() {
        let event = |modifiers| Event::Key {
            key: Key::H,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers,
        };
        assert_eq!(action_of(&event(NONE), true), None);
        assert_eq!(action_of(&event(NONE), false), Some(Action::ToggleHelp));
    }
}
