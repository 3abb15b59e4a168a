//! What a reader does to a page: points, drags, turns the wheel, touches and types.

use serde_json::{Value, json};

use super::Page;

impl Page {
    /// Presses the left button at `from`, moves in steps to `to` and releases it.
    pub fn drag(&mut self, from: (f64, f64), to: (f64, f64)) {
        self.hover(from);
        self.mouse("mousePressed", from, json!({ "button": "left", "buttons": 1, "clickCount": 1 }));
        for step in 1..=5 {
            let t = f64::from(step) / 5.0;
            let place = (from.0 + (to.0 - from.0) * t, from.1 + (to.1 - from.1) * t);
            self.mouse("mouseMoved", place, json!({ "button": "left", "buttons": 1 }));
        }
        self.mouse("mouseReleased", to, json!({ "button": "left", "buttons": 0, "clickCount": 1 }));
    }

    /// Moves the mouse.
    pub fn hover(&mut self, place: (f64, f64)) {
        self.mouse("mouseMoved", place, json!({}));
    }

    /// Clicks so many times.
    pub fn click(&mut self, place: (f64, f64), times: u32) {
        self.hover(place);
        for count in 1..=times {
            self.mouse("mousePressed", place, json!({ "button": "left", "buttons": 1, "clickCount": count }));
            self.mouse(
                "mouseReleased",
                place,
                json!({ "button": "left", "buttons": 0, "clickCount": count }),
            );
        }
    }

    /// Turns the wheel by so many pixels; negative is away from the reader.
    pub fn wheel(&mut self, place: (f64, f64), pixels: f64) {
        self.mouse("mouseWheel", place, json!({ "deltaX": 0, "deltaY": pixels }));
    }

    fn mouse(&mut self, kind: &str, (x, y): (f64, f64), mut parameters: Value) {
        parameters["type"] = json!(kind);
        parameters["x"] = json!(x);
        parameters["y"] = json!(y);
        self.connection.call("Input.dispatchMouseEvent", parameters);
    }

    /// Drags with a finger.
    pub fn swipe(&mut self, from: (f64, f64), to: (f64, f64)) {
        let steps = (0..=5).map(f64::from).map(|i| i / 5.0);
        let places = steps.map(|t| (from.0 + (to.0 - from.0) * t, from.1 + (to.1 - from.1) * t));
        for (i, place) in places.enumerate() {
            self.touch(if i == 0 { "touchStart" } else { "touchMove" }, &[place]);
        }
        self.touch("touchEnd", &[]);
    }

    /// Taps so many times in quick succession.
    pub fn tap(&mut self, place: (f64, f64), times: u32) {
        for _ in 0..times {
            self.touch("touchStart", &[place]);
            self.touch("touchEnd", &[]);
        }
    }

    /// Moves two fingers.
    pub fn pinch(&mut self, from: [(f64, f64); 2], to: [(f64, f64); 2]) {
        self.touch("touchStart", &from[..1]);
        self.touch("touchStart", &from);
        for step in 1..=5 {
            let t = f64::from(step) / 5.0;
            let between =
                |i: usize| (from[i].0 + (to[i].0 - from[i].0) * t, from[i].1 + (to[i].1 - from[i].1) * t);
            self.touch("touchMove", &[between(0), between(1)]);
        }
        self.touch("touchEnd", &[]);
    }

    fn touch(&mut self, kind: &str, places: &[(f64, f64)]) {
        let points: Vec<Value> =
            places.iter().enumerate().map(|(id, (x, y))| json!({ "id": id, "x": x, "y": y })).collect();
        self.connection.call("Input.dispatchTouchEvent", json!({ "type": kind, "touchPoints": points }));
    }

    /// Presses a key by its name in the DOM, such as `ArrowLeft` or `3`.
    pub fn press(&mut self, key: &str) {
        // Chromium's controls go by the code of the key.
        let code = match key {
            "Home" => 36,
            "End" => 35,
            "ArrowLeft" => 37,
            "ArrowUp" => 38,
            "ArrowRight" => 39,
            "ArrowDown" => 40,
            "Tab" => 9,
            _ => key.bytes().next().map_or(0, |byte| u32::from(byte.to_ascii_uppercase())),
        };
        let text = if key.chars().count() == 1 { key } else { "" };
        let down = if text.is_empty() { "rawKeyDown" } else { "keyDown" };
        for (kind, text) in [(down, text), ("keyUp", "")] {
            let parameters = json!({ "type": kind, "key": key, "windowsVirtualKeyCode": code, "text": text });
            self.connection.call("Input.dispatchKeyEvent", parameters);
        }
    }
}
