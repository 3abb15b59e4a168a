//! The window, with a keyboard and a mouse.

use std::{process::Stdio, thread, time::Duration};

use x11rb::{
    connection::Connection as _,
    protocol::{
        xproto::{
            BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ClientMessageEvent, ConnectionExt as _, EventMask,
            ImageFormat, InputFocus, KEY_PRESS_EVENT, KEY_RELEASE_EVENT, MOTION_NOTIFY_EVENT, MapState,
            Window,
        },
        xtest::ConnectionExt as _,
    },
    rust_connection::RustConnection,
};

use crate::display::{Display, Place, assert_quiet, finish, wait_for};

/// The window as the X server has it.
pub(crate) struct Touched {
    pub(crate) server: RustConnection,
    pub(crate) root: Window,
    pub(crate) window: Window,
}

impl Touched {
    /// Waits until the window is seen whose title ends in Ambray.
    pub(crate) fn find(display: &Display) -> Self {
        let (server, screen) = x11rb::connect(Some(&display.name)).expect("the server");
        let root = server.setup().roots[screen].root;
        let atom = |name: &[u8]| server.intern_atom(false, name).expect("sent").reply().expect("atom").atom;
        let (title, utf8) = (atom(b"_NET_WM_NAME"), atom(b"UTF8_STRING"));
        let is_seen = |window| {
            let state = server.get_window_attributes(window).expect("sent").reply();
            state.is_ok_and(|state| state.map_state == MapState::VIEWABLE)
        };
        let is_it = |window| {
            let property = server.get_property(false, window, title, utf8, 0, 64).expect("sent").reply();
            property.is_ok_and(|property| property.value.ends_with("Ambray".as_bytes()))
        };
        let window = wait_for("a window", || {
            let children = server.query_tree(root).expect("sent").reply().expect("windows").children;
            children.into_iter().find(|&window| is_it(window) && is_seen(window))
        });
        Self { server, root, window }
    }

    /// The window's title.
    pub(crate) fn title(&self) -> String {
        let (title, utf8) = (self.atom("_NET_WM_NAME"), self.atom("UTF8_STRING"));
        let property = self.server.get_property(false, self.window, title, utf8, 0, 1024).expect("sent");
        String::from_utf8(property.reply().expect("a title").value).expect("a title")
    }

    /// What is on the screen.
    fn pixels(&self) -> Vec<u8> {
        let size = self.server.get_geometry(self.window).expect("sent").reply().expect("size");
        let image = self.server.get_image(
            ImageFormat::Z_PIXMAP,
            self.window,
            0,
            0,
            size.width,
            size.height,
            u32::MAX,
        );
        image.expect("sent").reply().map(|image| image.data).unwrap_or_default()
    }

    /// Waits until the window shows the same for a second, and something other than `before`.
    pub(crate) fn settled(&self, before: &[u8]) -> Vec<u8> {
        let mut last = self.pixels();
        let mut same = 0;
        wait_for("another picture", || {
            thread::sleep(Duration::from_millis(100));
            let now = self.pixels();
            same = if now == last { same + 1 } else { 0 };
            last = now;
            (same >= 10 && changed(&last, before) > 0.005).then(|| last.clone())
        })
    }

    fn fake(&self, kind: u8, detail: u8, x: i16, y: i16) {
        self.server
            .xtest_fake_input(kind, detail, 0, self.root, x, y, 0)
            .expect("sent")
            .check()
            .expect("XTEST");
        self.server.flush().expect("sent");
        thread::sleep(Duration::from_millis(40));
    }

