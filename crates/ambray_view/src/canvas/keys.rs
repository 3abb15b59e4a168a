//! What keys and mouse do on the canvas: the list that the help prints.

/// A key or a movement of the mouse, and what it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Action {
    /// What to press or move.
    pub keys: &'static str,
    /// What happens.
    pub does: &'static str,
}

/// Everything that can be done on the canvas.
pub const ACTIONS: &[Action] = &[
    Action { keys: "drag", does: "turn around the target" },
    Action { keys: "middle drag, Shift+drag", does: "move across the picture" },
    Action { keys: "wheel", does: "come closer to the target, or zoom out" },
    Action { keys: "hold right button", does: "look around; fly with W A S D, down and up with Q E" },
    Action { keys: "Shift while flying", does: "fly faster" },
    Action { keys: "wheel while flying", does: "change the speed of flight" },
    Action { keys: "double click", does: "go to the point under the cursor and turn around it" },
    Action { keys: "F", does: "frame the whole scene" },
    Action { keys: "X Y Z", does: "look from the right, the top, the front; with Shift from the other side" },
    Action { keys: "O", does: "perspective or orthographic" },
    Action { keys: "Ctrl+wheel", does: "magnify the pixels of the picture, up to 64 times" },
    Action { keys: "Ctrl+drag", does: "move the magnified picture" },
    Action { keys: "0", does: "show the whole picture again" },
    Action { keys: "I", does: "pixel inspector: values under the cursor" },
    Action { keys: "Alt+click", does: "inspect the rays of a pixel, and keep it while the cursor moves" },
    Action { keys: "Esc", does: "let go of the inspected pixel" },
    Action {
        keys: "drag the divider, \u{2190} \u{2192}",
        does: "move the divider between A and B; with Shift farther",
    },
    Action { keys: "double click the divider", does: "put the divider in the middle" },
];
