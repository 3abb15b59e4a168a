//! A page in the browser: looked at and listened to.

use std::{
    fs,
    path::Path,
    thread,
    time::{Duration, Instant},
};

use base64::{Engine as _, engine::general_purpose::STANDARD};
use serde_json::{Value, json};

use super::{
    PATIENCE,
    protocol::{Connection, Event},
};

/// What a page is looked at with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// Width of the window, CSS pixels.
    pub width: u32,
    /// Its height.
    pub height: u32,
    /// Pixels of the screen for a CSS pixel.
    pub density: u32,
    /// Whether it is a telephone: touched, and with its own idea of the page's width.
    pub is_phone: bool,
    /// Whether the reader asked for a dark page.
    pub is_dark: bool,
}

impl Look {
    /// A window on a desk.
    pub const DESKTOP: Self = Self { width: 1280, height: 900, density: 1, is_phone: false, is_dark: false };
    /// A small telephone.
    pub const PHONE: Self = Self { width: 360, height: 740, density: 2, is_phone: true, is_dark: false };

    /// The same in the dark.
    #[must_use]
    pub const fn dark(self) -> Self {
        Self { is_dark: true, ..self }
    }
}

/// Where an element is in the window, CSS pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    /// Left edge.
    pub x: f64,
    /// Upper edge.
    pub y: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

impl Rect {
    /// The point at fractions of the width and height.
    #[must_use]
    pub fn at(&self, u: f64, v: f64) -> (f64, f64) {
        (self.x + u * self.width, self.y + v * self.height)
    }
}

/// An open page.
#[derive(Debug)]
pub struct Page {
    pub(super) connection: Connection,
    address: String,
}

impl Page {
    pub(super) fn open(mut connection: Connection, file: &Path, look: Look) -> Self {
        for domain in ["Page", "Runtime", "Log", "Network"] {
            connection.call(&format!("{domain}.enable"), json!({}));
        }
        let metrics = json!({
            "width": look.width, "height": look.height, "deviceScaleFactor": look.density, "mobile": look.is_phone,
        });
        connection.call("Emulation.setDeviceMetricsOverride", metrics);
        connection.call("Emulation.setTouchEmulationEnabled", json!({ "enabled": look.is_phone }));
        let scheme = if look.is_dark { "dark" } else { "light" };
        let features = json!({ "features": [{ "name": "prefers-color-scheme", "value": scheme }] });
        connection.call("Emulation.setEmulatedMedia", features);
        let address = format!("file://{}", file.display());
        let answer = connection.call("Page.navigate", json!({ "url": address }));
        assert!(answer["errorText"].is_null(), "{address}: {}", answer["errorText"]);
        if !connection.events.iter().any(|event| event.method == "Page.loadEventFired") {
            connection.wait_for("Page.loadEventFired");
        }
        let mut page = Self { connection, address };
        page.settle();
        page
    }

    /// The value of a JavaScript expression; promises are waited for.
    ///
    /// # Panics
    /// If it throws.
    pub fn value(&mut self, expression: &str) -> Value {
        let parameters = json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let mut answer = self.connection.call("Runtime.evaluate", parameters);
        assert!(answer["exceptionDetails"].is_null(), "{expression}: {}", answer["exceptionDetails"]);
        answer["result"]["value"].take()
    }

    /// The text of an expression.
    ///
    /// # Panics
    /// If it has none.
    pub fn text(&mut self, expression: &str) -> String {
        let value = self.value(expression);
        value.as_str().unwrap_or_else(|| panic!("{expression} is {value}, not a text")).to_owned()
    }

    /// The number that an expression is.
    ///
    /// # Panics
    /// If it is none.
    pub fn number(&mut self, expression: &str) -> f64 {
        let value = self.value(expression);
        value.as_f64().unwrap_or_else(|| panic!("{expression} is {value}, not a number"))
    }

