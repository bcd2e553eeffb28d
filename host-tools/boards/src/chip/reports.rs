//! What the chip reports of itself on its line: it has to be what the twin knows of the same tick.

use leg_firmware::frame::{self, Decoder, FrameError, MAX_FRAME};
use leg_firmware::host_link::{HostReply, HostRequest};
use leg_firmware::telemetry::Telemetry;
use std::collections::VecDeque;

/// Ticks from one question to the next, and when the first is asked: not with the host's signs of life.
const EVERY_TICKS: u64 = 200;
const FIRST_TICK: u64 = 100;

/// Ticks that are remembered: a report may wait behind other replies.
const TICKS_KEPT: usize = 4000;

/// The number of the questions, which no scenario comes to.
const NUMBER: u16 = 0xfffe;

/// The reports of a chip.
#[derive(Clone)]
pub struct Reports {
    decoder: Decoder,
    known: VecDeque<Telemetry<f32>>,
    /// How many have been compared.
    pub compared: u64,
}

impl Reports {
    /// Of a chip that starts.
    pub fn new() -> Self {
        Self {
            decoder: Decoder::new(),
            known: VecDeque::new(),
            compared: 0,
        }
    }

    /// Whether to ask at a tick.
    pub fn due(tick: u64) -> bool {
        tick % EVERY_TICKS == FIRST_TICK
    }

    /// The bytes that ask for a report.
    pub fn question() -> Result<Vec<u8>, FrameError> {
        let mut bytes = [0; MAX_FRAME];
        Ok(frame::encode(NUMBER, &HostRequest::Telemetry, &mut bytes)?.to_vec())
    }

    /// Takes what the twin knows after a tick.
    pub fn learn(&mut self, telemetry: Telemetry<f32>) {
        if self.known.len() == TICKS_KEPT {
            self.known.pop_front();
        }
        self.known.push_back(telemetry);
    }

    /// Takes a byte from the chip.
    ///
    /// # Errors
    /// What is wrong with the frame that it ends, as a sentence.
    pub fn take(&mut self, byte: u8) -> Result<(), String> {
        let message: HostReply = match self.decoder.push(byte) {
            None => return Ok(()),
            Some(Err(error)) => {
                return Err(format!("the chip sent a frame that is no frame ({error})"));
            }
            Some(Ok(frame)) => match frame.message() {
                Some(message) => message,
                None => return Err("the chip sent a reply that there is not".into()),
            },
        };
        match message {
            HostReply::Telemetry(report) => self.compare(&report.telemetry),
            _ => Ok(()),
        }
    }

    fn compare(&mut self, reported: &Telemetry<f32>) -> Result<(), String> {
        let mut known = self.known.iter();
        let Some(twin) = known.find(|known| known.tick == reported.tick) else {
            return Err(format!(
                "the chip reports of tick {}, which is none of the last",
                reported.tick
            ));
        };
        self.compared += 1;
        if reported.map(f32::to_bits) == twin.map(f32::to_bits) {
            return Ok(());
        }
        Err(format!(
            "the chip reports {reported:?}, and the control law in process {twin:?}"
        ))
    }
}
