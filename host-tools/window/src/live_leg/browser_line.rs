//! A WebSocket of the browser.

use super::line::{Heard, Line, Said};
use js_sys::{ArrayBuffer, Uint8Array};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
use wasm_bindgen::JsCast;
use wasm_bindgen::closure::Closure;
use web_sys::{BinaryType, CloseEvent, MessageEvent, WebSocket};

/// Messages that are kept for a page that does not look at them, for it is hidden: some ten seconds of reports.
const WAITING_MAX: usize = 2000;

/// A line to a server.
pub struct BrowserLine {
    socket: WebSocket,
    heard: Rc<RefCell<Heap>>,
    // The browser calls them as long as the line lasts.
    _on_message: Closure<dyn FnMut(MessageEvent)>,
    _on_close: Closure<dyn FnMut(CloseEvent)>,
}

/// What has come.
#[derive(Default)]
struct Heap(VecDeque<Heard>);

impl Heap {
    fn put(&mut self, heard: Heard) {
        if self.0.len() >= WAITING_MAX {
            // What is said of the connection is said once, what the leg reports is outdated.
            self.0.retain(|kept| !matches!(kept, Heard::Bytes(_)));
        }
        self.0.push_back(heard);
    }
}

impl BrowserLine {
    /// Opens a line to an address.
    ///
    /// # Errors
    /// An address that is none, or that the browser does not allow.
    pub fn open(address: &str) -> Result<Self, String> {
        let socket = WebSocket::new(address).map_err(|error| format!("{error:?}"))?;
        socket.set_binary_type(BinaryType::Arraybuffer);
        let heard = Rc::new(RefCell::new(Heap::default()));
        let heap = Rc::clone(&heard);
        let on_message = Closure::new(move |event: MessageEvent| {
            if let Some(message) = message(&event) {
                heap.borrow_mut().put(message);
            }
        });
        let heap = Rc::clone(&heard);
        let on_close = Closure::new(move |event: CloseEvent| {
            heap.borrow_mut().put(Heard::Ended(reason(&event)));
        });
        socket.set_onmessage(Some(on_message.as_ref().unchecked_ref()));
        socket.set_onclose(Some(on_close.as_ref().unchecked_ref()));
        Ok(Self {
            socket,
            heard,
            _on_message: on_message,
            _on_close: on_close,
        })
    }
}

fn message(event: &MessageEvent) -> Option<Heard> {
    let data = event.data();
    if let Some(text) = data.as_string() {
        return Some(Heard::Text(text));
    }
    let bytes = data.dyn_into::<ArrayBuffer>().ok()?;
    Some(Heard::Bytes(Uint8Array::new(&bytes).to_vec()))
}

/// Browsers do not tell a page why there is no connection.
fn reason(event: &CloseEvent) -> String {
    match event.reason() {
        words if words.is_empty() => "`leg ui` has ended, or does not know this page".into(),
        words => words,
    }
}

impl Line for BrowserLine {
    fn heard(&mut self) -> Option<Heard> {
        self.heard.borrow_mut().0.pop_front()
    }

    fn say(&mut self, said: Said) {
        // A line that has ended has said so; a browser complains of what is said after that.
        if self.socket.ready_state() != WebSocket::OPEN {
            return;
        }
        let _ = match said {
            Said::Text(text) => self.socket.send_with_str(text),
            Said::Bytes(bytes) => self.socket.send_with_u8_array(&bytes),
        };
    }
}

impl Drop for BrowserLine {
    fn drop(&mut self) {
        self.socket.set_onmessage(None);
        self.socket.set_onclose(None);
        // It may be closed already.
        let _ = self.socket.close();
    }
}
