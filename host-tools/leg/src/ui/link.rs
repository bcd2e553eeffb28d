//! WebSockets to the pages that show a leg: all of them hear it, one of them drives it.
//!
//! Text is about the connection: the server sends [`Introduction`], [`Role`](pages::Role) after each change of it, and [`Lost`]; a page sends
//! `drive`, `release` or `stop`. Bytes are whole frames of the leg's own protocol. Those of a page that does not drive are not passed
//! on, nor those that have waited for long.

mod acceptor;
mod connection;
mod pages;

#[cfg(test)]
pub(super) mod tests;

use acceptor::Acceptor;
use connection::{PATIENCE, TURN_TIME};
use leg_base::description::hex;
use pages::{Frames, Pages, json, lock};
use serde::Serialize;
use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::Receiver;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};
use tungstenite::Message;

/// Time after which frames are too old to be sent: a leg must not do what was commanded before it last reported.
const FRESH_TIME: Duration = Duration::from_millis(100);

/// The first message to a page.
#[derive(Clone, Debug, Serialize)]
pub struct Introduction {
    pub hello: PageHello,
}

/// The leg.
#[derive(Clone, Debug, Serialize)]
pub struct PageHello {
    /// The schema of the leg's protocol, as hexadecimal digits: a page of another version must not guess.
    pub schema: String,
    /// What it is, or is on.
    pub name: String,
    /// Its settings, as a rig file.
    pub rig: String,
}

/// The connection to the leg has ended.
#[derive(Clone, Debug, Serialize)]
struct Lost<'a> {
    /// Why.
    lost: &'a str,
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
    pub fn listen(origin: &str, hello: PageHello) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
        let address = listener.local_addr()?;
        let token = token()?;
        let (pages, frames) = Pages::new(json(&Introduction { hello }));
        let stops = Arc::clone(&pages.stops);
        let pages = Arc::new(Mutex::new(pages));
        let open = Arc::new(AtomicUsize::new(0));
        let acceptor = Acceptor {
            path: format!("/{token}"),
            origin: origin.into(),
            pages: Arc::clone(&pages),
            open: Arc::clone(&open),
        };
        thread::Builder::new().spawn(move || acceptor.accept_all(&listener))?;
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

    /// Introduces the leg as it is now to pages that come from now on.
    pub fn introduce(&self, hello: PageHello) {
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

/// What nobody can guess.
fn token() -> io::Result<String> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(io::Error::other)?;
    Ok(hex(&bytes))
}
