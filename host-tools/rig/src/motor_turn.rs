//! What an encoder counted while its motor was turned once by hand.

use leg_base::failure::Failure;
use leg_firmware::settings::AxisCalibration;
use serde::Serialize;

/// How far a turn by hand may be off.
const HAND_PART: f64 = 0.15;

/// What one turn of a motor counted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MotorTurn {
    /// From 1.
    pub motor: usize,
    /// Up while the tendon is pulled in.
    pub counts: i16,
    /// By the data sheet, and the sign that is set.
    pub expected: f64,
    /// The encoder's direction; 0 if it counted nothing.
    pub sign: i8,
    /// Whether it counted as expected.
    pub passed: bool,
    /// The same under its former name, for one release.
    held: bool,
}

/// What is done by hand, for a motor from 0.
#[must_use]
pub fn step(motor: usize) -> String {
    let number = motor + 1;
    format!("turn motor {number} by one turn, so that it reels its tendon in")
}

/// Refuses an encoder whose turn is more than the board's counter tells apart.
///
/// # Errors
/// That [`Failure`].
pub fn require_countable(counts_per_turn: f64) -> Result<(), Failure> {
    if counts_per_turn * (1.0 + HAND_PART) <= f64::from(i16::MAX) {
        return Ok(());
    }
    Err(Failure::refused(
        format!(
            "a turn of {counts_per_turn} counts is too much for the board's counter of 16 bits"
        ),
        "check its direction by homing; a wrong one is a fault by name",
    ))
}

impl MotorTurn {
    /// Of a motor from 0, by its counter before and after. The counter wraps; a turn is less than half of it.
    #[must_use]
    pub fn new(
        motor: usize,
        [before, after]: [u16; 2],
        counts_per_turn: f64,
        axis: &AxisCalibration,
    ) -> Self {
        let counts = after.wrapping_sub(before).cast_signed();
        let expected = counts_per_turn * f64::from(axis.m_per_count.signum());
        let error = (f64::from(counts) - expected).abs();
        let passed = error <= HAND_PART * expected.abs();
        Self {
            motor: motor + 1,
            counts,
            expected,
            sign: counts.signum() as i8,
            passed,
            held: passed,
        }
    }

    /// Whether it passed, or what to do.
    #[must_use]
    pub fn verdict(&self) -> String {
        if self.passed {
            "pass".into()
        } else if self.counts == 0 {
            "fail: no count; check the encoder's wiring".into()
        } else if f64::from(self.counts) * self.expected < 0.0 {
            format!(
                "fail: it counts in the other direction; set its counts_sign to {}",
                self.sign
            )
        } else {
            "fail: another number of counts; check counts_per_turn, and the turn itself".into()
        }
    }
}

/// The directions of all encoders as a rig file has them; none if one counted nothing.
#[must_use]
pub fn signs(turns: &[MotorTurn]) -> Option<String> {
    if turns.iter().any(|turn| turn.sign == 0) {
        return None;
    }
    let signs: Vec<String> = turns.iter().map(|turn| turn.sign.to_string()).collect();
    Some(format!("[{}]", signs.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::{MotorTurn, require_countable, signs};
    use leg_firmware::settings::AxisCalibration;

    fn turn(before: u16, after: u16) -> MotorTurn {
        MotorTurn::new(1, [before, after], 2048.0, &AxisCalibration::DEFAULT)
    }

    #[test]
    fn a_turn_is_judged_across_the_end_of_the_counter() {
        let good = turn(65_000, 1_500);
        assert!(good.passed && good.counts == 2036 && good.motor == 2);
        let reversed = turn(1_500, 65_000);
        assert!(!reversed.passed && reversed.verdict().contains("set its counts_sign to -1"));
        assert!(turn(7, 7).verdict().contains("no count"));
        assert!(turn(0, 1000).verdict().contains("another number"));
        assert_eq!(
            signs(&[good, reversed, good]).as_deref(),
            Some("[1, -1, 1]")
        );
        assert_eq!(signs(&[good, turn(7, 7)]), None);
    }

    #[test]
    fn an_encoder_that_is_too_fine_is_refused() {
        assert!(require_countable(20_000.0).is_ok() && require_countable(30_000.0).is_err());
    }
}
