//! What happens in a scenario.

use crate::plant::Fault;
use leg_firmware::command::Compensation;
use leg_firmware::supervisor::{self, State};
use serde::{Deserialize, Serialize};

/// One step. A step that waits or measures takes its time; every other one is done in the same tick.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Step {
    /// Commands the leg to follow commands.
    Arm,
    /// Commands it to find its zero.
    Home,
    /// Commands it to come to rest on its way.
    Hold,
    /// Commands it to stay where it is.
    Stop,
    /// Commands it to relax its tendons.
    Disarm,
    /// Clears the faults whose cause is gone.
    Clear,
    /// Commands a move.
    Move {
        /// Degrees.
        azimuth_deg: f64,
        /// Degrees.
        tilt_deg: f64,
    },
    /// Commands a pretension, N.
    PretensionN(f64),
    /// Demands a bending stiffness.
    Stiffness {
        /// N·m/rad.
        nm_per_rad: f64,
        /// Azimuth of the push that it is meant for, degrees; left out for the smallest.
        #[serde(default)]
        towards_deg: Option<f64>,
    },
    /// Chooses the load that is held.
    Compensation(Compensation),
    /// Changes the payload, at once or over a time.
    Payload {
        /// kg.
        kg: f64,
        /// s.
        #[serde(default)]
        over_s: f64,
    },
    /// Pushes at the tip, horizontally and across the leg.
    Push {
        /// Degrees.
        azimuth_deg: f64,
        /// N.
        force_n: f64,
        /// s.
        for_s: f64,
    },
    /// Lets something fail.
    Fault(Fault),
    /// Mends it.
    Repair(Fault),
    /// Presses the emergency stop, or lets it go.
    EmergencyStop(bool),
    /// Sends so many random bytes to the leg.
    Garbage(u32),
    /// Stops the host's signs of life, or lets them go on.
    Silence(bool),
    /// Waits, s.
    WaitS(f64),
    /// Waits for a state.
    Await {
        /// The state.
        state: State,
        /// s.
        timeout_s: f64,
    },
    /// Waits until a move is done, and a time more.
    Arrive {
        /// s.
        then_s: f64,
        /// s.
        timeout_s: f64,
    },
    /// Starts the extremes anew.
    Mark,
    /// Waits for a fault and the state that it leads to, and measures the time since the last step.
    Reaction {
        /// The fault.
        fault: supervisor::Fault,
        /// The state.
        state: State,
        /// ms.
        within_ms: f64,
    },
    /// Measures.
    Measure {
        /// What it is called in the table.
        name: String,
        /// What.
        quantity: Quantity,
        /// Lowest and highest value.
        between: [f64; 2],
    },
    /// Pushes at the tip and measures the stiffness that meets the push.
    PushTest {
        /// What it is called in the table.
        name: String,
        /// Azimuth of the push, degrees.
        azimuth_deg: f64,
        /// N.
        force_n: f64,
        /// Time until the leg rests, s.
        settle_s: f64,
        /// The stiffness that is expected, N·m/rad.
        nm_per_rad: f64,
        /// How far from that it may be, percent.
        within_percent: f64,
    },
}

/// What can be measured. Averages are over a quarter of a second.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Distance of the average tip from its target, mm.
    TipErrorMm,
    /// Largest distance of the tip from where it was at the mark, mm.
    TipMovedMm,
    /// Lowest true tension since the mark, N.
    TensionMinN,
    /// Highest true tension since the mark, N.
    TensionMaxN,
    /// Longest time since the mark that a true tension was more than 5 % beyond its bounds, ms.
    OutsideMs,
    /// Payload that the leg estimates, kg.
    PayloadKg,
    /// Pretension, N.
    PretensionN,
    /// Stiffness that the leg tells, N·m/rad.
    StiffnessNmPerRad,
    /// Largest error of the lengths that homing found, mm.
    HomingErrorMm,
}

impl Quantity {
    /// Its unit.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::TipErrorMm | Self::TipMovedMm | Self::HomingErrorMm => "mm",
            Self::TensionMinN | Self::TensionMaxN | Self::PretensionN => "N",
            Self::OutsideMs => "ms",
            Self::PayloadKg => "kg",
            Self::StiffnessNmPerRad => "N·m/rad",
        }
    }
}
