//! WebSockets to the pages that show a leg: all of them hear it, one of them drives it.
//!
//! Text is about the connection: the server sends [`Hello`], [`Role`] after each change of it, and [`Lost`]; a page sends `drive`,
//! `release` or `stop`. Bytes are whole frames of the leg's own protocol. Those of a page that does not drive are not passed on.

use serde::Serialize;
use std::collections::BTreeMap;
use std::io::{self, ErrorKind};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::mpsc::{Receiver, Sender, SyncSender, TrySendError, channel, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;
use tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tungstenite::http::StatusCode;
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Error, Message, WebSocket, accept_hdr_with_config};

/// Longest message of a page: some frames.
const MESSAGE_MAX: usize = 16 * 1024;

/// Messages that wait for a page; one that reads none of them is dropped.
const WAITING_MAX: usize = 1000;

/// Pages at a time.
const PAGES_MAX: usize = 16;

/// Longest time in which a page has to introduce itself, and to take a message.
const PATIENCE: Duration = Duration::from_secs(5);

/// From one look at what a page sends to the next at what it is sent.
const TURN_TIME: Duration = Duration::from_millis(5);

/// What a page is told first.
#[derive(Clone, Debug, Serialize)]
pub struct Hello {
    /// The schema of the leg's protocol, as hexadecimal digits: a page of another version must not guess.
    pub schema: String,
    /// What the leg is on.
    pub name: String,
    /// Its settings, as a rig file.
    pub rig: String,
}

/// Whether a page drives the leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Role {
    /// This one does.
    pub drives: bool,
    /// Another one does.
    pub other_drives: bool,
}

/// The connection to the leg has ended.
#[derive(Clone, Debug, Serialize)]
pub struct Lost {
    /// Why.
    pub lost: String,
}

/// What a page may say of the connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PageWord {
    /// It wants to drive; granted if no other does.
    Drive,
    /// It does no longer.
    Release,
    /// The leg is to be stopped, whoever drives it.
    Stop,
}

impl PageWord {
    fn new(text: &str) -> Option<Self> {
        match text {
            "drive" => Some(Self::Drive),
            "release" => Some(Self::Release),
            "stop" => Some(Self::Stop),
            _ => None,
        }
    }
}

/// What pages ask of the leg.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PageRequest {
    /// Whole frames of the one that drives.
    Frames(Vec<u8>),
    /// A stop.
    Stop,
}

/// What all connections share.
struct Pages {
    hello: String,
    next_id: u64,
    senders: BTreeMap<u64, SyncSender<Message>>,
    driver: Option<u64>,
    requests: Sender<PageRequest>,
}

/// The server's end.
pub struct PageLink {
    address: SocketAddr,
    token: String,
    pages: Arc<Mutex<Pages>>,
    requests: Receiver<PageRequest>,
}

impl PageLink {
    /// Waits for pages on a free port of the loopback address, in a thread that lasts as long as the process. Only pages from
    /// `origin` are accepted, and only by the address that [`Self::url`] gives.
    ///
    /// # Errors
    /// What the system says when it has no port, or no randomness.
    pub fn listen(origin: &str, hello: &Hello) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
        let address = listener.local_addr()?;
        let token = token()?;
        let (sender, requests) = channel();
        let pages = Arc::new(Mutex::new(Pages {
            hello: json(&Tagged { hello }),
            next_id: 0,
            senders: BTreeMap::new(),
            driver: None,
            requests: sender,
        }));
        let door = Door {
            path: format!("/{token}"),
            origin: origin.into(),
        };
        let shared = Arc::clone(&pages);
        thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let (pages, door) = (Arc::clone(&shared), door.clone());
                // A page that goes, or is refused, is no failure of the link.
                thread::spawn(move || {
                    if let Some(socket) = door.admit(stream) {
                        serve(socket, &pages);
                    }
                });
            }
        });
        Ok(Self {
            address,
            token,
            pages,
            requests,
        })
    }

    /// Where a page connects to. Whoever knows it can drive the leg.
    #[must_use]
    pub fn url(&self) -> String {
        format!("ws://{}/{}", self.address, self.token)
    }

    /// The next request of a page; none if there is none.
    #[must_use]
    pub fn request(&self) -> Option<PageRequest> {
        self.requests.try_recv().ok()
    }

    /// Sends bytes of the leg to all pages.
    pub fn send(&self, bytes: &[u8]) {
        lock(&self.pages).send(&Message::binary(bytes.to_vec()));
    }

    /// Tells all pages that the leg is lost.
    pub fn send_lost(&self, lost: String) {
        lock(&self.pages).send(&Message::text(json(&Lost { lost })));
    }
}

/// A message with its name.
#[derive(Serialize)]
struct Tagged<'a> {
    hello: &'a Hello,
}

/// Who is let in.
#[derive(Clone)]
struct Door {
    path: String,
    origin: String,
}

impl Door {
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
    /// Takes a page in; none if there are too many.
    fn add(&mut self) -> Option<(u64, Receiver<Message>)> {
        if self.senders.len() >= PAGES_MAX {
            return None;
        }
        let (sender, messages) = sync_channel(WAITING_MAX);
        let id = self.next_id;
        self.next_id += 1;
        self.senders.insert(id, sender);
        Some((id, messages))
    }

    fn remove(&mut self, id: u64) {
        self.senders.remove(&id);
        self.release(id);
    }

    fn send(&mut self, message: &Message) {
        self.senders.retain(|_, sender| {
            !matches!(
                sender.try_send(message.clone()),
                Err(TrySendError::Full(_) | TrySendError::Disconnected(_))
            )
        });
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
    fn take(&mut self, id: u64, message: &Message) -> bool {
        match message {
            Message::Text(text) => match PageWord::new(text) {
                Some(PageWord::Drive) => self.drive(id),
                Some(PageWord::Release) => self.release(id),
                Some(PageWord::Stop) => return self.requests.send(PageRequest::Stop).is_ok(),
                None => return false,
            },
            Message::Binary(bytes) if self.driver == Some(id) => {
                // Parts of frames would be mixed with those of the next driver.
                let whole = bytes.last() == Some(&0);
                let frames = PageRequest::Frames(bytes.to_vec());
                return whole && self.requests.send(frames).is_ok();
            }
            Message::Close(_) => return false,
            _ => {}
        }
        true
    }
}

/// Passes on what a page and the leg send each other, until one of them ends.
fn serve(mut socket: WebSocket<TcpStream>, pages: &Mutex<Pages>) {
    let Some((id, messages)) = lock(pages).add() else {
        return;
    };
    let hello = lock(pages).hello.clone();
    if socket.send(Message::text(hello)).is_ok() {
        lock(pages).tell_roles();
        while turn(&mut socket, &messages, |message| {
            lock(pages).take(id, message)
        }) {}
    }
    lock(pages).remove(id);
}

/// Sends what waits, and takes what has come; false if the connection has ended.
fn turn(
    socket: &mut WebSocket<TcpStream>,
    messages: &Receiver<Message>,
    mut take: impl FnMut(&Message) -> bool,
) -> bool {
    for message in messages.try_iter() {
        if socket.write(message).is_err() {
            return false;
        }
    }
    let flushed = socket.flush();
    if flushed.is_err_and(|error| !is_idle(&error)) {
        return false;
    }
    match socket.read() {
        Ok(message) => take(&message),
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
    Ok(leg_base::description::hex(&bytes))
}
