//! What keys and mouse do on the canvas: the list that the help prints.

/// A key or a movement of the mouse, and what it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Action {
    /// The keys and movements in words.
    pub keys: &'static str,
    /// What it does, in words.
    pub meaning: &'static str,
}

/// Everything that can be done on the canvas.
pub const ACTIONS: &[Action] = &[
    Action { keys: "Drag", meaning: "Turn around the target" },
    Action { keys: "Middle drag, Shift+drag", meaning: "Move across the picture" },
    Action { keys: "Wheel", meaning: "Come closer to the target, or zoom out" },
    Action { keys: "Hold right button", meaning: "Look around; fly with W A S D, down and up with Q E" },
    Action { keys: "Shift while flying", meaning: "Fly faster" },
    Action { keys: "Wheel while flying", meaning: "Change the speed of flight" },
    Action { keys: "Double click", meaning: "Go to the point under the cursor and turn around it" },
    Action { keys: "F", meaning: "Frame the whole scene" },
    Action {
        keys: "X Y Z",
        meaning: "Look from the right, the top, the front; with Shift from the other side",
    },
    Action { keys: "O", meaning: "Perspective or orthographic" },
    Action { keys: "Ctrl+wheel", meaning: "Magnify the pixels of the picture, up to 64 times" },
    Action { keys: "Ctrl+drag", meaning: "Move the magnified picture" },
    Action { keys: "0", meaning: "Show the whole picture again" },
    Action { keys: "I", meaning: "Pixel inspector: values under the cursor" },
    Action { keys: "Alt+click", meaning: "Inspect the rays of a pixel, and keep it while the cursor moves" },
    Action { keys: "Esc", meaning: "Let go of the inspected pixel" },
    Action {
        keys: "Drag the divider, \u{2190} \u{2192}",
        meaning: "Move the divider between A and B; with Shift farther",
    },
    Action { keys: "Double click the divider", meaning: "Put the divider in the middle" },
];
