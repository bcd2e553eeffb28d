//! What came out of a simulation.

use super::Comparison;
use crate::emulated_leg::EmulationError;
use crate::scenario::Measurand;
use crate::shadow::Divergence;
use leg_firmware::supervisor::Fault;
use leg_firmware::telemetry::Telemetry;
use serde::Serialize;
use std::fmt;

/// Why a simulation came to no end, or could not start.
#[derive(Debug, thiserror::Error)]
pub enum SimulationError {
    /// The leg cannot start, or its firmware fails.
    #[error(transparent)]
    Emulation(#[from] EmulationError),
    /// A step did not end in time.
    #[error("step {step}: {what} did not come within {timeout_s} s; the leg is {state}")]
    Timeout {
        /// The step, counted from 1.
        step: usize,
        /// What was waited for.
        what: String,
        /// s.
        timeout_s: f64,
        /// What the leg was doing, and its faults.
        state: String,
    },
    /// It takes too long.
    #[error("step {0} is not over after ten minutes of the leg's time; make the scenario shorter")]
    Endless(usize),
    /// A command has no form.
    #[error("a command cannot be sent: {0}")]
    Command(leg_firmware::frame::FrameError),
    /// The leg would refuse a point of a path.
    #[error("the path {time_s:.3} s after its start: {}; {}", .refusal.description()[0], .refusal.description()[1])]
    Path {
        /// The time of the point, s.
        time_s: f64,
        /// Why it would.
        refusal: leg_firmware::set_point::PointRefusal,
    },
}

/// One measured value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ScenarioMeasurement {
    /// What it is.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// Lowest and highest value.
    pub between: [f64; 2],
    /// Time in the scenario, s.
    pub at_s: f64,
    /// What was measured; none for a reaction and a push.
    pub quantity: Option<Measurand>,
    /// Whether the leg compensated its load then.
    pub compensated: bool,
}

impl ScenarioMeasurement {
    /// Whether the value is where it must be.
    #[must_use]
    pub fn passes(&self) -> bool {
        (self.between[0]..=self.between[1]).contains(&self.value)
    }
}

/// A command that the leg refused, or the same one again and again.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RefusedCommand {
    /// What it was.
    pub command: &'static str,
    /// When it was sent first, s.
    pub at_s: f64,
    /// When it was sent last, s.
    pub until_s: f64,
    /// How often.
    pub times: usize,
    /// Why it was refused.
    pub reason: String,
}

impl fmt::Display for RefusedCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (command, at_s, reason) = (self.command, self.at_s, &self.reason);
        match self.times {
            1 => write!(f, "{command} ({at_s:.3} s): {reason}"),
            times => write!(
                f,
                "{command} ({at_s:.3} to {:.3} s, {times} times): {reason}",
                self.until_s
            ),
        }
    }
}

/// The leg at a time, for plots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// s.
    pub time_s: f64,
    /// The simulated leg beside what it reports.
    pub comparison: Comparison,
    /// What the leg reports.
    pub telemetry: Telemetry<f32>,
}

/// What came out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// What was measured.
    pub measurements: Vec<ScenarioMeasurement>,
    /// Why it ended before its last step, if it did.
    pub stopped: Option<String>,
    /// Ticks.
    pub ticks: u64,
    /// Lowest and highest true tension over all ticks, N.
    pub tension_range_n: [f64; 2],
    /// Highest true tension while the motors followed commands, homed or kept station, N: where they are held or off, what acts on
    /// the leg from outside decides alone.
    pub driven_max_n: f64,
    /// Against the shadow in f64.
    pub divergence: Divergence,
    /// Every fault in the order in which it was first seen, with the time, s.
    pub faults: Vec<(Fault, f64)>,
    /// Commands that the leg refused, as they came.
    pub refused: Vec<RefusedCommand>,
    /// Faults that the scenario does not expect.
    pub unexpected: Vec<Fault>,
    /// The leg at 500 Hz.
    pub samples: Vec<Sample>,
}

impl SimulationError {
    /// Whether what came out until then is worth looking at.
    pub(super) const fn midway(&self) -> bool {
        matches!(
            self,
            Self::Timeout { .. } | Self::Endless(_) | Self::Emulation(EmulationError::NotFinite(_))
        )
    }
}

impl Summary {
    /// Notes a command that the leg refused, with the last one where that was the same.
    pub(super) fn note_refused(&mut self, command: &'static str, at_s: f64, reason: String) {
        let last = self.refused.last_mut();
        match last.filter(|last| last.command == command && last.reason == reason) {
            Some(last) => {
                last.until_s = at_s;
                last.times += 1;
            }
            None => self.refused.push(RefusedCommand {
                command,
                at_s,
                until_s: at_s,
                times: 1,
                reason,
            }),
        }
    }

    /// Whether it came to its end, every value is where it must be, no fault came that is not expected, and the shadow in f64
    /// stayed in the firmware's state and answered as it did.
    #[must_use]
    pub fn passes(&self) -> bool {
        self.stopped.is_none()
            && self.measurements.iter().all(ScenarioMeasurement::passes)
            && self.unexpected.is_empty()
            && self.divergence.stays()
    }
}
