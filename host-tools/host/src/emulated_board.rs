//! An emulated leg behind a pseudo-terminal, in real time: to every command it is a board on a serial port.

use crate::operator::Interrupt;
use crate::pseudo_terminal::PseudoTerminal;
use leg_sim::emulated_leg::EmulatedLeg;
use leg_sim::simulation::ControllerError;
use leg_sim::touch::Touch;
use std::collections::VecDeque;
use std::io;
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};

/// How often bytes are exchanged.
const EXCHANGE_TIME: Duration = Duration::from_millis(1);

/// How far the leg may stay behind the clock before it gives that time up: it must not live through much of it without a
/// word from its host.
const BEHIND_MAX: Duration = Duration::from_millis(10);

/// What waits for a host that does not read at once, bytes: about what a serial adapter and its driver hold. More is lost.
const ADAPTER_BYTES: usize = 16 * 1024;

/// Why an emulated board stops.
#[derive(Debug, thiserror::Error)]
pub enum BoardError {
    /// The pseudo-terminal fails.
    #[error("the pseudo-terminal failed: {0}")]
    Terminal(#[from] io::Error),
    /// The firmware fails.
    #[error(transparent)]
    Controller(#[from] ControllerError),
}

/// A leg and its port.
pub struct EmulatedBoard {
    leg: EmulatedLeg,
    port: PseudoTerminal,
    incoming: VecDeque<u8>,
    outgoing: VecDeque<u8>,
    /// Time that the leg has given up.
    given_up: Duration,
}

impl EmulatedBoard {
    /// Connects a leg to a port.
    #[must_use]
    pub fn new(leg: EmulatedLeg, port: PseudoTerminal) -> Self {
        Self {
            leg,
            port,
            incoming: VecDeque::new(),
            outgoing: VecDeque::new(),
            given_up: Duration::ZERO,
        }
    }

    /// Runs until it is interrupted or `length` is over, and does to the leg what comes through `touches`. Returns how much
    /// of that time the leg missed because this machine is too slow.
    ///
    /// # Errors
    /// A [`BoardError`].
    pub fn run(
        mut self,
        interrupt: &Interrupt,
        length: Option<Duration>,
        touches: &Receiver<Touch>,
    ) -> Result<Duration, BoardError> {
        let (start, leg_start) = (Instant::now(), self.leg.time());
        while !interrupt.raised() && length.is_none_or(|length| start.elapsed() < length) {
            while let Ok(touch) = touches.try_recv() {
                touch.apply(self.leg.plant());
            }
            self.exchange(leg_start + start.elapsed())?;
            std::thread::sleep(EXCHANGE_TIME);
        }
        Ok(self.given_up)
    }

    /// Lets the leg's time come to that of the clock.
    fn exchange(&mut self, clock: Duration) -> Result<(), BoardError> {
        let mut bytes = [0; 4096];
        let count = self.port.read(&mut bytes)?;
        self.incoming.extend(bytes.get(..count).unwrap_or_default());
        let behind = clock.saturating_sub(self.leg.time() + self.given_up);
        self.given_up += behind.saturating_sub(BEHIND_MAX);
        while self.leg.time() + self.given_up < clock {
            let told = self.leg.tick(&mut self.incoming)?;
            let room = ADAPTER_BYTES - self.outgoing.len();
            self.outgoing.extend(told.take(room));
        }
        if !self.outgoing.is_empty() {
            let count = self.port.write(self.outgoing.make_contiguous())?;
            self.outgoing.drain(..count);
        }
        Ok(())
    }
}
