//! The transfer of a loop at one frequency, measured while it is closed: a sine is added at a break point, and both sides of
//! it are correlated with the sine over whole periods.

use leg_rig::loop_response::ResponsePoint;
use nalgebra::Complex;
use std::f64::consts::TAU;

/// The two sides of a break point in one tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sides {
    /// What comes back round the loop.
    pub returned: f64,
    /// What goes into it: the same with what was added.
    pub injected: f64,
}

/// A closed loop that runs tick by tick.
pub trait ClosedLoop: Clone {
    /// One tick, with so much added at the break point.
    ///
    /// # Errors
    /// What ended the run.
    fn tick(&mut self, added: f64) -> Result<Sides, String>;
}

/// How a loop is excited.
#[derive(Clone, Copy, Debug)]
pub struct Excitation {
    /// Ticks in a second.
    pub tick_hz: f64,
    /// Of the sine that is added.
    pub amplitude: f64,
    /// Least time until transients have ended, s.
    pub settle_s: f64,
    /// The same in periods.
    pub settle_periods: f64,
    /// Least time over which is correlated, s.
    pub window_s: f64,
    /// The same in periods.
    pub window_periods: f64,
}

/// The parts of the amplitude that are tried one after the other, until one does not end the run: a sine of the mode of a soft leg has it swing
/// by itself beyond what is allowed with more than an eighth.
const PARTS: [f64; 4] = [1.0, 0.5, 0.25, 0.125];

impl Excitation {
    /// The transfer near a frequency; the loop is left as it is. Where the whole amplitude ends the run, a half, a quarter and
    /// then an eighth of it is tried.
    ///
    /// # Errors
    /// What ended the run with the least amplitude, and at which frequency.
    pub fn measure<L: ClosedLoop>(&self, at_rest: &L, hz: f64) -> Result<ResponsePoint, String> {
        let mut ended = String::new();
        for part in PARTS {
            match self.measure_with(part, at_rest, hz) {
                Ok(point) => return Ok(point),
                Err(error) => ended = error,
            }
        }
        Err(format!(
            "not measured at {hz:.2} Hz, even with an eighth of the amplitude: {ended}"
        ))
    }

    fn measure_with<L: ClosedLoop>(
        &self,
        part: f64,
        at_rest: &L,
        hz: f64,
    ) -> Result<ResponsePoint, String> {
        let mut closed = at_rest.clone();
        let ticks = |seconds: f64, periods: f64| (seconds.max(periods / hz) * self.tick_hz).ceil();
        let settle = ticks(self.settle_s, self.settle_periods) as u64;
        // Whole periods in whole ticks: the frequency moves a little for it.
        let periods = (ticks(self.window_s, self.window_periods) / self.tick_hz * hz).ceil();
        let window = (periods * self.tick_hz / hz).round();
        let turn = TAU * periods / window;
        let (mut returned, mut injected) = (Complex::new(0.0, 0.0), Complex::new(0.0, 0.0));
        for tick in 0..settle + window as u64 {
            let phase = turn * tick as f64;
            // Comes up over half of the transient, so that it excites little else.
            let rise = (2.0 * tick as f64 / settle.max(1) as f64).min(1.0);
            let sides = closed.tick(self.amplitude * part * rise * phase.sin())?;
            if tick >= settle {
                let turned = Complex::new(phase.cos(), -phase.sin());
                returned += turned * sides.returned;
                injected += turned * sides.injected;
            }
        }
        Ok(ResponsePoint::new(
            periods * self.tick_hz / window,
            -returned / injected,
            part,
        ))
    }
}
