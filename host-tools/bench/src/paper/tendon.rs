//! Fig. 6: what is published of the tendon's stiffness.

use super::row::{PaperRow, Topic};
use leg_model::{Elasticity, Error};
use leg_rig::rig_file::RigFile;

/// Tension and stiffness that the paper names, N and N/m.
pub(super) const PUBLISHED: [(f64, f64); 2] = [(0.0, 2.9e4), (8.0, 1.5e4)];

/// The initial stiffness, and where and how low it is lowest.
pub(super) fn rows(rig: &RigFile) -> Result<Vec<PaperRow>, Error> {
    let [tendon, ..] = &rig.tendons;
    let mut lowest = (0.0, f64::INFINITY);
    for step in 0..=2000 {
        let tension = 0.01 * f64::from(step);
        let stiffness = tendon.stiffness(tension)?;
        if stiffness < lowest.1 {
            lowest = (tension, stiffness);
        }
    }
    let [(start, first), (turn, least)] = PUBLISHED;
    let row = |what, numbers, unit, bound, why| {
        PaperRow::new(Topic::Tendon, what, numbers, (unit, 1), why).bounded(bound)
    };
    let why_stiffness = "the default curve goes through it";
    let why_turn = "the default curve turns there; beyond it, the stiffness at the pretension is fixed by Fig. 9 and the slope \
                 between is a choice";
    let initial = (first, tendon.stiffness(start)?);
    Ok(vec![
        row(
            "stiffness when the pull begins",
            initial,
            "N/m",
            0.01 * first,
            why_stiffness,
        ),
        row(
            "lowest stiffness",
            (least, lowest.1),
            "N/m",
            0.01 * least,
            why_stiffness,
        ),
        row(
            "tension at the lowest stiffness",
            (turn, lowest.0),
            "N",
            0.5,
            why_turn,
        ),
    ])
}
