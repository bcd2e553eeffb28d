//! A loop at frequencies that are evenly spaced on a logarithmic scale, and closer at margins and resonances.

use super::frequency_response::{ClosedLoop, Excitation};
use leg_rig::loop_response::{ResponsePoint, crosses};

/// How close two points come that have a margin between them, as a ratio of their frequencies: a mode that is damped by 0.05
/// turns the phase by 180° over a tenth of its frequency.
const CLOSE: f64 = 1.04;

/// The same beside a resonance that may hide a margin, and its least gain, dB.
const CLOSE_TO_PEAK: f64 = 1.12;
const PEAK_DB: f64 = -10.0;

/// The frequencies of a loop.
#[derive(Clone, Copy, Debug)]
pub struct Sweep {
    /// How it is excited.
    pub excitation: Excitation,
    /// The lowest frequency, Hz.
    pub from_hz: f64,
    /// The highest.
    pub to_hz: f64,
    /// How many at first, two or more.
    pub points: u32,
}

impl Sweep {
    /// Measures a loop that is at rest; the points come in the order of their frequencies.
    ///
    /// # Errors
    /// What ended a run.
    pub fn run<L: ClosedLoop>(&self, at_rest: &L) -> Result<Vec<ResponsePoint>, String> {
        let measure = |hz| self.excitation.measure(at_rest, hz);
        let ratio = self.to_hz / self.from_hz;
        let hz = |i| self.from_hz * ratio.powf(f64::from(i) / f64::from(self.points - 1));
        let mut points = (0..self.points)
            .map(|i| measure(hz(i)))
            .collect::<Result<Vec<_>, _>>()?;
        loop {
            let between = wide(&points);
            if between.is_empty() {
                return Ok(points);
            }
            for hz in between {
                points.push(measure(hz)?);
            }
            points.sort_by(|a, b| a.hz.total_cmp(&b.hz));
        }
    }
}

/// The middle of each space that is too wide for what is in it, Hz.
fn wide(points: &[ResponsePoint]) -> Vec<f64> {
    let peak = |i: usize| {
        let gain_db = |i: usize| {
            points
                .get(i)
                .map_or(f64::NEG_INFINITY, |point| point.gain_db)
        };
        let now = gain_db(i);
        let before = i.checked_sub(1).map_or(f64::NEG_INFINITY, gain_db);
        now > PEAK_DB && now >= before && now >= gain_db(i + 1)
    };
    let mut middles = Vec::new();
    for (i, pair) in points.windows(2).enumerate() {
        let [before, after] = pair else { continue };
        let ratio = after.hz / before.hz;
        if ratio > CLOSE && crosses(before, after)
            || ratio > CLOSE_TO_PEAK && (peak(i) || peak(i + 1))
        {
            middles.push((before.hz * after.hz).sqrt());
        }
    }
    middles
}
