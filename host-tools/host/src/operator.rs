//! A host of a leg: it introduces itself, commands the leg and listens to it, over any transport.

mod command;
mod connection;
mod error;
mod follow;
mod goal;
mod jog;
mod keep_alive;
mod motion;
mod recorder;
mod request;
mod settings;
mod stop;
mod swing;
mod telemetry;

#[cfg(test)]
mod tests;

pub use error::OperatorError;
pub use goal::{Goal, Tensioning};
pub use leg_rig::settings_difference::{SettingDifference, setting_differences};
pub use recorder::Scope;

use crate::cancel_flag::CancelFlag;
use crate::transport::Transport;
use connection::FramedTransport;
use leg_firmware::host_link::{
    HOST_SCHEMA, Hello, HostId, HostReply, HostRequest, Identity, TelemetryReport,
};
use leg_firmware::telemetry::Telemetry;
use std::collections::VecDeque;
use std::time::Duration;

/// By what a leg knows one host from another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HostIdentity {
    /// Its id.
    pub id: HostId,
    /// Sequence number before that of its first request.
    pub sequence: u16,
}

impl HostIdentity {
    /// Always the same, so that a run can be repeated.
    pub const FIXED: Self = Self { id: 1, sequence: 0 };

    /// Another one each time, for hosts that share a line.
    pub fn random() -> Self {
        Self {
            id: fastrand::u32(..),
            sequence: fastrand::u16(..),
        }
    }
}

/// What is called with the telemetry that the operator asks for while it waits.
type Watcher = Box<dyn FnMut(&Telemetry<f32>)>;

/// What is called while the leg does not answer, with the error in which that ends if it goes on.
type LateWatcher = Box<dyn FnMut(&OperatorError)>;

/// A host that has introduced itself to a leg.
pub struct Operator {
    connection: FramedTransport,
    host: HostId,
    identity: Identity,
    cancel: CancelFlag,
    watcher: Option<Watcher>,
    late_watcher: LateWatcher,
    stream: TelemetryStream,
    /// When the leg was last sent a command.
    commanded_at: Duration,
    /// Longest time between two messages to a driven leg; none before its command timeout was asked for.
    silence_max: Option<Duration>,
    /// Whether to send keep-alives.
    keeps_alive: bool,
    /// Whether the leg may be doing what this host commanded.
    drives: bool,
}

/// Telemetry that the leg sends by itself.
#[derive(Debug, Default)]
struct TelemetryStream {
    /// Ticks from one to the next that this host has asked for; 0 for none: then what comes is another host's.
    every_ticks: u16,
    /// What came and was not read yet.
    received: VecDeque<TelemetryReport>,
    /// Whether another host has introduced itself since: that may have ended the stream.
    other_host_came: bool,
}

/// Wait for the answer to an introduction: a board that was just opened may still be starting.
const INTRODUCTION_TIME: Duration = Duration::from_millis(300);

/// Introductions before the leg is taken for silent: ten seconds, as [`request`] waits.
const INTRODUCTIONS: u32 = 34;

/// After how many it is said that the leg does not answer: about two seconds.
const INTRODUCTIONS_LATE: u32 = 6;

impl Operator {
    /// The connection, for a program that passes on what others send.
    #[must_use]
    pub fn into_transport(self) -> Box<dyn Transport> {
        self.connection.transport
    }

    /// Introduces the host to the leg at the other end.
    ///
    /// # Errors
    /// [`OperatorError::NoAnswer`], [`OperatorError::OtherSchema`], or a connection that fails.
    pub fn open(
        transport: Box<dyn Transport>,
        host: HostIdentity,
        cancel: CancelFlag,
    ) -> Result<Self, OperatorError> {
        Self::open_watched(transport, host, cancel, |_| ())
    }

    /// The same, and calls `late` whenever the leg has not answered for seconds, or acknowledged a stop, with the error in which
    /// that ends if it goes on.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn open_watched(
        transport: Box<dyn Transport>,
        host: HostIdentity,
        cancel: CancelFlag,
        late: impl FnMut(&OperatorError) + 'static,
    ) -> Result<Self, OperatorError> {
        let mut late_watcher: LateWatcher = Box::new(late);
        let mut connection = FramedTransport::new(transport, host.sequence);
        let identity = introduce(&mut connection, &cancel, &mut late_watcher)?;
        Ok(Self {
            commanded_at: connection.transport.now(),
            connection,
            host: host.id,
            identity,
            cancel,
            watcher: None,
            late_watcher,
            stream: TelemetryStream::default(),
            silence_max: None,
            keeps_alive: false,
            drives: false,
        })
    }

    /// What the leg's board is.
    pub fn identity(&self) -> &Identity {
        &self.identity
    }

    /// What is at the other end, for a message to the user.
    pub fn name(&self) -> &str {
        self.connection.transport.name()
    }

    /// Time by the transport's clock.
    pub fn now(&self) -> Duration {
        self.connection.transport.now()
    }

    /// Whether that clock is an emulated leg's own.
    pub fn clock_is_emulated(&self) -> bool {
        self.connection.transport.clock_is_emulated()
    }

    /// Frames from the leg that could not be read, with those that the transport lost.
    pub fn damaged_frames(&self) -> u64 {
        self.connection.damaged_frames()
    }

    /// Calls `watcher` with the telemetry that the operator asks for while it waits.
    pub fn set_watcher(&mut self, watcher: impl FnMut(&Telemetry<f32>) + 'static) {
        self.watcher = Some(Box::new(watcher));
    }

    /// Calls `watcher` from now on where [`Self::open_watched`] would call its `late`.
    pub fn set_late_watcher(&mut self, watcher: impl FnMut(&OperatorError) + 'static) {
        self.late_watcher = Box::new(watcher);
    }
}

fn introduce(
    connection: &mut FramedTransport,
    cancel: &CancelFlag,
    late_watcher: &mut LateWatcher,
) -> Result<Identity, OperatorError> {
    let schema = HOST_SCHEMA;
    for introduction in 0..INTRODUCTIONS {
        if introduction == INTRODUCTIONS_LATE {
            late_watcher(&OperatorError::NoAnswer(connection.name()));
        }
        // Before that, what was asked is done: it may be a stop.
        if introduction >= INTRODUCTIONS_LATE && cancel.is_set() {
            return Err(OperatorError::Cancelled);
        }
        let number = connection.send(&HostRequest::Identify(Hello { schema }))?;
        let until = connection.transport.now() + INTRODUCTION_TIME;
        while let Some((sequence, reply)) = connection.receive(until)? {
            match reply {
                HostReply::Identified(identity) if sequence == number => return Ok(identity),
                HostReply::Refused(refusal) if sequence == number => {
                    return Err(connection.refused("identify", refusal));
                }
                _ => {}
            }
        }
    }
    Err(OperatorError::NoAnswer(connection.name()))
}
