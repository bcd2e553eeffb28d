//! A user's host: it identifies itself to a leg, commands it, and listens to it, over any transport.

mod alive;
mod asking;
mod driving;
mod ending;
mod error;
mod interrupt;
mod line;
mod looking;
mod refusal;
mod settings;
mod telemetry;

#[cfg(test)]
mod tests;

pub use driving::{Demand, Goal};
pub use error::OperatorError;
pub use interrupt::Interrupt;
pub use settings::{Difference, differences};

use crate::transport::Transport;
use leg_firmware::host_link::{HOST_SCHEMA, Hello};
use leg_firmware::host_link::{HostId, HostReply, HostRequest, Identity};
use leg_firmware::telemetry::Telemetry;
use line::Line;
use std::time::Duration;
use telemetry::Stream;

/// How the host is told from others, and what the first of its requests is numbered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Host {
    /// Its id.
    pub id: HostId,
    /// Number before that of its first request.
    pub sequence: u16,
}

impl Host {
    /// Always the same, so that a run can be repeated.
    pub const FIXED: Self = Self { id: 1, sequence: 0 };

    /// Another one each time: hosts on one line are told apart by it.
    #[must_use]
    pub fn random() -> Self {
        Self {
            id: fastrand::u32(..),
            sequence: fastrand::u16(..),
        }
    }
}

/// What looks on while the operator waits.
type Watcher = Box<dyn FnMut(&Telemetry<f32>)>;

/// A host that a leg knows.
pub struct Operator {
    line: Line,
    host: HostId,
    identity: Identity,
    interrupt: Interrupt,
    watcher: Option<Watcher>,
    /// Telemetry that comes by itself.
    stream: Stream,
    /// When the leg last heard a command.
    spoke_at: Duration,
    /// How long the leg may hear nothing of this host while it is driven; none before that was asked.
    silence_max: Option<Duration>,
    /// Whether the leg shall be kept from missing this host.
    alive: bool,
    /// Whether the leg may be doing what this host commanded.
    drives: bool,
}

/// Wait for the answer to an introduction: a board that was just opened may still be starting.
const GREETING_TIME: Duration = Duration::from_millis(300);

/// Introductions.
const GREETINGS: u32 = 6;

impl Operator {
    /// Introduces the host to the leg at the other end.
    ///
    /// # Errors
    /// [`OperatorError::Silent`], [`OperatorError::OtherSchema`], or a line that breaks.
    pub fn open(
        transport: Box<dyn Transport>,
        host: Host,
        interrupt: Interrupt,
    ) -> Result<Self, OperatorError> {
        let mut line = Line::new(transport, host.sequence);
        let identity = greet(&mut line)?;
        Ok(Self {
            spoke_at: line.now(),
            line,
            host: host.id,
            identity,
            interrupt,
            watcher: None,
            stream: Stream::default(),
            silence_max: None,
            alive: false,
            drives: false,
        })
    }

    /// What the leg's board is.
    #[must_use]
    pub fn identity(&self) -> &Identity {
        &self.identity
    }

    /// What is at the other end, for a message to the user.
    #[must_use]
    pub fn name(&self) -> String {
        self.line.name()
    }

    /// Time by the transport's clock.
    #[must_use]
    pub fn now(&self) -> Duration {
        self.line.now()
    }

    /// Whether that is an emulated leg's own.
    #[must_use]
    pub fn clock_is_emulated(&self) -> bool {
        self.line.clock_is_emulated()
    }

    /// Frames from the leg that could not be read, and what came so damaged that it is in none.
    #[must_use]
    pub fn damaged(&self) -> u64 {
        self.line.damaged()
    }

    /// Lets someone look at the telemetry that the operator asks for while it waits.
    pub fn set_watcher(&mut self, watcher: impl FnMut(&Telemetry<f32>) + 'static) {
        self.watcher = Some(Box::new(watcher));
    }
}

fn greet(line: &mut Line) -> Result<Identity, OperatorError> {
    let request = HostRequest::Identify(Hello {
        schema: HOST_SCHEMA,
    });
    for _ in 0..GREETINGS {
        let number = line.send(&request)?;
        let until = line.now() + GREETING_TIME;
        while let Some((sequence, reply)) = line.receive(until)? {
            match reply {
                HostReply::Identified(identity) if sequence == number => return Ok(identity),
                HostReply::Refused(refusal) if sequence == number => {
                    return Err(line.refused("identify", refusal));
                }
                _ => {}
            }
        }
    }
    Err(OperatorError::Silent { name: line.name() })
}
