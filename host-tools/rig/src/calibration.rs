//! What was measured of the sensors of the three axes.

use crate::actuator::Actuator;
use crate::gains::widened;
use crate::toml_error::TomlError;
use crate::toml_section::Section;
use leg_firmware::settings::{AxisCalibration, Field};

/// The section `[calibration]`.
pub const CALIBRATION: &str = "calibration";

/// The calibrations of the three axes: measured, or as the actuators' data say.
///
/// The simulated leg keeps its actuators' data: a calibration that is not theirs shows as an error there. The signs of
/// the counts are otherwise: how encoders are wired is a fact, and the simulated leg's are wired the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibration {
    /// How far one encoder count pulls each tendon in, without its sign, m.
    pub m_per_count: [f64; 3],
    /// Which way each encoder counts: 1 up while its tendon is pulled in, or −1.
    pub counts_sign: [f64; 3],
    /// Tension by code of each load cell, N.
    pub cell_n_per_code: [f64; 3],
    /// Code of each load cell without tension.
    pub cell_zero_code: [f64; 3],
    /// Current by code of each motor, A.
    pub current_a_per_code: [f64; 3],
}

/// [`Calibration::counts_sign`]; nothing between the ends is a sign.
const COUNTS_SIGN: Field<f64> = Field::new(
    "counts_sign",
    "1",
    "Which way each encoder counts: 1 up while its tendon is pulled in, or -1.",
    [-1.0, 1.0],
    1.0,
);

impl Calibration {
    /// As the actuators' data say.
    #[must_use]
    pub fn nominal(actuators: &[Actuator; 3]) -> Self {
        let each = |value: fn(&Actuator) -> f64| actuators.each_ref().map(value);
        Self {
            m_per_count: each(Actuator::m_per_count),
            counts_sign: [1.0; 3],
            cell_n_per_code: each(Actuator::cell_n_per_code),
            cell_zero_code: each(Actuator::cell_zero_code),
            current_a_per_code: each(Actuator::current_a_per_code),
        }
    }

    /// Every key of the section with its field, that of the board's table, and its value by axis.
    pub(crate) fn keys(&mut self) -> [(Field<f64>, &mut [f64; 3]); 5] {
        let values = [
            &mut self.m_per_count,
            &mut self.cell_n_per_code,
            &mut self.cell_zero_code,
            &mut self.current_a_per_code,
        ];
        let mut fields = AxisCalibration::FIELDS.iter().map(widened);
        // The sign of the counts has a key of its own.
        let mut field = || Field {
            signed: false,
            ..fields.next().unwrap_or(COUNTS_SIGN)
        };
        let [counts, scale, zero, current] = values.map(|values| (field(), values));
        let sign = (COUNTS_SIGN, &mut self.counts_sign);
        [counts, sign, scale, zero, current]
    }

    /// Reads the section; whatever is left out is as the actuators' data say.
    pub(crate) fn read(root: &Section<'_>, actuators: &[Actuator; 3]) -> Result<Self, TomlError> {
        let mut calibration = Self::nominal(actuators);
        let keys = calibration.keys();
        let names = keys.each_ref().map(|(field, _)| field.name);
        let Some(section) = root.optional(CALIBRATION, &names)? else {
            return Ok(calibration);
        };
        for (field, values) in keys {
            if let Some(given) = section.values([&field; 3])? {
                *values = given;
            }
        }
        let other = calibration
            .counts_sign
            .iter()
            .find(|sign| sign.abs() != 1.0);
        other.map_or(Ok(calibration), |other| {
            let key = COUNTS_SIGN.name;
            Err(TomlError::new(
                section.place(&[key]).unwrap_or(0..0),
                format!("`{key}` cannot be `{other}`"),
                "write 1 or -1 for each axis",
            ))
        })
    }
}
