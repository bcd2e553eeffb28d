//! What all connections share: the pages, which of them drives, and what it sends to the leg.

use leg_firmware::frame::MAX_FRAME;
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;
use tungstenite::Message;

/// Messages that wait for a page; one that reads none of them is dropped.
pub const WAITING_MAX: usize = 1000;

/// Messages of pages that wait for the leg; what comes beyond them is lost, as on a line.
pub const FRAMES_MAX: usize = 32;

/// Whether a page drives the leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Role {
    /// This one does.
    drives: bool,
    /// Another one does.
    other_drives: bool,
}

/// Frames of a page on their way to the leg.
pub struct Frames {
    pub page: u64,
    pub at: Instant,
    pub bytes: Vec<u8>,
}

/// What all connections share.
pub struct Pages {
    pub introduction: String,
    next_id: u64,
    pub senders: BTreeMap<u64, SyncSender<Message>>,
    pub driver: Option<u64>,
    frames: SyncSender<Frames>,
    pub stops: Arc<AtomicBool>,
}

impl Pages {
    pub fn new(introduction: String) -> (Self, Receiver<Frames>) {
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
    pub fn add(&mut self) -> (u64, Receiver<Message>) {
        let (sender, messages) = sync_channel(WAITING_MAX);
        let id = self.next_id;
        self.next_id += 1;
        // There is room for it.
        let _ = sender.try_send(Message::text(self.introduction.clone()));
        self.senders.insert(id, sender);
        self.tell_roles();
        (id, messages)
    }

    pub fn remove(&mut self, id: u64) {
        self.senders.remove(&id);
        self.release(id);
    }

    /// Sends a message to all pages. One that has no room for it is dropped: its connection ends, and another may drive.
    pub fn send(&mut self, message: &Message) {
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
    pub fn take(&mut self, page: u64, message: Message) -> bool {
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

/// Nothing is left half done where a thread panics with the lock.
pub fn lock(pages: &Mutex<Pages>) -> MutexGuard<'_, Pages> {
    pages.lock().unwrap_or_else(PoisonError::into_inner)
}

pub fn json(message: &impl Serialize) -> String {
    // Text and truth values always have a form in JSON.
    serde_json::to_string(message).unwrap_or_default()
}
