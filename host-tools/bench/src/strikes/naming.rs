//! When a strike has to be named.

use super::activity::Activity;
use leg_sim::plant::Defect;

/// Time to the fault's name, s.
pub(super) const NAMED_S: f64 = 0.5;

/// The same of a cell that wanders, while it is off by so many N, and of one that drifts, s. As a random walk it comes back to its tension
/// again and again, and shows nothing then; while a leg arms or moves, less is compared. For one that drifts to the maximum tension a leg lowers its pretension, and
/// a part of what its other tendons change by then is allowed for the curves of all. Of 4 500 that drift one was named later than this, after
/// 8.66 s (`--seed 301132 --count 3000 --state following --fault cell_drifting`, #1158919).
pub(super) const WANDERS_BY_N: f64 = 12.0;
pub(super) const WANDERS_S: f64 = 1.5;
pub(super) const DRIFTS_S: f64 = 8.0;

/// For how long a cell drifts before a leg at rest is stopped, s, but for those that are near to that bar.
pub(super) const DRIFTED_S: f64 = 7.0;

/// By how much a cell wanders until it is named, as one deviation, N: 20 N by the root of 2 s, for it is off for a part of the time alone.
pub(super) const WANDERED_N: f64 = 28.3;

/// Error of a cell from which on it has to be named, N.
const WRONG_BY_N: f64 = 8.0;

/// How far a motor has to go for its failure to show, m: 1 mm at the tip.
const SHOWN_M: f64 = 1e-4;

/// A leg without its strike.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unstruck {
    /// True tensions when it is struck, N.
    pub tensions_n: [f64; 3],
    /// The highest from then on, N.
    pub highest_n: [f64; 3],
    /// How far each motor goes from then on, m of its tendon.
    pub travels_m: [f64; 3],
}

/// When a defect has to be named.
pub(super) fn named_s(defect: Defect, activity: Activity, before: &Unstruck) -> Option<f64> {
    let tensions_n = before.tensions_n;
    use Activity::{Disarmed, Following, Held, Homing, Moving, RampingDown};
    // Tendons that barely pull, or less and less, show little.
    let pulls = !matches!(activity, Homing | RampingDown | Disarmed);
    // On its way a leg changes its tensions by itself.
    let rests = matches!(activity, Following | Held);
    let wrong = |by_n: f64| (pulls && by_n.abs() >= WRONG_BY_N).then_some(NAMED_S);
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
        Defect::CellStuck(_) | Defect::TendonCut(_) | Defect::TendonSlips(_) => {
            pulls.then_some(NAMED_S)
        }
        Defect::CellReversed(_) | Defect::ExcitationLost => pulls.then_some(NAMED_S),
        Defect::CellExcitationLost(i) | Defect::CellFades(i) => wrong(tensions_n[i]),
        Defect::CellWanders(_) => pulls.then_some(WANDERS_S),
        Defect::CellDrifting(_) => rests.then_some(DRIFTS_S),
        Defect::CellFollows(i) if rests => wrong(tensions_n[(i + 1) % 3] - tensions_n[i]),
        // One that has hardly to turn on shows nothing.
        Defect::EncoderLost(i) | Defect::EncoderReversed(i) | Defect::MotorJammed(i) => {
            (activity == Moving && before.travels_m[i] >= SHOWN_M).then_some(NAMED_S)
        }
        _ => None,
    }
}
