//! The Chrome DevTools protocol: numbered calls and their answers, and events in between, as JSON over a web socket.

use std::{net::TcpStream, time::Duration};

use serde_json::{Value, json};
use tungstenite::{Message, WebSocket};

use super::dial;

/// A connection to the browser or to one of its pages.
#[derive(Debug)]
pub(super) struct Connection {
    socket: WebSocket<TcpStream>,
    /// Number of the last call.
    last: u64,
    /// Events that have come, in order.
    pub(super) events: Vec<Event>,
}

/// Something that the browser tells unasked.
#[derive(Clone, Debug)]
pub(super) struct Event {
    /// What kind, such as `Page.loadEventFired`.
    pub(super) method: String,
    /// What about.
    pub(super) params: Value,
}

impl Connection {
    /// One to the debugger at `address`, which must answer within `patience`.
    pub(super) fn new(address: &str, patience: Duration) -> Self {
        let stream = dial(address);
        stream.set_read_timeout(Some(patience)).expect("a timeout");
        stream.set_nodelay(true).expect("an option of a socket");
        let (mut socket, _) = tungstenite::client(address, stream).expect("a web socket");
        // Screenshots are large.
        socket.set_config(|config| {
            config.max_message_size = None;
            config.max_frame_size = None;
        });
        Self { socket, last: 0, events: Vec::new() }
    }

    /// Calls `method` and waits for its answer.
    ///
    /// # Panics
    /// If the browser says that the call is wrong, or does not answer.
    pub(super) fn call(&mut self, method: &str, params: Value) -> Value {
        self.last += 1;
        let id = self.last;
        let text = json!({ "id": id, "method": method, "params": params }).to_string();
        self.socket.send(Message::text(text)).unwrap_or_else(|error| panic!("{method}: {error}"));
        loop {
            let mut message = self.receive(method);
            if message["id"] == id {
                assert!(message["error"].is_null(), "{method}: {}", message["error"]);
                return message["result"].take();
            }
            self.keep(message);
        }
    }

    /// Calls `method` if the browser still hears, and does not wait.
    pub(super) fn tell(&mut self, method: &str) {
        self.last += 1;
        let text = json!({ "id": self.last, "method": method }).to_string();
        let _ = self.socket.send(Message::text(text));
    }

    /// Waits for the next event `method`.
    pub(super) fn wait_for(&mut self, method: &str) {
        loop {
            let message = self.receive(method);
            let is_awaited = message["method"] == method;
            self.keep(message);
            if is_awaited {
                return;
            }
        }
    }

    fn receive(&mut self, what: &str) -> Value {
        loop {
            let message = self.socket.read().unwrap_or_else(|error| panic!("waiting for {what}: {error}"));
            if let Message::Text(text) = message {
                return serde_json::from_str(&text).expect("the browser speaks JSON");
            }
        }
    }

    fn keep(&mut self, mut message: Value) {
        let params = message["params"].take();
        if let Some(method) = message["method"].as_str() {
            self.events.push(Event { method: method.to_owned(), params });
        }
    }
}
