//! The leg's end of the line to a user's host: the same on the board, under QEMU and in the host's process.

mod messages;
mod outbox;

pub use messages::{
    BoardKind, CRASH_REPORT_MAX, HOST_SCHEMA, Hello, HostId, HostRefusal, HostReply, HostRequest,
    Identity, ResetCause, TelemetryReport,
};

use crate::command::Command;
use crate::frame::{Decoder, Frame, FrameError, MAX_FRAME};
use crate::jog::JogReport;
use crate::leg::CommandOutcome;
use crate::recorder::{RecorderReply, RecorderRequest};
use crate::sensors::SensorReading;
use crate::settings::Settings;
use crate::supervisor::State;
use crate::telemetry::Telemetry;
use outbox::Outbox;

#[cfg(test)]
mod tests;

/// A leg that a host can command.
pub trait CommandedLeg {
    /// Takes a command for a later tick; false if there is no room.
    fn command(&mut self, number: u16, command: Command) -> bool;
    /// Takes note of a frame that could not be read.
    fn note_decode_error(&mut self);
    /// What became of a command.
    fn outcome(&mut self) -> Option<CommandOutcome>;
    /// What the leg may do.
    fn state(&mut self) -> State;
    /// The leg after the last tick.
    fn telemetry(&mut self) -> Telemetry<f32>;
    /// What the last jog measured.
    fn jog_report(&mut self) -> Option<JogReport<f32>>;
    /// What the sensors read last.
    fn sensors(&mut self) -> SensorReading;
    /// Starts again with other settings and without its zero. Faults stay latched.
    ///
    /// # Errors
    /// [`HostRefusal::Driven`] and [`HostRefusal::Settings`]; the old settings stay in use.
    fn restart(&mut self, settings: &Settings) -> Result<(), HostRefusal>;
    /// Asks something of its recorder; `None` to a read while it records.
    fn recorder(&mut self, request: RecorderRequest) -> Option<RecorderReply>;
}

/// The leg's end of the line.
#[derive(Clone, Debug)]
pub struct HostLink {
    decoder: Decoder,
    outbox: Outbox,
    service: Service,
}

/// What there is beside the bytes.
#[derive(Clone, Debug)]
struct Service {
    identity: Identity,
    identified: bool,
    settings: Settings,
    /// Host of the last command that can set the leg in motion.
    driver: Option<HostId>,
    stream: Stream,
    waiting: Waiting,
}

/// What waits, by the number of its request. Flash is written at rest alone: neither begins beside the other.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Waiting {
    Nothing,
    /// A request to save, for [`HostLink::saved`].
    Save(u16),
    /// The last command that can set the leg in motion, to be executed.
    Begin(u16),
}

#[derive(Clone, Copy, Debug, Default)]
struct Stream {
    every_ticks: u16,
    last_tick: u32,
    number: u32,
}

impl HostLink {
    /// A line on which nothing was sent yet, to a leg with these settings.
    #[must_use]
    pub fn new(identity: Identity, settings: Settings) -> Self {
        Self {
            decoder: Decoder::new(),
            outbox: Outbox::new(),
            service: Service {
                identity,
                identified: false,
                settings,
                driver: None,
                stream: Stream::default(),
                waiting: Waiting::Nothing,
            },
        }
    }

    /// Takes bytes from the host.
    pub fn receive(&mut self, bytes: &[u8], leg: &mut impl CommandedLeg) {
        for &byte in bytes {
            let Some(found) = self.decoder.push(byte) else {
                continue;
            };
            let (number, result) = self.service.answer(found, leg);
            // By reference: a reply that holds settings takes a kilobyte of stack. Without room it is lost, and the host asks again.
            match &result {
                Ok(Some(reply)) => self.outbox.put(number, reply, 0),
                Ok(None) => {}
                Err(refusal) => self.outbox.refuse(number, *refusal),
            }
        }
    }

    /// Reports to the host what became of its commands, and streams telemetry if it asked for that. Called after each tick,
    /// or more seldom.
    pub fn report(&mut self, leg: &mut impl CommandedLeg) {
        while let Some(CommandOutcome { number, result }) = leg.outcome() {
            if self.service.waiting == Waiting::Begin(number) {
                self.service.waiting = Waiting::Nothing;
            }
            let reply = match result {
                Ok(()) => HostReply::Done,
                Err(refusal) => HostReply::Refused(HostRefusal::Command(refusal)),
            };
            self.outbox.put(number, &reply, 0);
        }
        if self.service.stream.every_ticks > 0 {
            self.stream(&leg.telemetry());
        }
    }

    fn stream(&mut self, telemetry: &Telemetry<f32>) {
        let stream = &mut self.service.stream;
        let due = telemetry.tick.wrapping_sub(stream.last_tick) >= u32::from(stream.every_ticks);
        if !due {
            return;
        }
        stream.last_tick = telemetry.tick;
        stream.number = stream.number.wrapping_add(1);
        let report = TelemetryReport {
            number: stream.number,
            telemetry: *telemetry,
        };
        // Replies go first: a full line costs telemetry.
        self.outbox.put(0, &HostReply::Telemetry(report), MAX_FRAME);
    }

    /// The next byte for the host.
    pub fn transmit(&mut self) -> Option<u8> {
        self.outbox.take()
    }

    /// The settings that the host asks to keep; [`Self::saved`] has to follow.
    #[must_use]
    pub fn unsaved_settings(&self) -> Option<&Settings> {
        self.service.saves().then_some(&self.service.settings)
    }

