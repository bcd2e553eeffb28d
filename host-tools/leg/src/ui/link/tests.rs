#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::pages::{FRAMES_MAX, Pages, WAITING_MAX};
use super::{FRESH_TIME, PageHello, PageLink, token};
use leg_firmware::frame::MAX_FRAME;
use std::sync::atomic::AtomicUsize;
use std::sync::mpsc::Receiver;
use std::sync::{Arc, Mutex};
use std::thread::sleep;
use std::time::Duration;
use tungstenite::Message;

/// A link without a socket.
pub fn link() -> PageLink {
    let (pages, frames) = Pages::new("{}".into());
    PageLink {
        address: ([127, 0, 0, 1], 0).into(),
        token: String::new(),
        stops: Arc::clone(&pages.stops),
        pages: Arc::new(Mutex::new(pages)),
        frames,
        open: Arc::new(AtomicUsize::new(0)),
    }
}

pub fn add(link: &PageLink) -> (u64, Receiver<Message>) {
    link.pages.lock().unwrap().add()
}

fn take(link: &PageLink, page: u64, message: Message) -> bool {
    link.pages.lock().unwrap().take(page, message)
}

pub fn word(link: &PageLink, page: u64, word: &'static str) {
    assert!(take(link, page, Message::text(word)));
}

pub fn frames(link: &PageLink, page: u64, bytes: &[u8]) -> bool {
    take(link, page, Message::binary(bytes.to_vec()))
}

/// The last thing that a page was told.
fn told(messages: &Receiver<Message>) -> String {
    messages.try_iter().last().unwrap().to_string()
}

#[test]
fn only_the_page_that_drives_is_passed_on() {
    let link = link();
    let [(one, heard), (other, heard_too)] = [add(&link), add(&link)];
    assert!(frames(&link, one, &[1, 0]));
    assert_eq!(link.next_frames(), None);
    word(&link, one, "drive");
    word(&link, other, "drive");
    assert_eq!(told(&heard), r#"{"drives":true,"other_drives":false}"#);
    assert_eq!(told(&heard_too), r#"{"drives":false,"other_drives":true}"#);
    assert!(frames(&link, other, &[2, 0]) && frames(&link, one, &[3, 0]));
    assert_eq!(link.next_frames(), Some(vec![3, 0]));
    assert_eq!(link.next_frames(), None);
    // What waits of a page that has gone is not sent.
    assert!(frames(&link, one, &[4, 0]));
    link.pages.lock().unwrap().remove(one);
    word(&link, other, "drive");
    assert_eq!(link.next_frames(), None);
    assert_eq!(told(&heard_too), r#"{"drives":true,"other_drives":false}"#);
}

#[test]
fn what_has_waited_for_long_is_not_sent() {
    // As SAFETY.md says.
    assert_eq!(FRESH_TIME, Duration::from_millis(100));
    let link = link();
    let (page, _heard) = add(&link);
    word(&link, page, "drive");
    assert!(frames(&link, page, &[1, 0]));
    sleep(FRESH_TIME);
    assert!(frames(&link, page, &[2, 0]));
    assert_eq!(link.next_frames(), Some(vec![2, 0]));
    for _ in 0..2 * FRAMES_MAX {
        assert!(frames(&link, page, &[3, 0]));
    }
    assert!((0..FRAMES_MAX).all(|_| link.next_frames().is_some()));
    assert_eq!(link.next_frames(), None);
}

#[test]
fn a_stop_of_any_page_forgets_what_was_commanded_before() {
    let link = link();
    let [(driving, _heard), (watching, _heard_too)] = [add(&link), add(&link)];
    word(&link, driving, "drive");
    assert!(frames(&link, driving, &[1, 0]));
    word(&link, watching, "stop");
    assert!(link.take_stop());
    assert!(!link.take_stop());
    assert_eq!(link.next_frames(), None);
}

#[test]
fn what_is_no_frame_ends_the_connection() {
    let link = link();
    let (page, _heard) = add(&link);
    let long = [vec![1; MAX_FRAME], vec![0]].concat();
    for bytes in [&[1, 2][..], &[], &long] {
        assert!(!frames(&link, page, bytes), "{} bytes", bytes.len());
    }
    assert!(!take(&link, page, Message::text("fly")));
    assert!(frames(&link, page, &[1, 0, 2, 0]));
}

#[test]
fn a_page_that_does_not_read_drives_no_longer() {
    let link = link();
    let [(deaf, messages), (other, heard)] = [add(&link), add(&link)];
    word(&link, deaf, "drive");
    for _ in 0..WAITING_MAX {
        link.send(&[1, 0]);
        // The other one reads.
        let _ = heard.try_iter().count();
    }
    assert!(!link.pages.lock().unwrap().senders.contains_key(&deaf));
    assert_eq!(link.pages.lock().unwrap().driver, None);
    // Its connection ends when it has what waits.
    let _ = messages.try_iter().count();
    assert!(messages.recv().is_err());
    word(&link, other, "drive");
    assert_eq!(told(&heard), r#"{"drives":true,"other_drives":false}"#);
}

#[test]
fn a_page_that_comes_later_is_told_of_the_leg_as_it_is_then() {
    let link = link();
    let (_, before) = add(&link);
    let hello = |rig: &str| PageHello {
        schema: "0123".into(),
        name: "sim".into(),
        rig: rig.into(),
    };
    link.introduce(hello("[later]"));
    let (_, after) = add(&link);
    assert_eq!(before.try_iter().next().unwrap().to_string(), "{}");
    let first = after.try_iter().next().unwrap().to_string();
    assert!(first.contains("[later]"), "{first}");
}

/// 128 bits, each of which is once set and once not among 64: chance breaks that once in 10¹⁶ runs.
#[test]
fn every_bit_of_a_token_is_random() {
    let tokens: Vec<u128> = (0..64)
        .map(|_| {
            let digits = token().unwrap();
            assert_eq!(digits.len(), 32, "{digits}");
            u128::from_str_radix(&digits, 16).unwrap()
        })
        .collect();
    let ever_set = tokens.iter().fold(0, |bits, token| bits | token);
    let always_set = tokens.iter().fold(u128::MAX, |bits, token| bits & token);
    assert_eq!((ever_set, always_set), (u128::MAX, 0));
}
