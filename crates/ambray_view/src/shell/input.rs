//! What hands and keys do, as egui hears it: the input of a script.

use egui::{Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, TouchPhase, Vec2};

/// Frames that a drag takes: the window must see that the pointer moves.
const DRAG_FRAMES: usize = 6;

/// Events for the frames to come, one list each.
pub(super) type Frames = Vec<Vec<Event>>;

/// A key with its modifiers, pressed and released.
pub(super) fn key(key: Key, modifiers: Modifiers, text: Option<&str>) -> Frames {
    let event = |pressed| Event::Key { key, physical_key: None, pressed, repeat: false, modifiers };
    let mut down = vec![Event::ModifiersChanged(modifiers), event(true)];
    down.extend(text.map(|text| Event::Text(text.to_owned())));
    vec![down, vec![event(false), Event::ModifiersChanged(Modifiers::NONE)]]
}

/// Text, as it is typed into a field.
pub(super) fn text(text: &str) -> Frames {
    vec![vec![Event::Text(text.to_owned())]]
}

/// The pointer goes to `pos`, points.
pub(super) fn move_to(pos: Pos2) -> Frames {
    // In the second frame everything knows what is under the pointer.
    vec![vec![Event::PointerMoved(pos)], Vec::new()]
}

/// `count` clicks at `pos`, points, while `modifiers` are held.
pub(super) fn click(pos: Pos2, count: usize, modifiers: Modifiers) -> Frames {
    let mut frames = move_to(pos);
    frames.push(vec![Event::ModifiersChanged(modifiers)]);
    for _ in 0..count {
        frames.extend([true, false].map(|pressed| vec![button(pos, PointerButton::Primary, pressed)]));
    }
    frames.push(vec![Event::ModifiersChanged(Modifiers::NONE)]);
    frames
}

/// A drag from `from` by `by`, points.
pub(super) fn drag(from: Pos2, by: Vec2, with: PointerButton) -> Frames {
    let mut frames = move_to(from);
    frames.push(vec![button(from, with, true)]);
    frames.extend((1..=DRAG_FRAMES).map(|i| {
        let share = i as f32 / DRAG_FRAMES as f32;
        vec![Event::PointerMoved(from + share * by)]
    }));
    frames.push(vec![button(from + by, with, false)]);
    frames
}

/// The wheel, turned at `pos`, points, by `lines`.
pub(super) fn scroll(pos: Pos2, lines: f32) -> Frames {
    let wheel = Event::MouseWheel {
        unit: MouseWheelUnit::Line,
        delta: Vec2::new(0.0, lines),
        phase: TouchPhase::Move,
        modifiers: Modifiers::NONE,
    };
    let mut frames = move_to(pos);
    frames.push(vec![wheel]);
    frames
}

fn button(pos: Pos2, button: PointerButton, pressed: bool) -> Event {
    Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE }
}