    /// Waits until the page has stood still for a moment and is painted.
    pub fn settle(&mut self) {
        let painted = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))";
        // What scrolls is told of with the next frame; reports want a pause between that and zooming by the wheel.
        self.value(&format!(
            "{painted}.then(() => new Promise(done => setTimeout(done, 300))).then(() => {painted})"
        ));
    }

    /// Waits until an expression is true.
    ///
    /// # Panics
    /// If it does not become so.
    pub fn wait_until(&mut self, expression: &str) {
        let start = Instant::now();
        while self.value(expression) != true {
            assert!(start.elapsed() < PATIENCE, "{expression} does not become true");
            thread::sleep(Duration::from_millis(50));
        }
    }

    /// Scrolls the element of a selector into the middle of the window; where it is then.
    ///
    /// # Panics
    /// If there is none.
    pub fn find(&mut self, selector: &str) -> Rect {
        let expression = format!(
            "(() => {{ const e = document.querySelector({0}); if (!e) return null;
                e.scrollIntoView({{ block: 'center', behavior: 'instant' }});
                const r = e.getBoundingClientRect(); return [r.x, r.y, r.width, r.height]; }})()",
            json!(selector)
        );
        let value = self.value(&expression);
        self.settle();
        let number = |i: usize| value[i].as_f64().unwrap_or_else(|| panic!("there is no {selector}"));
        Rect { x: number(0), y: number(1), width: number(2), height: number(3) }
    }

    /// Saves what the window shows as a PNG file, and returns it.
    ///
    /// # Panics
    /// If it cannot be saved.
    pub fn screenshot(&mut self, file: &Path) -> Vec<u8> {
        self.capture(file, json!({ "format": "png" }))
    }

    /// Saves the whole page, not only what the window shows.
    ///
    /// # Panics
    /// If it cannot be saved.
    pub fn screenshot_all(&mut self, file: &Path) -> Vec<u8> {
        self.capture(file, json!({ "format": "png", "captureBeyondViewport": true }))
    }

    fn capture(&mut self, file: &Path, mut parameters: Value) -> Vec<u8> {
        if parameters["captureBeyondViewport"] == true {
            let size = self.connection.call("Page.getLayoutMetrics", json!({}))["cssContentSize"].take();
            parameters["clip"] =
                json!({ "x": 0, "y": 0, "width": size["width"], "height": size["height"], "scale": 1 });
        }
        let answer = self.connection.call("Page.captureScreenshot", parameters);
        let png = STANDARD.decode(answer["data"].as_str().expect("a picture")).expect("base64");
        fs::write(file, &png).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        png
    }

    /// Saves the page as it is printed, a PDF file.
    ///
    /// # Panics
    /// If it cannot be saved.
    pub fn print(&mut self, file: &Path) {
        let answer = self.connection.call("Page.printToPDF", json!({ "printBackground": true }));
        let pdf = STANDARD.decode(answer["data"].as_str().expect("a file")).expect("base64");
        fs::write(file, pdf).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    }

    /// What the browser said about the page – messages of the console, exceptions, warnings – and what the page asked for
    /// outside itself. Nothing, for a good page.
    #[must_use]
    pub fn complaints(&mut self) -> Vec<String> {
        // An answer to anything comes after the events before it.
        self.value("0");
        self.connection.events.iter().filter_map(|event| complaint(event, &self.address)).collect()
    }
}

fn complaint(Event { method, params }: &Event, address: &str) -> Option<String> {
    let quoted = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    match method.as_str() {
        "Runtime.consoleAPICalled" => Some(format!("console: {}", params["args"])),
        "Runtime.exceptionThrown" => Some(format!("exception: {}", params["exceptionDetails"])),
        "Log.entryAdded" => Some(format!("log: {}", quoted(&params["entry"]["text"]))),
        "Network.requestWillBeSent" => {
            let asked = quoted(&params["request"]["url"]);
            let is_own = asked.starts_with("data:") || asked.split('#').next() == Some(address);
            (!is_own).then(|| format!("request: {asked}"))
        }
        _ => None,
    }
}
