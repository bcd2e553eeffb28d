//! Fig. 6: what is published of the tendon's stiffness.

use super::row::{Meaning, Row, Topic, Verdict};
use leg_model::{Elasticity, Error};
use leg_rig::rig_file::RigFile;

/// Tension and stiffness that the paper names, N and N/m.
pub(super) const PUBLISHED: [(f64, f64); 2] = [(0.0, 2.9e4), (8.0, 1.5e4)];

/// The stiffness when the pull begins, and where and how low it is lowest.
pub(super) fn rows(rig: &RigFile) -> Result<Vec<Row>, Error> {
    let [tendon, ..] = &rig.tendons;
    let row = |what: &str, published: f64, ours: f64, unit, bound, why| Row {
        topic: Topic::Tendon,
        what: what.into(),
        published,
        meaning: Meaning::Value,
        ours,
        unit,
        decimals: 1,
        bound,
        expected: Verdict::Agrees,
        why,
    };
    let mut lowest = (0.0, f64::INFINITY);
    for step in 0..=2000 {
        let tension = 0.01 * f64::from(step);
        let stiffness = tendon.stiffness(tension)?;
        if stiffness < lowest.1 {
            lowest = (tension, stiffness);
        }
    }
    let [(start, first), (turn, least)] = PUBLISHED;
    Ok(vec![
        row(
            "stiffness when the pull begins",
            first,
            tendon.stiffness(start)?,
            "N/m",
            0.01 * first,
            "the default curve goes through it",
        ),
        row(
            "lowest stiffness",
            least,
            lowest.1,
            "N/m",
            0.01 * least,
            "the default curve goes through it",
        ),
        row(
            "tension at the lowest stiffness",
            turn,
            lowest.0,
            "N",
            0.5,
            "the default curve turns there; beyond it, the stiffness at the pretension is fixed by Fig. 9 and the slope \
             between is a choice",
        ),
    ])
}
