//! A loop at frequencies that are evenly spaced on a logarithmic scale, and closer where its margins are.

use super::frequency_response::{ClosedLoop, Excitation, Point};
use super::margins::crosses;

/// How often the space between two points is halved where a margin is between them.
const REFINEMENTS: u32 = 2;

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
    pub fn run<L: ClosedLoop>(&self, at_rest: &L) -> Result<Vec<Point>, String> {
        let measure = |hz| self.excitation.measure(at_rest, hz);
        let ratio = self.to_hz / self.from_hz;
        let hz = |i| self.from_hz * ratio.powf(f64::from(i) / f64::from(self.points - 1));
        let mut points = (0..self.points)
            .map(|i| measure(hz(i)))
            .collect::<Result<Vec<_>, _>>()?;
        for _ in 0..REFINEMENTS {
            let mut finer = Vec::with_capacity(points.len());
            for (i, point) in points.iter().enumerate() {
                finer.push(*point);
                if let Some(next) = points.get(i + 1)
                    && crosses(point, next)
                {
                    finer.push(measure((point.hz * next.hz).sqrt())?);
                }
            }
            points = finer;
        }
        Ok(points)
    }
}
