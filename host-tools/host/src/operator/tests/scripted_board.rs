//! A board that answers as a test says.

use super::{hanging_leg, host};
use crate::cancel_flag::CancelFlag;
use crate::operator::{HostIdentity, Operator, OperatorError};
use crate::transport::Transport;
use leg_firmware::frame::{self, Decoder, MAX_FRAME};
use leg_firmware::host_link::{
    BoardKind, HostReply, HostRequest, Identity, ResetCause, TelemetryReport,
};
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;
use leg_firmware::version::VERSION;
use std::collections::VecDeque;
use std::io;
use std::time::Duration;

/// It sends nothing by itself; time, the leg's too, goes on only while its host waits.
struct ScriptedBoard<F> {
    answer: F,
    decoder: Decoder,
    answers: VecDeque<u8>,
    now: Duration,
}

impl<F: FnMut(u16, &HostRequest) -> Vec<(u16, HostReply)>> Transport for ScriptedBoard<F> {
    fn name(&self) -> &'static str {
        "a scripted board"
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        for &byte in bytes {
            let Some(Ok(frame)) = self.decoder.push(byte) else {
                continue;
            };
            let replies = (self.answer)(frame.sequence, &frame.message().unwrap());
            for (number, mut reply) in replies {
                if let HostReply::Telemetry(report) = &mut reply {
                    report.telemetry.tick = (self.now.as_secs_f64() * f64::from(TICK_HZ)) as u32;
                }
                let mut out = [0; MAX_FRAME];
                let reply = frame::encode(number, &reply, &mut out).unwrap();
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

/// A host of a board that answers everything so, introductions, too.
pub fn scripted_from_start(
    mut answer: impl FnMut(&HostRequest) -> Option<HostReply> + 'static,
) -> Result<Operator, OperatorError> {
    scripted_by_number(move |number, request| {
        let reply = answer(request);
        reply.map(|reply| (number, reply)).into_iter().collect()
    })
}

/// The same; each reply has the number of the request that it answers, be it an earlier one.
pub fn scripted_by_number(
    answer: impl FnMut(u16, &HostRequest) -> Vec<(u16, HostReply)> + 'static,
) -> Result<Operator, OperatorError> {
    let board = ScriptedBoard {
        answer,
        decoder: Decoder::new(),
        answers: VecDeque::new(),
        now: Duration::ZERO,
    };
    Operator::open(Box::new(board), HostIdentity::FIXED, CancelFlag::default())
}

/// A host of a board that knows it, and answers everything else so.
pub fn scripted(mut answer: impl FnMut(&HostRequest) -> Option<HostReply> + 'static) -> Operator {
    scripted_from_start(move |request| match request {
        HostRequest::Identify(_) => Some(introduction()),
        request => answer(request),
    })
    .unwrap()
}

/// What such a board says of itself.
pub fn introduction() -> HostReply {
    HostReply::Identified(Identity {
        board: BoardKind::InProcess,
        version: VERSION,
        reset: ResetCause::Emulated,
        crash_report: heapless::String::new(),
    })
}

/// The telemetry of a homed leg at rest, and its settings.
pub fn resting_leg() -> (Telemetry<f32>, Settings) {
    let leg = hanging_leg();
    let mut operator = host(&leg, 1);
    let telemetry = operator.telemetry().unwrap().telemetry;
    (telemetry, operator.settings().unwrap())
}

pub fn telemetry_reply(telemetry: &Telemetry<f32>) -> HostReply {
    HostReply::Telemetry(TelemetryReport {
        number: 0,
        telemetry: *telemetry,
    })
}
