//! The transfer of a loop by its points, and its margins by them.

use nalgebra::Complex;
use serde::Serialize;

/// A measured point of a loop's transfer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ResponsePoint {
    /// Hz.
    pub hz: f64,
    /// dB.
    pub gain_db: f64,
    /// Degrees, −180 to 180; of the transfer that is −1 where the closed loop is at its limit.
    pub phase_deg: f64,
    /// The part of the amplitude that it was measured with: less than 1 where more ended the run.
    pub part: f64,
}

/// Square of the least gain: nothing may come back.
const LEAST: f64 = 1e-12;

impl ResponsePoint {
    /// From a transfer that was measured with a part of the amplitude.
    #[must_use]
    pub fn new(hz: f64, transfer: Complex<f64>, part: f64) -> Self {
        Self {
            hz,
            gain_db: 10.0 * transfer.norm_sqr().max(LEAST).log10(),
            phase_deg: transfer.im.atan2(transfer.re).to_degrees(),
            part,
        }
    }
}

/// The least margin of the gain that a loop may have, dB.
pub const GAIN_DB: f64 = 6.0;

/// The least margin of the phase, degrees.
pub const PHASE_DEG: f64 = 45.0;

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
    pub fn new(points: &[ResponsePoint]) -> Self {
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
#[must_use]
pub fn crosses(before: &ResponsePoint, after: &ResponsePoint) -> bool {
    gain_crossing(before, after).is_some()
        || phase_crossing(before, after).is_some_and(|crossing| crossing.other > FLOOR_DB)
}

/// Where the gain is 1, and the phase there, degrees.
fn gain_crossing(before: &ResponsePoint, after: &ResponsePoint) -> Option<Crossing> {
    if (before.gain_db < 0.0) == (after.gain_db < 0.0) {
        return None;
    }
    let part = before.gain_db / (before.gain_db - after.gain_db);
    let turned = wrapped(after.phase_deg - before.phase_deg);
    Some(Crossing {
        hz: interpolated_hz(before, after, part),
        other: before.phase_deg + part * turned,
    })
}

/// Where the phase is ±180°, and the gain there, dB.
fn phase_crossing(before: &ResponsePoint, after: &ResponsePoint) -> Option<Crossing> {
    // Seen from −180°, so that the crossing is one of zero; by less than half a turn, or it would be one of 0°.
    let from = wrapped(before.phase_deg + 180.0);
    let turned = wrapped(after.phase_deg - before.phase_deg);
    let to = from + turned;
    if (from < 0.0) == (to < 0.0) || from.abs() > 90.0 && to.abs() > 90.0 {
        return None;
    }
    let part = from / (from - to);
    Some(Crossing {
        hz: interpolated_hz(before, after, part),
        other: before.gain_db + part * (after.gain_db - before.gain_db),
    })
}

fn interpolated_hz(before: &ResponsePoint, after: &ResponsePoint, part: f64) -> f64 {
    before.hz * (after.hz / before.hz).powf(part)
}

/// Degrees from −180 to 180.
fn wrapped(degrees: f64) -> f64 {
    (degrees + 180.0).rem_euclid(360.0) - 180.0
}
