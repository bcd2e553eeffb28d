#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{Bridge, NO_NUMBER, STOP_NUMBER, STOP_TIME};
use crate::ui::link::PageHello;
use crate::ui::link::tests::{add, frames, link, word};
use leg_firmware::command::CommandRefusal;
use leg_firmware::frame::{self, Decoder, MAX_FRAME};
use leg_firmware::host_link::{HostId, HostRefusal, HostReply, HostRequest};
use leg_firmware::supervisor::State;
use leg_host::transport::Transport;
use std::io::{self, ErrorKind};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// A command of the page, as bytes that the line does not understand.
const PAGE_FRAME: [u8; 2] = [7, 0];

const HOST: HostId = 9;

/// A leg that answers when it has been told to stop so often, and what it was sent.
struct Line {
    answer: (u16, HostReply),
    answered_stop: usize,
    stopped: Vec<Instant>,
    page_frames: usize,
    answers: Vec<u8>,
}

impl Line {
    fn new(answer: (u16, HostReply), answered_stop: usize) -> Self {
        Self {
            answer,
            answered_stop,
            stopped: Vec::new(),
            page_frames: 0,
            answers: Vec::new(),
        }
    }
}

impl Transport for Line {
    fn name(&self) -> &str {
        "line"
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.page_frames += usize::from(bytes == PAGE_FRAME);
        Ok(())
    }

    fn send_urgent(&mut self, bytes: &[u8]) -> io::Result<()> {
        let mut decoder = Decoder::new();
        let (last, first) = bytes.split_last().unwrap();
        assert!(first.iter().all(|byte| decoder.push(*byte).is_none()));
        let frame = decoder.push(*last).unwrap().unwrap();
        assert_eq!(frame.sequence, STOP_NUMBER);
        let stop = HostRequest::Command {
            host: HOST,
            command: super::Command::Stop,
        };
        assert_eq!(frame.message(), Some(stop));
        self.stopped.push(Instant::now());
        if self.stopped.len() == self.answered_stop {
            let (number, reply) = &self.answer;
            let mut out = [0; MAX_FRAME];
            self.answers = frame::encode(*number, reply, &mut out).unwrap().to_vec();
        }
        Ok(())
    }

    fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize> {
        if self.answers.is_empty() {
            sleep(timeout);
            return Err(ErrorKind::TimedOut.into());
        }
        let count = self.answers.len();
        bytes[..count].copy_from_slice(&self.answers);
        self.answers.clear();
        Ok(count)
    }
}

/// What a leg is sent in some time in which its page asks for a stop and then goes on commanding.
fn heard(mut line: Line, time: Duration) -> Line {
    let link = link();
    let (page, _heard) = add(&link);
    word(&link, page, "drive");
    let mut bridge = Bridge {
        transport: &mut line,
        pages: &link,
        hello: PageHello {
            schema: String::new(),
            name: String::new(),
            rig: String::new(),
        },
        host: HOST,
        decoder: Decoder::new(),
        heard: None,
        stopped: None,
    };
    word(&link, page, "stop");
    let begun = Instant::now();
    while begun.elapsed() < time {
        frames(&link, page, &PAGE_FRAME);
        bridge.turn().unwrap();
    }
    line
}

/// Until the leg has answered that very stop, and no command of the page is passed on before it has.
#[test]
fn a_stop_of_a_page_is_repeated_until_the_leg_has_answered() {
    const ANSWERED: usize = 3;
    let time = 8 * STOP_TIME;
    let held = HostRefusal::Command(CommandRefusal::State(State::RampingDown));
    for reply in [HostReply::Done, HostReply::Refused(held)] {
        let line = heard(Line::new((STOP_NUMBER, reply), ANSWERED), time);
        assert_eq!(line.stopped.len(), ANSWERED);
        for pair in line.stopped.windows(2) {
            assert!(pair[1] - pair[0] > STOP_TIME);
        }
        assert!(line.page_frames > 0, "nothing goes on");
    }
    let line = heard(Line::new((NO_NUMBER, HostReply::Done), 1), time);
    assert!(line.stopped.len() > 2, "{}", line.stopped.len());
    assert_eq!(line.page_frames, 0);
}
