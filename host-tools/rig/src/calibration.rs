//! What was measured of the sensors of the three axes.

use crate::actuator::Actuator;
use crate::fields::Field;
use leg_firmware::sensors::CODE_MAX;

/// Measured calibrations of the three axes, each in the place of what the actuator's data say.
///
/// The simulated leg keeps its actuator's data: a calibration that is not theirs shows as an error there. The signs of
/// the counts are otherwise: how encoders are wired is a fact, and the simulated leg's are wired the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibration {
    /// How far one encoder count pulls each tendon in, without its sign, m.
    pub m_per_count: Option<[f64; 3]>,
    /// Which way each encoder counts: 1 up while its tendon is pulled in, or −1.
    pub counts_sign: [f64; 3],
    /// Tension by code of each load cell, N.
    pub cell_n_per_code: Option<[f64; 3]>,
    /// Code of each load cell without tension.
    pub cell_zero_code: Option<[f64; 3]>,
    /// Current by code of each motor, A.
    pub current_a_per_code: Option<[f64; 3]>,
}

/// [`Calibration::m_per_count`].
pub const M_PER_COUNT: Field = Field {
    name: "m_per_count",
    meaning: "How far one encoder count pulls each tendon in, without its sign, m.",
    range: COUNT_RANGE_M,
};

/// How far one encoder count may pull a tendon, m. With finer ones a fast motor outruns the counter of 16 bits.
pub const COUNT_RANGE_M: [f64; 2] = [1e-9, 1e-4];

/// [`Calibration::counts_sign`]; nothing between the ends is a sign.
pub const COUNTS_SIGN: Field = Field {
    name: "counts_sign",
    meaning: "Which way each encoder counts: 1 up while its tendon is pulled in, or -1.",
    range: [-1.0, 1.0],
};

/// [`Calibration::cell_n_per_code`].
pub const CELL_N_PER_CODE: Field = Field {
    name: "cell_n_per_code",
    meaning: "Tension by code of each load cell, N: a code up has to be more tension.",
    range: [1e-6, 10.0],
};

/// [`Calibration::cell_zero_code`].
pub const CELL_ZERO_CODE: Field = Field {
    name: "cell_zero_code",
    meaning: "Code of each load cell without tension.",
    range: [0.0, CODE_MAX as f64],
};

/// [`Calibration::current_a_per_code`].
pub const CURRENT_A_PER_CODE: Field = Field {
    name: "current_a_per_code",
    meaning: "Current by code of each motor, A.",
    range: [1e-7, 1.0],
};

impl Default for Calibration {
    fn default() -> Self {
        Self {
            m_per_count: None,
            counts_sign: [1.0; 3],
            cell_n_per_code: None,
            cell_zero_code: None,
            current_a_per_code: None,
        }
    }
}

impl Calibration {
    /// Everything given: what was not measured is as the actuator's data say.
    #[must_use]
    pub fn complete(&self, actuator: &Actuator) -> CompleteCalibration {
        let or = |measured: Option<[f64; 3]>, nominal: f64| measured.unwrap_or([nominal; 3]);
        CompleteCalibration {
            m_per_count: or(self.m_per_count, actuator.m_per_count()),
            counts_sign: self.counts_sign,
            cell_n_per_code: or(self.cell_n_per_code, actuator.cell_n_per_code()),
            cell_zero_code: or(self.cell_zero_code, actuator.cell_zero_code()),
            current_a_per_code: or(self.current_a_per_code, actuator.current_a_per_code()),
        }
    }
}

/// A [`Calibration`] that leaves nothing out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompleteCalibration {
    /// How far one encoder count pulls each tendon in, without its sign, m.
    pub m_per_count: [f64; 3],
    /// Which way each encoder counts.
    pub counts_sign: [f64; 3],
    /// Tension by code of each load cell, N.
    pub cell_n_per_code: [f64; 3],
    /// Code of each load cell without tension.
    pub cell_zero_code: [f64; 3],
    /// Current by code of each motor, A.
    pub current_a_per_code: [f64; 3],
}
