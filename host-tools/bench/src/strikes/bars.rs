//! What a strike may do at most.

use super::activity::Activity;
use leg_sim::plant::Defect;

/// How far the leg may go beyond its maximum tension, as a part.
const BEYOND: f64 = 0.1;

/// The highest tension while homing, N.
const HOMING_N: f64 = 40.0;

/// How far the tip may move from where it rests, and off its way, mm.
const REST_MM: f64 = 0.5;
const WAY_MM: f64 = 3.0;

/// The same where a gain is 20 % off, which cannot be told from a load, mm.
const GAIN_MM: f64 = 1.1;

/// How far the tip may come down where it has to: a tendon that is cut, one that slips by 5 mm, and a leg that relaxes
/// because its drivers are too hot, mm.
const CUT_MM: f64 = 250.0;
const SLIP_MM: f64 = 120.0;
const RELAXED_MM: f64 = 80.0;

/// The same where a tendon grows longer unseen, where a driver runs away until it is cut off, and where a hand holds the
/// tip that should move, mm.
const CREEP_MM: f64 = 5.0;
const RUNAWAY_MM: f64 = 3.0;
const GRASPED_MM: f64 = 250.0;

/// Time to the fault's name, s.
const NAMED_S: f64 = 0.5;

/// The same besides the time in which a cell fades, and for one that wanders or drifts, s.
const FADE_S: f64 = 0.5;
const WANDERS_S: f64 = 2.0;
const DRIFTS_S: f64 = 5.0;

/// How far a cell has to lie before it must be told, N.
const LIE_N: f64 = 8.0;

/// The bars of one strike.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bars {
    /// Highest tension, N.
    pub tension_n: f64,
    /// The same while homing, N.
    pub homing_n: f64,
    /// How far the tip may go, mm.
    pub tip_mm: f64,
    /// When a fault has to be named, s; none where nothing shows it.
    pub named_s: Option<f64>,
}

impl Bars {
    /// Of a defect at a true tension of each tendon, N.
    pub fn new(
        defect: Option<Defect>,
        activity: Activity,
        f_max_n: f64,
        tensions_n: [f64; 3],
    ) -> Self {
        let usual_mm = if activity.on_the_way() {
            WAY_MM
        } else {
            REST_MM
        };
        let tip_mm = match defect {
            Some(Defect::TendonCut(_)) => CUT_MM,
            Some(Defect::TendonSlips(_)) => SLIP_MM,
            Some(Defect::Overheating) => RELAXED_MM,
            Some(Defect::TendonCreeps(_)) => CREEP_MM,
            Some(Defect::DriverFullOn(_) | Defect::DirectionStuck(_)) => RUNAWAY_MM,
            Some(Defect::LegGrasped) => GRASPED_MM,
            Some(
                Defect::CellGainStep(_)
                | Defect::CellGainStepDown(_)
                | Defect::CellGainDrift(_)
                | Defect::CellGainDriftDown(_)
                | Defect::ExcitationSags,
            ) => usual_mm.max(GAIN_MM),
            _ => usual_mm,
        };
        Self {
            tension_n: f_max_n * (1.0 + BEYOND),
            homing_n: HOMING_N,
            tip_mm,
            named_s: defect.and_then(|defect| named_s(defect, activity, tensions_n)),
        }
    }
}

/// When a defect has to be named.
fn named_s(defect: Defect, activity: Activity, tensions_n: [f64; 3]) -> Option<f64> {
    use Activity::{Disarmed, Homing, Moving, RampingDown};
    // Tendons that barely pull, or less and less, show little.
    let pulls = !matches!(activity, Homing | RampingDown | Disarmed);
    let lies = |by_n: f64| (pulls && by_n.abs() >= LIE_N).then_some(NAMED_S);
    let driven = activity != Disarmed;
    match defect {
        Defect::DriverFault(_) | Defect::LateTicks | Defect::SettingsCorrupt => Some(NAMED_S),
        Defect::SupplySag
        | Defect::SupplySurge
        | Defect::CellSaturated(_)
        | Defect::CellDead(_)
        | Defect::CellStale(_)
        | Defect::CurrentOffset(_)
        | Defect::CurrentFullScale(_)
        | Defect::CurrentDead(_)
        | Defect::DriverFullOn(_) => driven.then_some(NAMED_S),
        Defect::CellHum(_)
        | Defect::CellStuck(_)
        | Defect::TendonCut(_)
        | Defect::TendonSlips(_) => pulls.then_some(NAMED_S),
        Defect::CellReversed(_) | Defect::ExcitationLost => pulls.then_some(NAMED_S),
        Defect::CellsSwapped => lies(tensions_n[1] - tensions_n[0]),
        Defect::CellExcitationLost(i) => lies(tensions_n[i]),
        Defect::CellFades(i) => lies(tensions_n[i]).map(|named_s| named_s + FADE_S),
        Defect::CellWanders(_) => pulls.then_some(WANDERS_S),
        Defect::CellDrifting(_) => pulls.then_some(DRIFTS_S),
        Defect::CellFollows(i) => lies(tensions_n[(i + 1) % 3] - tensions_n[i]),
        Defect::CellOffsetStep(_) | Defect::CellOffsetStepDown(_) => pulls.then_some(NAMED_S),
        Defect::EncoderLost(_) | Defect::EncoderReversed(_) | Defect::MotorJammed(_) => {
            (activity == Moving).then_some(NAMED_S)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_says_the_bars() {
        let page = include_str!("../../../docs/scenarios.md");
        for words in [
            format!(
                "the maximum tension and {:.0} %; {HOMING_N} N while homing",
                100.0 * BEYOND
            ),
            format!("{REST_MM} mm; {GAIN_MM} mm where a gain is 20 % off"),
            format!("| tip off its way | {WAY_MM} mm |"),
            format!(
                "{CUT_MM} mm where a tendon is cut, {SLIP_MM} mm where it slips, {RELAXED_MM} mm where the drivers are too hot"
            ),
            format!(
                "{CREEP_MM} mm where it creeps, {RUNAWAY_MM} mm where a driver runs away, {GRASPED_MM} mm where a hand holds the tip"
            ),
            format!(
                "{NAMED_S} s where something shows it; a cell that fades {} s, wanders {WANDERS_S} s, drifts {DRIFTS_S} s",
                NAMED_S + FADE_S
            ),
        ] {
            assert!(page.contains(&words), "{words}");
        }
    }
}
