//! What the recorder of a leg can keep, and the choice of it.

use super::Settings;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// A signal: three numbers in each tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordedSignal {
    /// Measured tensions, N.
    Tensions,
    /// Tensions that the target asks for, N.
    TargetTensions,
    /// How far each tendon is pulled in, m.
    Pulled,
    /// How far each shall be, m.
    References,
    /// Measured currents of the motors, A.
    Currents,
    /// Parts of the supply at the motors.
    Duties,
    /// The estimated direction's horizontal components, and what forward kinematics leaves over, m.
    Pose,
    /// The supply, V; the drivers' temperature, °C; the leg's state, as its number in [`State::ALL`](crate::supervisor::State::ALL).
    Board,
}

/// All of them: as they stand in a row.
pub const RECORDED_SIGNALS: [RecordedSignal; 8] = [
    RecordedSignal::Tensions,
    RecordedSignal::TargetTensions,
    RecordedSignal::Pulled,
    RecordedSignal::References,
    RecordedSignal::Currents,
    RecordedSignal::Duties,
    RecordedSignal::Pose,
    RecordedSignal::Board,
];

impl RecordedSignal {
    /// What its numbers are multiples of, in its units.
    ///
    /// Where a converter reads it, two of its codes: half of 65 536 steps is then all that it can change by in a tick.
    #[must_use]
    pub fn steps(self, settings: &Settings) -> [f32; 3] {
        match self {
            Self::Tensions | Self::TargetTensions => {
                settings.axes.map(|axis| 2.0 * axis.cell_n_per_code)
            }
            // A counter has 16 bits itself, and loses none of them here.
            Self::Pulled => settings.axes.map(|axis| axis.m_per_count.abs()),
            // A reference may go back at once by as much as its motor is behind.
            Self::References => settings.axes.map(|axis| 4.0 * axis.m_per_count.abs()),
            Self::Currents => settings.axes.map(|axis| 2.0 * axis.current_a_per_code),
            Self::Duties => [1e-4; 3],
            // A part of 10 000 is 0.006°; of the residual, 1 µm is less than the least that is watched.
            Self::Pose => [1e-4, 1e-4, 1e-6],
            Self::Board => {
                let board = &settings.board;
                let [volts, celsius] = [board.supply_v_per_code, board.temperature_c_per_code];
                [2.0 * volts, 2.0 * celsius, 1.0]
            }
        }
    }

    const fn bit(self) -> u8 {
        1 << self as u8
    }
}

/// Which signals are recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct SignalSet(u8);

impl SignalSet {
    /// None: nothing is recorded.
    pub const NONE: Self = Self(0);

    /// Some of them.
    #[must_use]
    pub const fn new(signals: &[RecordedSignal]) -> Self {
        let mut bits = 0;
        let mut rest = signals;
        while let [first, others @ ..] = rest {
            bits |= first.bit();
            rest = others;
        }
        Self(bits)
    }

    /// Whether a signal is among them.
    #[must_use]
    #[inline(always)]
    pub const fn has(self, signal: RecordedSignal) -> bool {
        self.0 & signal.bit() != 0
    }

    /// How many they are.
    #[must_use]
    pub const fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Whether nothing is recorded.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }
}

impl Default for SignalSet {
    /// What shows most of a fault: tensions, travel and duties, for 0.2 s.
    fn default() -> Self {
        Self::new(&[
            RecordedSignal::Tensions,
            RecordedSignal::Pulled,
            RecordedSignal::Duties,
        ])
    }
}
