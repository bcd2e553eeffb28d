//! WebSockets to the pages that show a leg: all of them hear it, one of them drives it.
//!
//! Text is about the connection: the server sends [`Introduction`], [`Role`] after each change of it, and [`Lost`]; a page sends
//! `drive`, `release` or `stop`. Bytes are whole frames of the leg's own protocol. Those of a page that does not drive are not passed
//! on, nor those that have waited for long.

use leg_base::description::hex;
use leg_firmware::frame::MAX_FRAME;
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::{self, ErrorKind};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};
use tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tungstenite::http::StatusCode;
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Error, Message, WebSocket, accept_hdr_with_config};

#[cfg(test)]
mod tests;

/// Longest message of a page: some frames.
const MESSAGE_MAX: usize = 16 * 1024;

/// Messages that wait for a page; one that reads none of them is dropped.
const WAITING_MAX: usize = 1000;

/// Messages of pages that wait for the leg; what comes beyond them is lost, as on a line.
const FRAMES_MAX: usize = 32;

/// Time after which frames are too old to be sent: a leg must not do what was commanded before it was last heard of.
const FRESH_TIME: Duration = Duration::from_millis(100);

/// Connections at a time.
const PAGES_MAX: usize = 16;

/// Longest time for a page to send something of its introduction, and to take a message.
const PATIENCE: Duration = Duration::from_secs(2);

/// From one look at what a page sends to the next at what it is sent.
const TURN_TIME: Duration = Duration::from_millis(5);

/// Pause after a connection that the system could not give.
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);

/// What a page is told first.
#[derive(Clone, Debug, Serialize)]
pub struct Introduction {
    pub hello: Hello,
}

/// The leg.
#[derive(Clone, Debug, Serialize)]
pub struct Hello {
    /// The schema of the leg's protocol, as hexadecimal digits: a page of another version must not guess.
    pub schema: String,
    /// What it is, or is on.
    pub name: String,
    /// Its settings, as a rig file.
    pub rig: String,
}

/// Whether a page drives the leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
struct Role {
    /// This one does.
    drives: bool,
    /// Another one does.
    other_drives: bool,
}

/// The connection to the leg has ended.
#[derive(Clone, Debug, Serialize)]
struct Lost<'a> {
    /// Why.
    lost: &'a str,
}

/// Frames of a page on their way to the leg.
struct Frames {
    page: u64,
    at: Instant,
    bytes: Vec<u8>,
}

/// What all connections share.
struct Pages {
    introduction: String,
    next_id: u64,
    senders: BTreeMap<u64, SyncSender<Message>>,
    driver: Option<u64>,
    frames: SyncSender<Frames>,
    stops: Arc<AtomicBool>,
}

/// The server's end.
pub struct PageLink {
    address: SocketAddr,
    token: String,
    pages: Arc<Mutex<Pages>>,
    frames: Receiver<Frames>,
    stops: Arc<AtomicBool>,
    open: Arc<AtomicUsize>,
}

