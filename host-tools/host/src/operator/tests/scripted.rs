//! A board that answers as a test says.

use super::{emulated, host};
use crate::operator::{Host, Interrupt, Operator};
use crate::transport::Transport;
use leg_firmware::frame::{self, MAX_FRAME};
use leg_firmware::host_link::BoardKind;
use leg_firmware::host_link::{HostReply, HostRequest, Identity, Reset, Told};
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;
use leg_firmware::version::VERSION;
use leg_sim::emulated_leg::Beginning;
use std::collections::VecDeque;
use std::io;
use std::time::Duration;

/// It says nothing by itself; time goes on only while its host waits.
pub struct Scripted<F> {
    answer: F,
    decoder: frame::Decoder,
    answers: VecDeque<u8>,
    now: Duration,
}

impl<F: FnMut(&HostRequest) -> Option<HostReply>> Scripted<F> {
    pub fn new(answer: F) -> Self {
        Self {
            answer,
            decoder: frame::Decoder::new(),
            answers: VecDeque::new(),
            now: Duration::ZERO,
        }
    }
}

impl<F: FnMut(&HostRequest) -> Option<HostReply>> Transport for Scripted<F> {
    fn name(&self) -> &'static str {
        "a strange board"
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        for &byte in bytes {
            let Some(Ok(frame)) = self.decoder.push(byte) else {
                continue;
            };
            if let Some(reply) = (self.answer)(&frame.message().unwrap()) {
                let mut out = [0; MAX_FRAME];
                let reply = frame::encode(frame.sequence, &reply, &mut out).unwrap();
                self.answers.extend(reply);
            }
        }
        Ok(())
    }

    fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize> {
        if self.answers.is_empty() {
            self.now += timeout;
            return Err(io::ErrorKind::TimedOut.into());
        }
        io::Read::read(&mut self.answers, bytes)
    }

    fn now(&self) -> Duration {
        self.now
    }
}

/// A host of a board that knows it, and answers everything else so.
pub fn scripted(mut answer: impl FnMut(&HostRequest) -> Option<HostReply> + 'static) -> Operator {
    let board = Scripted::new(move |request: &HostRequest| match request {
        HostRequest::Identify(_) => Some(HostReply::Identified(identity())),
        request => answer(request),
    });
    Operator::open(Box::new(board), Host::FIXED, Interrupt::default()).unwrap()
}

pub fn identity() -> Identity {
    Identity {
        board: BoardKind::InProcess,
        version: VERSION,
        reset: Reset::Emulated,
        last_words: heapless::String::new(),
    }
}

/// What a homed leg at rest tells of itself, and its settings.
pub fn at_rest() -> (Telemetry<f32>, Settings) {
    let leg = emulated(Beginning::Hanging);
    let mut operator = host(&leg, 1);
    let telemetry = operator.telemetry().unwrap().telemetry;
    (telemetry, operator.settings().unwrap())
}

pub fn told(telemetry: &Telemetry<f32>) -> HostReply {
    HostReply::Telemetry(Told {
        number: 0,
        telemetry: *telemetry,
    })
}
