//! What a map of the workspace shows of a pose.

use super::Query;
use super::state::{State, Stiffness};
use crate::{Error, Rig, Scalar};
use nalgebra::SVector;

/// The part of an [`Evaluation`](super::Evaluation) that a map shows, to the last bit, at a fraction of its cost.
///
/// What is at the asked pretension may be missing where the rest is not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Survey<T> {
    /// Lowest and highest pretension inside the tension bounds, N; lowest above highest when there is none. Known whatever
    /// the asked pretension: where nothing holds a leg's twist at that, the range is that of the twist in the middle of the
    /// bounds.
    pub pretension_range_n: [T; 2],
    /// Tensions at the asked pretension, N, even beyond the tendons' curves; an error if nothing holds the leg's twist there.
    pub tensions_n: Result<[T; 3], Error>,
    /// Linear deviation of the tip under the whole load at the asked pretension, m.
    pub deviation_m: Result<T, Error>,
    /// The smallest and the largest stiffness against a tilt at the asked pretension, the load's own stiffness included,
    /// N·m/rad.
    pub bending_stiffness_nm_per_rad: Result<[T; 2], Error>,
}

/// Surveys one of many poses of a rig. A demanded stiffness is not looked at.
///
/// # Errors
/// A part of the query that is refused; what the model cannot solve at this pose at any pretension.
pub fn survey<T: Scalar>(rig: &Rig<T, 3>, query: &Query<T>) -> Result<Survey<T>, Error> {
    match State::new(*rig, query) {
        Ok(state) => Ok(at_pretension(&state, query)),
        Err(error @ Error::Refused { .. }) => Err(error),
        Err(error) => without_pretension(rig, query, error),
    }
}

fn at_pretension<T: Scalar>(state: &State<T>, query: &Query<T>) -> Survey<T> {
    let distribution = &state.distribution;
    let tensions = distribution.tensions(query.pretension_n);
    let (deviation_m, bending_stiffness_nm_per_rad) = match stiffness(state, query, &tensions) {
        Ok(stiffness) => {
            let loaded = stiffness.total + state.load.stiffness(&state.direction);
            let sag = state.sag(&stiffness.total, &stiffness);
            (sag.map(|sag| sag.deviation), state.bending(&loaded))
        }
        Err(error) => (Err(error), Err(error)),
    };
    Survey {
        pretension_range_n: [distribution.pretension_min, distribution.pretension_max],
        tensions_n: Ok(tensions.into()),
        deviation_m,
        bending_stiffness_nm_per_rad,
    }
}

fn stiffness<T: Scalar>(
    state: &State<T>,
    query: &Query<T>,
    tensions: &SVector<T, 3>,
) -> Result<Stiffness<T>, Error> {
    // Beyond a tendon's curve nothing is known of it, even where its stiffness is read at the pretension.
    state.unstretched(&query.tendons, tensions)?;
    state.stiffness(query, tensions)
}

/// Where the pretension does not hold the leg's twist: only the range of those that may.
fn without_pretension<T: Scalar>(
    rig: &Rig<T, 3>,
    query: &Query<T>,
    error: Error,
) -> Result<Survey<T>, Error> {
    if !query.support.twists() {
        return Err(error);
    }
    let pretension_n = T::HALF * query.f_min_n + T::HALF * query.f_max_n;
    let held = State::new(
        *rig,
        &Query {
            pretension_n,
            ..*query
        },
    )?;
    Ok(Survey {
        pretension_range_n: [
            held.distribution.pretension_min,
            held.distribution.pretension_max,
        ],
        tensions_n: Err(error),
        deviation_m: Err(error),
        bending_stiffness_nm_per_rad: Err(error),
    })
}
