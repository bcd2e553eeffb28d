//! The leg's end of the line in front of a leg that only takes notes.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod commands;
mod damage;
mod greeting;
mod mock;
mod recorder;
mod settings;
mod telemetry;

use super::{HostId, HostLink, HostRefusal, HostReply, HostRequest, Identity, ResetCause};
use crate::command::{Command, CommandRefusal};
use crate::frame::{Decoder, MAX_FRAME, encode};
use crate::host_link::{BoardKind, HOST_SCHEMA, Hello};
use crate::settings::Settings;
use mock::NotedLeg;

/// What a host hears: the number of its request, and the reply.
type Heard = Vec<(u16, HostReply)>;

const ONE: HostId = 1;
const OTHER: HostId = 2;

/// A link, the leg behind it and a host in front of it.
struct Line {
    link: HostLink,
    leg: NotedLeg,
    decoder: Decoder,
    asked: u16,
}

impl Line {
    fn new() -> Self {
        Self {
            link: HostLink::new(identity(), Settings::table_1().unwrap()),
            leg: NotedLeg::default(),
            decoder: Decoder::new(),
            asked: 100,
        }
    }

    /// A line whose host has said who it is.
    fn identified() -> Self {
        let mut line = Self::new();
        assert_eq!(line.ask(&identify()), HostReply::Identified(identity()));
        line
    }

    fn hears(&mut self, bytes: &[u8]) {
        self.link.receive(bytes, &mut self.leg);
    }

    /// Sends a request and returns its number.
    fn send(&mut self, request: &HostRequest) -> u16 {
        self.asked += 1;
        self.hears(&framed(self.asked, request));
        self.asked
    }

    fn command(&mut self, host: HostId, command: Command) -> u16 {
        self.send(&HostRequest::Command { host, command })
    }

    /// One tick of the leg, and what follows it.
    fn tick(&mut self) {
        self.leg.tick();
        self.link.report(&mut self.leg);
    }

    /// All that is on its way to the host: whole frames.
    fn heard(&mut self) -> Heard {
        let mut heard = Vec::new();
        while let Some(byte) = self.link.transmit() {
            if let Some(frame) = self.decoder.push(byte) {
                let frame = frame.unwrap();
                heard.push((frame.sequence, frame.message().unwrap()));
            }
        }
        heard
    }

    /// Sends a request that is answered at once.
    fn ask(&mut self, request: &HostRequest) -> HostReply {
        let number = self.send(request);
        match self.heard().as_slice() {
            [(told, reply)] if *told == number => reply.clone(),
            other => panic!("{request:?}: {other:?}"),
        }
    }

    /// Commands, ticks and returns the only answer.
    fn obey(&mut self, host: HostId, command: Command) -> HostReply {
        let number = self.command(host, command);
        self.tick();
        match self.heard().as_slice() {
            [(told, reply)] if *told == number => reply.clone(),
            other => panic!("{command:?}: {other:?}"),
        }
    }
}

fn framed(number: u16, request: &HostRequest) -> Vec<u8> {
    let mut out = [0; MAX_FRAME];
    encode(number, request, &mut out).unwrap().to_vec()
}

fn identity() -> Identity {
    Identity {
        board: BoardKind::InProcess,
        version: [1, 2, 3],
        reset: ResetCause::Emulated,
        crash_report: "once".parse().unwrap(),
    }
}

fn identify() -> HostRequest {
    HostRequest::Identify(Hello {
        schema: HOST_SCHEMA,
    })
}

/// Settings that differ from those that a line begins with.
fn others() -> Settings {
    let mut settings = Settings::table_1().unwrap();
    settings.pretension_n += 1.0;
    settings
}

fn refused(refusal: HostRefusal) -> HostReply {
    HostReply::Refused(refusal)
}

fn not_obeyed(refusal: CommandRefusal) -> HostReply {
    refused(HostRefusal::Command(refusal))
}
