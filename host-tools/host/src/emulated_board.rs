//! An emulated leg behind a port, in real time: to every command it is a board.

use crate::byte_port::BytePort;
use crate::cancel_flag::CancelFlag;
use leg_base::failure::Failure;
use leg_sim::action::Action;
use leg_sim::emulated_leg::EmulatedLeg;
use std::collections::VecDeque;
use std::io;
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};

/// How often bytes are exchanged.
const EXCHANGE_TIME: Duration = Duration::from_millis(1);

/// How far the leg may stay behind the clock before it skips that time: without a message of its host meanwhile, it would
/// hold.
const LAG_MAX: Duration = Duration::from_millis(10);

/// What waits for a host that does not read at once, bytes: about what a serial adapter and its driver buffer. More is lost.
const ADAPTER_BYTES: usize = 16 * 1024;

/// A leg and its port.
pub struct EmulatedBoard {
    leg: EmulatedLeg,
    port: Box<dyn BytePort>,
    incoming: VecDeque<u8>,
    outgoing: VecDeque<u8>,
    /// Time that the leg has skipped.
    skipped: Duration,
}

impl EmulatedBoard {
    /// Connects a leg to a port.
    pub fn new(leg: EmulatedLeg, port: Box<dyn BytePort>) -> Self {
        Self {
            leg,
            port,
            incoming: VecDeque::new(),
            outgoing: VecDeque::new(),
            skipped: Duration::ZERO,
        }
    }

    /// Runs until `cancel` is set or `length` is over, and does to the leg what comes through `actions`. Returns how much
    /// of that time the leg missed because this machine is too slow.
    pub fn run(
        mut self,
        cancel: &CancelFlag,
        length: Option<Duration>,
        actions: &Receiver<Action>,
    ) -> Result<Duration, Failure> {
        let (start, leg_start) = (Instant::now(), self.leg.time());
        while !cancel.is_set() && length.is_none_or(|length| start.elapsed() < length) {
            while let Ok(action) = actions.try_recv() {
                action.apply(self.leg.plant_mut());
            }
            self.exchange(leg_start + start.elapsed())?;
            std::thread::sleep(EXCHANGE_TIME);
        }
        Ok(self.skipped)
    }

    /// Lets the leg's time come to that of the clock.
    fn exchange(&mut self, clock: Duration) -> Result<(), Failure> {
        let mut bytes = [0; 4096];
        let count = self.port.read(&mut bytes).map_err(port_failed)?;
        self.incoming.extend(bytes.get(..count).unwrap_or_default());
        let lag = clock.saturating_sub(self.leg.time() + self.skipped);
        self.skipped += lag.saturating_sub(LAG_MAX);
        while self.leg.time() + self.skipped < clock {
            let bytes = self.leg.tick(&mut self.incoming);
            let bytes = bytes.map_err(Failure::from_error)?;
            let room = ADAPTER_BYTES - self.outgoing.len();
            self.outgoing.extend(bytes.take(room));
        }
        if !self.outgoing.is_empty() {
            let written = self.port.write(self.outgoing.make_contiguous());
            let count = written.map_err(port_failed)?;
            self.outgoing.drain(..count);
        }
        Ok(())
    }
}

fn port_failed(error: io::Error) -> Failure {
    Failure::refused(
        format!("the port failed: {error}"),
        "start `leg emulate` again",
    )
}