    /// Presses the key with the symbol `symbol`, with Shift if that is where it is.
    fn press(&self, symbol: u32) {
        let setup = self.server.setup();
        let (first, count) = (setup.min_keycode, setup.max_keycode - setup.min_keycode + 1);
        let mapping = self.server.get_keyboard_mapping(first, count).expect("sent").reply().expect("keys");
        let each = usize::from(mapping.keysyms_per_keycode);
        let key_of = |symbol: u32, level: usize| {
            let found = mapping.keysyms.chunks(each).position(|symbols| symbols.get(level) == Some(&symbol));
            found.map(|i| first + i as u8)
        };
        let shift = key_of(0xffe1, 0).expect("a Shift key");
        let (key, is_shifted) = match key_of(symbol, 0) {
            Some(key) => (key, false),
            None => (key_of(symbol, 1).expect("the key"), true),
        };
        if is_shifted {
            self.fake(KEY_PRESS_EVENT, shift, 0, 0);
        }
        self.fake(KEY_PRESS_EVENT, key, 0, 0);
        self.fake(KEY_RELEASE_EVENT, key, 0, 0);
        if is_shifted {
            self.fake(KEY_RELEASE_EVENT, shift, 0, 0);
        }
    }

    fn drag(&self, (x, y): (i16, i16), (dx, dy): (i16, i16)) {
        self.fake(MOTION_NOTIFY_EVENT, 0, x, y);
        self.fake(BUTTON_PRESS_EVENT, 1, 0, 0);
        for i in 1..=8 {
            self.fake(MOTION_NOTIFY_EVENT, 0, x + dx * i / 8, y + dy * i / 8);
        }
        self.fake(BUTTON_RELEASE_EVENT, 1, 0, 0);
    }

    /// Asks the window to close, as a click on its cross does.
    pub(crate) fn close(&self) {
        self.tell("WM_PROTOCOLS", [self.atom("WM_DELETE_WINDOW"), x11rb::CURRENT_TIME, 0, 0, 0]);
    }

    pub(crate) fn atom(&self, name: &str) -> u32 {
        self.server.intern_atom(false, name.as_bytes()).expect("sent").reply().expect("atom").atom
    }

    /// Sends the window a message.
    pub(crate) fn tell(&self, message: &str, data: [u32; 5]) {
        let message = ClientMessageEvent::new(32, self.window, self.atom(message), data);
        // Waits for the server: what a client that is gone had sent may be lost.
        let sent = self.server.send_event(false, self.window, EventMask::NO_EVENT, message);
        sent.expect("sent").check().expect("taken");
    }
}

/// Share of the bytes that differ.
fn changed(a: &[u8], b: &[u8]) -> f64 {
    if a.len() != b.len() {
        return 1.0;
    }
    a.iter().zip(b).filter(|(a, b)| a != b).count() as f64 / a.len() as f64
}

#[test]
fn keys_the_mouse_and_the_cross_of_the_window_work() {
    let Some(display) = Display::start() else { return };
    let place = Place::new();
    let mut command = place.view(&display, &["--backend", "cpu", "--spp=1", "--memory", "memory/view.toml"]);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts");
    let window = Touched::find(&display);
    // What a window manager would do: without the focus no keys arrive.
    let focus = window.server.set_input_focus(InputFocus::PARENT, window.window, x11rb::CURRENT_TIME);
    focus.expect("sent").check().expect("focus");
    let first = window.settled(&[]);
    // The picture is in the middle. Keys go where the pointer is: there is no window manager.
    window.fake(MOTION_NOTIFY_EVENT, 0, 720, 450);
    window.press(u32::from(b'?'));
    let help = window.settled(&first);
    window.press(u32::from(b'?'));
    let closed = window.settled(&help);
    window.drag((720, 450), (160, 40));
    let turned = window.settled(&closed);
    assert!(changed(&turned, &closed) > 0.1, "a drag turns the camera");
    window.close();
    assert_quiet(&finish(child));
    let memory = std::fs::read_to_string(place.path("memory/view.toml")).expect("what was remembered");
    assert!(memory.contains("width = 1440"), "{memory}");
}

#[test]
fn a_script_whose_window_is_closed_has_failed() {
    let Some(display) = Display::start() else { return };
    let place = Place::new();
    std::fs::write(place.path("walk.txt"), "set spp 60000\nwait\nscreenshot never.png\n").expect("script");
    let arguments = ["--script", "walk.txt", "--backend", "cpu"];
    let mut command = place.view(&display, &arguments);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts");
    Touched::find(&display).close();
    let output = finish(child);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains(": the window was closed here, before the script was done"), "{said}");
}
