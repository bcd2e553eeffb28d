//! The margins of a loop by points of its transfer.

use super::frequency_response::Point;
use serde::Serialize;

/// Below this gain, dB, nothing counts: it is less than what the sensors resolve.
const FLOOR_DB: f64 = -40.0;

/// How far a loop is from its limit of stability.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Margins {
    /// The least gain, or inverse of it, where the phase is ±180°, dB; none where it never is.
    pub gain_db: Option<f64>,
    /// Where that is, Hz.
    pub gain_hz: Option<f64>,
    /// The least phase from ±180° where the gain is 1, degrees; none where it never is.
    pub phase_deg: Option<f64>,
    /// Where that is, the crossover, Hz.
    pub phase_hz: Option<f64>,
}

/// A place between two points where a curve crosses its line: a part of the way, and the other quantity there.
struct Crossing {
    hz: f64,
    other: f64,
}

impl Margins {
    /// Of points in the order of their frequencies.
    #[must_use]
    pub fn new(points: &[Point]) -> Self {
        let mut margins = Self::default();
        for pair in points.windows(2) {
            let [before, after] = pair else { continue };
            if let Some(crossing) = phase_crossing(before, after) {
                let gain_db = crossing.other.abs();
                if crossing.other > FLOOR_DB && margins.gain_db.is_none_or(|least| gain_db < least)
                {
                    (margins.gain_db, margins.gain_hz) = (Some(gain_db), Some(crossing.hz));
                }
            }
            if let Some(crossing) = gain_crossing(before, after) {
                let phase_deg = 180.0 - wrapped(crossing.other).abs();
                if margins.phase_deg.is_none_or(|least| phase_deg < least) {
                    (margins.phase_deg, margins.phase_hz) = (Some(phase_deg), Some(crossing.hz));
                }
            }
        }
        margins
    }
}

/// Whether something that matters is between two points.
pub(super) fn crosses(before: &Point, after: &Point) -> bool {
    gain_crossing(before, after).is_some()
        || phase_crossing(before, after).is_some_and(|crossing| crossing.other > FLOOR_DB)
}

/// Where the gain is 1, and the phase there, degrees.
fn gain_crossing(before: &Point, after: &Point) -> Option<Crossing> {
    if (before.gain_db < 0.0) == (after.gain_db < 0.0) {
        return None;
    }
    let part = before.gain_db / (before.gain_db - after.gain_db);
    let turned = wrapped(after.phase_deg - before.phase_deg);
    Some(Crossing {
        hz: between(before, after, part),
        other: before.phase_deg + part * turned,
    })
}

/// Where the phase is ±180°, and the gain there, dB.
fn phase_crossing(before: &Point, after: &Point) -> Option<Crossing> {
    // Seen from −180°, so that the crossing is one of zero; by less than half a turn, or it would be one of 0°.
    let from = wrapped(before.phase_deg + 180.0);
    let turned = wrapped(after.phase_deg - before.phase_deg);
    let to = from + turned;
    if (from < 0.0) == (to < 0.0) || from.abs() > 90.0 && to.abs() > 90.0 {
        return None;
    }
    let part = from / (from - to);
    Some(Crossing {
        hz: between(before, after, part),
        other: before.gain_db + part * (after.gain_db - before.gain_db),
    })
}

fn between(before: &Point, after: &Point, part: f64) -> f64 {
    before.hz * (after.hz / before.hz).powf(part)
}

/// Degrees from −180 to 180.
fn wrapped(degrees: f64) -> f64 {
    (degrees + 180.0).rem_euclid(360.0) - 180.0
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::Margins;
    use crate::bode::frequency_response::{ClosedLoop, Excitation, Sides};
    use crate::bode::sweep::Sweep;

    /// An integrator of a gain with two ticks of delay, in a closed loop: L(z) = k z⁻²/(1 − z⁻¹), |L| = k/(2 sin(Ω/2)),
    /// arg L = −90° − 1.5 Ω.
    #[derive(Clone)]
    struct Integrator {
        gain: f64,
        sum: f64,
        delayed: [f64; 2],
        /// A constant that is no part of the loop.
        offset: f64,
    }

    impl ClosedLoop for Integrator {
        fn tick(&mut self, added: f64) -> Result<Sides, String> {
            self.sum += self.delayed[1];
            let returned = -self.gain * self.sum + self.offset;
            let injected = returned + added;
            self.delayed = [injected, self.delayed[0]];
            Ok(Sides { returned, injected })
        }
    }

    #[test]
    fn the_margins_of_a_known_loop_are_found() {
        for gain in [0.1_f64, 0.3, 0.5, 0.8] {
            let closed = Integrator {
                gain,
                sum: 0.0,
                delayed: [0.0; 2],
                offset: 3.0,
            };
            let sweep = Sweep {
                excitation: Excitation {
                    tick_hz: 8000.0,
                    amplitude: 1.0,
                    settle_s: 0.1,
                    settle_periods: 4.0,
                    window_s: 0.05,
                    window_periods: 3.0,
                },
                from_hz: 40.0,
                to_hz: 3000.0,
                points: 20,
            };
            let points = sweep.run(&closed).unwrap();
            let hertz = |omega: f64| omega * 8000.0 / std::f64::consts::TAU;
            for point in &points {
                let omega = point.hz / hertz(1.0);
                let gain_db = 20.0 * (gain / (2.0 * (0.5 * omega).sin())).log10();
                let phase_deg = -90.0 - 1.5 * omega.to_degrees();
                assert!(
                    (point.gain_db - gain_db).abs() < 0.05,
                    "{point:?} {gain_db}"
                );
                let off = (point.phase_deg - phase_deg + 180.0).rem_euclid(360.0) - 180.0;
                assert!(off.abs() < 0.3, "{point:?} {phase_deg}");
            }
            let found = Margins::new(&points);
            let crossover = 2.0 * (0.5 * gain).asin();
            let expected = [-20.0 * gain.log10(), 90.0 - 1.5 * crossover.to_degrees()];
            assert!(
                (found.gain_db.unwrap() - expected[0]).abs() < 0.2,
                "{found:?}"
            );
            assert!(
                (found.phase_deg.unwrap() - expected[1]).abs() < 1.0,
                "{found:?}"
            );
            let at = hertz(std::f64::consts::FRAC_PI_3);
            assert!(
                (found.gain_hz.unwrap() / at - 1.0).abs() < 0.02,
                "{found:?}"
            );
            assert!((found.phase_hz.unwrap() / hertz(crossover) - 1.0).abs() < 0.02);
        }
    }
}
