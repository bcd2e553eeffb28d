//! What a moving leg does by itself whose motors stop at the strike, or when the fault is named.

use super::bars::StrikeBars;
use super::preparation::PreparedLeg;
use leg_sim::plant::Defect;

/// How long it is watched, s: two periods of a first mode of 2 Hz, that of a heavy leg at a low pretension, whose swing only decays.
const WATCHED_S: f64 = 1.0;

/// What a struck leg may do more than that, as a part of it, and off its way, mm: its motors stop some ticks later, or turn on a little.
pub(super) const MORE: f64 = 0.1;
pub(super) const MORE_MM: f64 = 0.5;

/// The most that any such leg may do, as a part beyond its maximum tension and off its way, mm: 226.3 N of 150 N (`--seed 271129`, #10795) and 7.0 mm
/// (`--seed 12001`, #3234) are known.
pub(super) const CUT_OFF_BEYOND: f64 = 0.55;
pub(super) const CUT_OFF_MM: f64 = 8.0;

/// For how long a driver turns its motor in one direction alone, s: until its counter contradicts.
const CONTRADICTED_S: f64 = 0.01;

/// How far a leg goes by itself that is cut off where another is struck: by its speed, its payload and the stretch of its tendons, which
/// no firmware brakes any more.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CutOff {
    /// Highest true tension, N.
    tension_n: f64,
    /// How far the tip is off its way, mm.
    tip_mm: f64,
}

impl CutOff {
    /// Of a leg all of whose drivers switch their motors off, where one is struck by a defect. A motor that stops by itself does so here, too. Any
    /// other leg goes on until a fault is named, s after the strike, and may be faster then: it may do as much as a sound one that is cut off at
    /// that time.
    ///
    /// # Errors
    /// As the simulation.
    pub fn new(
        prepared: &PreparedLeg,
        defect: Defect,
        named_s: Option<f64>,
    ) -> Result<Self, String> {
        let (moves, cut_off_s) = stops_by_itself(defect);
        let struck = Self::stopped_after(prepared, moves, cut_off_s)?;
        // With what stops it by itself it would be the strike itself until it is named: a bar that judges nothing.
        let Some(named_s) = named_s.filter(|_| moves.is_none()) else {
            return Ok(struck);
        };
        let named = Self::stopped_after(prepared, None, named_s)?;
        Ok(Self {
            tension_n: struck.tension_n.max(named.tension_n),
            tip_mm: struck.tip_mm.max(named.tip_mm),
        })
    }

    /// Of one that has a defect, and whose drivers do so a time after the strike, s.
    fn stopped_after(
        prepared: &PreparedLeg,
        moves: Option<Defect>,
        cut_off_s: f64,
    ) -> Result<Self, String> {
        let mut stand = prepared.stand.clone();
        let struck_s = stand.time_s();
        if let Some(moves) = moves {
            stand.plant().set_defect(moves, true);
        }
        let mut found = Self::default();
        while stand.time_s() < struck_s + cut_off_s + WATCHED_S {
            let off = stand.time_s() >= struck_s + cut_off_s;
            for motor in 0..3 {
                stand.plant().set_defect(Defect::DriverFault(motor), off);
            }
            stand.tick()?;
            let tensions_n = stand.truth.tensions_n;
            found.tension_n = tensions_n.into_iter().fold(found.tension_n, f64::max);
            let tip_mm = prepared.way.distance_mm(&stand.truth.tip_m);
            found.tip_mm = found.tip_mm.max(tip_mm);
        }
        Ok(found)
    }

    /// Bars, or what this leg does and a part more where that is wider, within what any may do.
    pub fn widened(&self, bars: StrikeBars, f_max_n: f64) -> StrikeBars {
        let part = 1.0 + MORE;
        let tension_n = (part * self.tension_n).min(f_max_n * (1.0 + CUT_OFF_BEYOND));
        let tip_mm = (part * self.tip_mm + MORE_MM).min(CUT_OFF_MM);
        StrikeBars {
            tension_n: bars.tension_n.max(tension_n),
            tip_mm: bars.tip_mm.max(tip_mm),
            ..bars
        }
    }
}

/// What a motor does that no firmware can change, and when the drivers are switched off then, s.
const fn stops_by_itself(defect: Defect) -> (Option<Defect>, f64) {
    match defect {
        Defect::MotorJammed(_) => (Some(defect), 0.0),
        Defect::DirectionStuck(_)
        | Defect::HalfBridgeOpen(_)
        | Defect::HalfBridgeOpenOutwards(_) => (Some(defect), CONTRADICTED_S),
        // A motor whose tendon seems to be at the maximum tension at once is stopped.
        Defect::CellGainStep(i) | Defect::CellOffsetStep(i) => (Some(Defect::MotorJammed(i)), 0.0),
        _ => (None, 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strikes::activity::Activity;

    /// What is wider than the bars widens them, by no more than any such leg may do.
    #[test]
    fn the_bars_of_a_leg_that_is_cut_off_have_a_ceiling() {
        let bars = StrikeBars::widest(Defect::MotorJammed(0), Activity::Moving, 150.0, false);
        for (tension_n, tip_mm, expected) in [
            (100.0, 1.0, [165.0, 3.0]),
            (200.0, 6.0, [220.0, 7.1]),
            (230.0, 9.0, [232.5, 8.0]),
        ] {
            let cut_off = CutOff { tension_n, tip_mm };
            let widened = cut_off.widened(bars, 150.0);
            assert!(
                (widened.tension_n - expected[0]).abs() < 1e-9,
                "{widened:?}"
            );
            assert!((widened.tip_mm - expected[1]).abs() < 1e-9, "{widened:?}");
        }
    }
}