impl PageLink {
    /// Waits for pages on a free port of the loopback address, in a thread that lasts as long as the process. Only pages from
    /// `origin` are accepted, and only by the address that [`Self::url`] gives.
    ///
    /// # Errors
    /// What the system says when it has no port, no thread or no randomness.
    pub fn listen(origin: &str, hello: Hello) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
        let address = listener.local_addr()?;
        let token = token()?;
        let (pages, frames) = Pages::new(json(&Introduction { hello }));
        let stops = Arc::clone(&pages.stops);
        let pages = Arc::new(Mutex::new(pages));
        let open = Arc::new(AtomicUsize::new(0));
        let door = Door {
            path: format!("/{token}"),
            origin: origin.into(),
            pages: Arc::clone(&pages),
            open: Arc::clone(&open),
        };
        thread::Builder::new().spawn(move || door.admit_all(&listener))?;
        Ok(Self {
            address,
            token,
            pages,
            frames,
            stops,
            open,
        })
    }

    /// Where a page connects to. Whoever knows it can drive the leg.
    #[must_use]
    pub fn url(&self) -> String {
        format!("ws://{}/{}", self.address, self.token)
    }

    /// Whether a page has asked for a stop since the last call. What was commanded before is forgotten then.
    #[must_use]
    pub fn take_stop(&self) -> bool {
        let stop = self.stops.swap(false, Ordering::AcqRel);
        if stop {
            while self.frames.try_recv().is_ok() {}
        }
        stop
    }

    /// The next frames of the page that drives; none if there are none that are fresh.
    #[must_use]
    pub fn next_frames(&self) -> Option<Vec<u8>> {
        let driver = lock(&self.pages).driver;
        let is_good =
            |frames: &Frames| driver == Some(frames.page) && frames.at.elapsed() < FRESH_TIME;
        self.frames
            .try_iter()
            .find(is_good)
            .map(|frames| frames.bytes)
    }

    /// Tells pages that come from now on of the leg as it is now.
    pub fn introduce(&self, hello: Hello) {
        lock(&self.pages).introduction = json(&Introduction { hello });
    }

    /// Sends bytes of the leg to all pages.
    pub fn send(&self, bytes: &[u8]) {
        lock(&self.pages).send(&Message::binary(bytes.to_vec()));
    }

    /// Tells all pages why the leg is lost, and ends their connections.
    pub fn close(&self, why: &str) {
        let lost = Message::text(json(&Lost { lost: why }));
        {
            let mut pages = lock(&self.pages);
            pages.send(&lost);
            // A connection ends when it has sent what waits.
            pages.senders.clear();
        }
        let begun = Instant::now();
        while self.open.load(Ordering::Acquire) > 0 && begun.elapsed() < PATIENCE {
            thread::sleep(TURN_TIME);
        }
    }
}

/// Who is let in.
#[derive(Clone)]
struct Door {
    path: String,
    origin: String,
    pages: Arc<Mutex<Pages>>,
    open: Arc<AtomicUsize>,
}

impl Door {
    /// Gives each connection a thread, up to so many. A page that goes, or is refused, is no failure of the link.
    fn admit_all(&self, listener: &TcpListener) {
        for stream in listener.incoming() {
            let Ok(stream) = stream else {
                thread::sleep(ACCEPT_PAUSE);
                continue;
            };
            if self.open.load(Ordering::Acquire) >= PAGES_MAX {
                continue;
            }
            self.open.fetch_add(1, Ordering::AcqRel);
            let door = self.clone();
            let spawned = thread::Builder::new().spawn(move || {
                if let Some(socket) = door.admit(stream) {
                    serve(socket, &door.pages);
                }
                door.open.fetch_sub(1, Ordering::AcqRel);
            });
            if spawned.is_err() {
                self.open.fetch_sub(1, Ordering::AcqRel);
            }
        }
    }

