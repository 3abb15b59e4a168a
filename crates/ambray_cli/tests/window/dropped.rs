//! Files that are dropped on the window, as a file manager does it: XDND, version 5.

use std::{fs, path::Path, process::Stdio};

use x11rb::{
    COPY_FROM_PARENT, CURRENT_TIME,
    connection::Connection as _,
    protocol::{
        Event,
        xproto::{
            ConnectionExt as _, CreateWindowAux, EventMask, PropMode, SELECTION_NOTIFY_EVENT,
            SelectionNotifyEvent, SelectionRequestEvent, Window, WindowClass,
        },
    },
    wrapper::ConnectionExt as _,
};

use crate::{
    display::{Display, Place, assert_quiet, finish, wait_for},
    touched::Touched,
};

/// A file on its way from one window to the other.
struct Drag<'a> {
    to: &'a Touched,
    source: Window,
    uri: String,
}

impl<'a> Drag<'a> {
    fn begin(to: &'a Touched, file: &Path) -> Self {
        let source = to.server.generate_id().expect("a number");
        let (class, none) = (WindowClass::INPUT_OUTPUT, CreateWindowAux::new());
        let made = to.server.create_window(0, source, to.root, 0, 0, 1, 1, 0, class, COPY_FROM_PARENT, &none);
        made.expect("sent").check().expect("a window");
        let owned = to.server.set_selection_owner(source, to.atom("XdndSelection"), CURRENT_TIME);
        owned.expect("sent").check().expect("the selection");
        // The only character of temporary folders and our names that is not plain.
        let uri = format!("file://{}\r\n", file.display().to_string().replace(' ', "%20"));
        Self { to, source, uri }
    }

    /// Moves the file to the middle of the window and drops it there.
    fn drop(&self) {
        let to = self.to;
        to.tell("XdndEnter", [self.source, 5 << 24, to.atom("text/uri-list"), 0, 0]);
        let place = (400 << 16) | 300;
        to.tell("XdndPosition", [self.source, 0, place, CURRENT_TIME, to.atom("XdndActionCopy")]);
        self.answer(|event| match event {
            Event::SelectionRequest(request) => {
                self.give(request);
                true
            }
            _ => false,
        });
        to.tell("XdndDrop", [self.source, 0, CURRENT_TIME, 0, 0]);
        let finished = to.atom("XdndFinished");
        self.answer(|event| matches!(event, Event::ClientMessage(message) if message.type_ == finished));
    }

    /// Hands over which file it is.
    fn give(&self, request: &SelectionRequestEvent) {
        let server = &self.to.server;
        let SelectionRequestEvent { requestor, property, target, time, selection, .. } = *request;
        let put =
            server.change_property8(PropMode::REPLACE, requestor, property, target, self.uri.as_bytes());
        put.expect("sent").check().expect("a property");
        let response_type = SELECTION_NOTIFY_EVENT;
        let told =
            SelectionNotifyEvent { response_type, sequence: 0, time, requestor, selection, target, property };
        server.send_event(false, requestor, EventMask::NO_EVENT, told).expect("sent");
        server.flush().expect("sent");
    }

    /// Waits for an event that is the right one.
    fn answer(&self, mut is_it: impl FnMut(&Event) -> bool) {
        wait_for("an answer to the drag", || {
            let event = self.to.server.poll_for_event().expect("the server")?;
            is_it(&event).then_some(())
        });
    }
}

#[test]
fn a_file_that_is_dropped_is_opened_and_a_bad_one_leaves_the_scene() {
    let Some(display) = Display::start() else { return };
    let place = Place::new();
    let (good, bad) = (place.path("one triangle.obj"), place.path("broken.glb"));
    fs::write(&good, "v -1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("file");
    fs::write(&bad, "glTF, or rather not").expect("file");
    let mut command = place.view(&display, &["--backend", "cpu", "--spp=1", "--no-memory"]);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts");
    let window = Touched::find(&display);
    let atrium = window.settled(&[]);
    assert_eq!(window.title(), "atrium – Ambray");
    Drag::begin(&window, &good).drop();
    let triangle = window.settled(&atrium);
    assert!(window.title().ends_with("one triangle.obj – Ambray"), "{}", window.title());
    Drag::begin(&window, &bad).drop();
    // The words about it.
    window.settled(&triangle);
    assert!(window.title().ends_with("one triangle.obj – Ambray"), "{}", window.title());
    window.close();
    assert_quiet(&finish(child));
}