    /// Reports to the host whether its settings were kept.
    pub fn saved(&mut self, kept: bool) {
        if let Waiting::Save(number) = self.service.waiting {
            self.service.waiting = Waiting::Nothing;
            let reply = if kept {
                HostReply::Done
            } else {
                HostReply::Refused(HostRefusal::NotSaved)
            };
            self.outbox.put(number, &reply, 0);
        }
    }
}

impl Service {
    /// Whether settings are being saved.
    const fn saves(&self) -> bool {
        matches!(self.waiting, Waiting::Save(_))
    }

    /// The number of what the decoder found, and the reply to it, if that does not come later.
    fn answer(
        &mut self,
        found: Result<Frame<'_>, FrameError>,
        leg: &mut impl CommandedLeg,
    ) -> (u16, Result<Option<HostReply>, HostRefusal>) {
        let (number, result) = match found {
            Ok(frame) => {
                let result = match &frame.message() {
                    Some(HostRequest::SetSettings(settings)) => {
                        let set = self.set_settings(settings, leg);
                        set.map(|()| Some(HostReply::Done))
                    }
                    Some(request) => self.serve(frame.sequence, request, leg),
                    None => Err(HostRefusal::BadRequest),
                };
                (frame.sequence, result)
            }
            Err(error) => (0, Err(HostRefusal::BadFrame(error))),
        };
        if let Err(HostRefusal::BadFrame(_) | HostRefusal::BadRequest) = result {
            leg.note_decode_error();
        }
        (number, result)
    }

    /// Serves a request; no reply if that comes later.
    // Apart, so that the reply is made at its place.
    #[inline(never)]
    fn serve(
        &mut self,
        number: u16,
        request: &HostRequest,
        leg: &mut impl CommandedLeg,
    ) -> Result<Option<HostReply>, HostRefusal> {
        if let HostRequest::Identify(hello) = request {
            return self.identify(hello).map(Some);
        }
        if !self.identified {
            return Err(HostRefusal::NotIdentified);
        }
        Ok(Some(match *request {
            // Served by functions of their own.
            HostRequest::Identify(_) | HostRequest::SetSettings(_) => {
                return Err(HostRefusal::BadRequest);
            }
            HostRequest::Command { host, command } => {
                return self.command(number, host, command, leg);
            }
            HostRequest::Telemetry => HostReply::Telemetry(TelemetryReport {
                number: self.stream.number,
                telemetry: leg.telemetry(),
            }),
            HostRequest::Stream(every_ticks) => {
                self.stream.every_ticks = every_ticks;
                HostReply::Done
            }
            HostRequest::Sensors => HostReply::Sensors(leg.sensors()),
            HostRequest::JogReport => HostReply::Jog(leg.jog_report()),
            HostRequest::Recorder(request) => {
                let reply = leg.recorder(request).ok_or(HostRefusal::Recording)?;
                HostReply::Recorder(reply)
            }
            HostRequest::GetSettings => self.settings_reply(),
            HostRequest::SaveSettings => {
                if leg.state().driven() {
                    return Err(HostRefusal::Driven);
                }
                if self.waiting != Waiting::Nothing {
                    return Err(HostRefusal::Busy);
                }
                self.waiting = Waiting::Save(number);
                return Ok(None);
            }
        }))
    }

    /// Starts the leg again with other settings.
    // Apart: below it a leg is built, which takes stack.
    #[inline(never)]
    fn set_settings(
        &mut self,
        settings: &Settings,
        leg: &mut impl CommandedLeg,
    ) -> Result<(), HostRefusal> {
        if !self.identified {
            return Err(HostRefusal::NotIdentified);
        }
        if self.saves() {
            // What would be acknowledged as kept is not what is in use then.
            return Err(HostRefusal::Busy);
        }
        leg.restart(settings)?;
        self.adopt(settings);
        Ok(())
    }

    // Apart, so that the copy takes stack only as long as it runs.
    #[inline(never)]
    fn settings_reply(&self) -> HostReply {
        HostReply::Settings(self.settings.clone())
    }

    /// Has these settings from now on: the leg has started without their zero.
    // Apart, so that the copy takes stack only as long as it runs.
    #[inline(never)]
    fn adopt(&mut self, settings: &Settings) {
        self.settings = settings.unhomed();
    }

    fn identify(&mut self, hello: &Hello) -> Result<HostReply, HostRefusal> {
        if hello.schema != HOST_SCHEMA {
            // The host that has identified itself stays identified: a host of another version must not end that.
            return Err(HostRefusal::SchemaMismatch {
                schema: HOST_SCHEMA,
            });
        }
        self.identified = true;
        // A new host has not asked for anything yet.
        self.stream.every_ticks = 0;
        Ok(HostReply::Identified(self.identity.clone()))
    }

    /// Passes a command on. Any host may stop or disarm a leg; whatever else a leg does that follows commands, it does for
    /// the one that set it in motion.
    fn command(
        &mut self,
        number: u16,
        host: HostId,
        command: Command,
        leg: &mut impl CommandedLeg,
    ) -> Result<Option<HostReply>, HostRefusal> {
        let ends = matches!(command, Command::Stop | Command::Disarm);
        let begins = matches!(
            command,
            Command::Arm | Command::Home | Command::Jog(_) | Command::Clear
        );
        // What sets it in motion may wait until it stands: what another sent meanwhile would be executed after it.
        let follows = leg.state().follows() || matches!(self.waiting, Waiting::Begin(_));
        if follows && !ends && self.driver.is_some_and(|driver| driver != host) {
            return Err(HostRefusal::OtherHost);
        }
        // Flash is written at rest alone.
        let waits = begins && self.saves();
        if waits || !leg.command(number, command) {
            return Err(HostRefusal::Busy);
        }
        if begins {
            self.driver = Some(host);
            self.waiting = Waiting::Begin(number);
        }
        Ok(None)
    }
}
