//! What a map of the workspace shows of a pose.

use super::Query;
use super::state::State;
use crate::{Error, Rig, Scalar};

/// The part of an [`Evaluation`](super::Evaluation) that a map shows, to the last bit, at a fraction of its cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Survey<T> {
    /// Linear deviation of the tip under the whole load, m.
    pub deviation_m: T,
    /// The smallest and the largest stiffness against a tilt, the load's own stiffness included, N·m/rad.
    pub bending_stiffness_nm_per_rad: [T; 2],
    /// Tensions at the asked level, N.
    pub tensions_n: [T; 3],
    /// Lowest and highest level inside the tension bounds, N; lowest above highest when there is none.
    pub level_range_n: [T; 2],
}

/// Surveys one of many poses of a rig. A demanded stiffness is not looked at.
///
/// # Errors
/// As [`evaluate`](super::evaluate), at the same poses.
pub fn survey<T: Scalar>(rig: &Rig<T, 3>, query: &Query<T>) -> Result<Survey<T>, Error> {
    let state = State::new(*rig, query)?;
    let distribution = &state.distribution;
    let tensions = distribution.tensions(query.level_n);
    // Beyond a tendon's curve nothing is known of it, even where its stiffness is read at the pretension.
    state.unstretched(&query.tendons, &tensions)?;
    let stiffness = state.stiffness(query, &tensions)?;
    let sag = state.sag(&stiffness.total, &stiffness)?;
    let load_stiffness = state.load.stiffness(&state.direction);
    Ok(Survey {
        deviation_m: sag.deviation,
        bending_stiffness_nm_per_rad: state.bending(&(stiffness.total + load_stiffness))?,
        tensions_n: tensions.into(),
        level_range_n: [distribution.lowest_level, distribution.highest_level],
    })
}