    fn admit(&self, stream: TcpStream) -> Option<WebSocket<TcpStream>> {
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

impl Pages {
    fn new(introduction: String) -> (Self, Receiver<Frames>) {
        let (sender, frames) = sync_channel(FRAMES_MAX);
        let pages = Self {
            introduction,
            next_id: 0,
            senders: BTreeMap::new(),
            driver: None,
            frames: sender,
            stops: Arc::new(AtomicBool::new(false)),
        };
        (pages, frames)
    }

    /// Takes a page in, and introduces the leg.
    fn add(&mut self) -> (u64, Receiver<Message>) {
        let (sender, messages) = sync_channel(WAITING_MAX);
        let id = self.next_id;
        self.next_id += 1;
        // There is room for it.
        let _ = sender.try_send(Message::text(self.introduction.clone()));
        self.senders.insert(id, sender);
        self.tell_roles();
        (id, messages)
    }

    fn remove(&mut self, id: u64) {
        self.senders.remove(&id);
        self.release(id);
    }

    /// Sends a message to all pages. One that has no room for it is dropped: its connection ends, and another may drive.
    fn send(&mut self, message: &Message) {
        let before = self.senders.len();
        self.senders
            .retain(|_, sender| sender.try_send(message.clone()).is_ok());
        if self.senders.len() < before
            && let Some(driver) = self.driver
            && !self.senders.contains_key(&driver)
        {
            self.release(driver);
        }
    }

    fn drive(&mut self, id: u64) {
        self.driver.get_or_insert(id);
        self.tell_roles();
    }

    fn release(&mut self, id: u64) {
        if self.driver == Some(id) {
            self.driver = None;
        }
        self.tell_roles();
    }

    fn tell_roles(&mut self) {
        for (id, sender) in &self.senders {
            let role = Role {
                drives: self.driver == Some(*id),
                other_drives: self.driver.is_some_and(|driver| driver != *id),
            };
            // One that has no room for it is dropped with the next bytes.
            let _ = sender.try_send(Message::text(json(&role)));
        }
    }

    /// Takes a message of a page; false ends the connection.
    fn take(&mut self, page: u64, message: Message) -> bool {
        match message {
            Message::Text(text) => match text.as_str() {
                "drive" => self.drive(page),
                "release" => self.release(page),
                "stop" => self.stops.store(true, Ordering::Release),
                _ => return false,
            },
            Message::Binary(bytes) => {
                if !are_frames(&bytes) {
                    return false;
                }
                if self.driver == Some(page) {
                    let frames = Frames {
                        page,
                        at: Instant::now(),
                        bytes: bytes.to_vec(),
                    };
                    // What finds no room is lost: the page asks again.
                    let _ = self.frames.try_send(frames);
                }
            }
            Message::Close(_) => return false,
            _ => {}
        }
        true
    }
}

/// Whether bytes are whole frames, none too long for any line: parts of one would be mixed with those of the next driver.
fn are_frames(bytes: &[u8]) -> bool {
    bytes.last() == Some(&0)
        && bytes
            .split(|byte| *byte == 0)
            .all(|frame| frame.len() < MAX_FRAME)
}

/// Passes on what a page and the leg send each other, until one of them ends.
fn serve(mut socket: WebSocket<TcpStream>, pages: &Mutex<Pages>) {
    let (id, messages) = lock(pages).add();
    while turn(&mut socket, &messages, |message| {
        lock(pages).take(id, message)
    }) {}
    lock(pages).remove(id);
    // The page learns that it has ended, if it is still there.
    let _ = socket.close(None);
    let _ = socket.flush();
}

/// Sends what waits, and takes what has come; false if the connection has ended.
fn turn(
    socket: &mut WebSocket<TcpStream>,
    messages: &Receiver<Message>,
    take: impl FnOnce(Message) -> bool,
) -> bool {
    let ended = loop {
        match messages.try_recv() {
            Ok(message) => {
                if socket.write(message).is_err() {
                    return false;
                }
            }
            Err(TryRecvError::Empty) => break false,
            Err(TryRecvError::Disconnected) => break true,
        }
    };
    if socket.flush().is_err_and(|error| !is_idle(&error)) || ended {
        return false;
    }
    match socket.read() {
        Ok(message) => take(message),
        Err(error) => is_idle(&error),
    }
}

/// Whether nothing has come in time.
fn is_idle(error: &Error) -> bool {
    let idle = [
        ErrorKind::WouldBlock,
        ErrorKind::TimedOut,
        ErrorKind::Interrupted,
    ];
    matches!(error, Error::Io(error) if idle.contains(&error.kind()))
}

/// Nothing is left half done where a thread panics with the lock.
fn lock(pages: &Mutex<Pages>) -> MutexGuard<'_, Pages> {
    pages.lock().unwrap_or_else(PoisonError::into_inner)
}

fn json(message: &impl Serialize) -> String {
    // Text and truth values always have a form in JSON.
    serde_json::to_string(message).unwrap_or_default()
}

/// What nobody can guess.
fn token() -> io::Result<String> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(io::Error::other)?;
    Ok(hex(&bytes))
}
