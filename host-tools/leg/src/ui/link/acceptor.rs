//! Accepts connections: of pages of this program, up to so many, each with a thread.

use super::connection::{PATIENCE, TURN_TIME, serve};
use super::pages::Pages;
use std::net::{TcpListener, TcpStream};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;
use tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tungstenite::http::StatusCode;
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{WebSocket, accept_hdr_with_config};

/// Longest message of a page: some frames.
const MESSAGE_MAX: usize = 16 * 1024;

/// Connections at a time.
const PAGES_MAX: usize = 16;

/// Pause after a connection that the system could not give.
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);

/// Accepts connections of pages.
#[derive(Clone)]
pub struct Acceptor {
    pub path: String,
    pub origin: String,
    pub pages: Arc<Mutex<Pages>>,
    pub open: Arc<AtomicUsize>,
}

impl Acceptor {
    /// Gives each connection a thread, up to so many. A page that goes, or is refused, is no failure of the link.
    pub fn accept_all(&self, listener: &TcpListener) {
        for stream in listener.incoming() {
            let Ok(stream) = stream else {
                thread::sleep(ACCEPT_PAUSE);
                continue;
            };
            if self.open.load(Ordering::Acquire) >= PAGES_MAX {
                continue;
            }
            self.open.fetch_add(1, Ordering::AcqRel);
            let acceptor = self.clone();
            let spawned = thread::Builder::new().spawn(move || {
                if let Some(socket) = acceptor.accept(stream) {
                    serve(socket, &acceptor.pages);
                }
                acceptor.open.fetch_sub(1, Ordering::AcqRel);
            });
            if spawned.is_err() {
                self.open.fetch_sub(1, Ordering::AcqRel);
            }
        }
    }

    fn accept(&self, stream: TcpStream) -> Option<WebSocket<TcpStream>> {
        stream.set_read_timeout(Some(PATIENCE)).ok()?;
        stream.set_write_timeout(Some(PATIENCE)).ok()?;
        stream.set_nodelay(true).ok()?;
        let config = WebSocketConfig::default()
            .max_message_size(Some(MESSAGE_MAX))
            .max_frame_size(Some(MESSAGE_MAX));
        // The refusal is tungstenite's, and large.
        #[allow(clippy::result_large_err, reason = "the type of the callback")]
        let check = |request: &Request, response: Response| {
            if self.accepts(request) {
                Ok(response)
            } else {
                let mut refusal = ErrorResponse::new(None);
                *refusal.status_mut() = StatusCode::FORBIDDEN;
                Err(refusal)
            }
        };
        let socket = accept_hdr_with_config(stream, check, Some(config)).ok()?;
        socket.get_ref().set_read_timeout(Some(TURN_TIME)).ok()?;
        Some(socket)
    }

    /// Whether a request has the address that was given out, and comes from this program's own page.
    fn accepts(&self, request: &Request) -> bool {
        let origin = request.headers().get("Origin");
        request.uri().path() == self.path
            && origin.is_some_and(|origin| origin.as_bytes() == self.origin.as_bytes())
    }
}
