//! What a map of the workspace shows of a pose.

use super::Query;
use super::balanced_leg::{BalancedLeg, StiffnessParts};
use crate::{Error, Rig, Scalar};
use nalgebra::SVector;

/// The part of an [`Evaluation`](super::Evaluation) that a map shows, to the last bit, at a fraction of its cost.
///
/// What is at the asked pretension may be missing where the rest is not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapEvaluation<T> {
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

/// Evaluates one of many poses of a rig. A demanded stiffness is ignored.
///
/// # Errors
/// A part of the query that is refused; what the model cannot solve at this pose at any pretension.
pub fn evaluate_for_map<T: Scalar>(
    rig: &Rig<T, 3>,
    query: &Query<T>,
) -> Result<MapEvaluation<T>, Error> {
    match BalancedLeg::new(*rig, query) {
        Ok(leg) => Ok(known_pretension(&leg, query)),
        Err(error @ Error::Refused { .. }) => Err(error),
        Err(error) => pretension_limits_alone(rig, query, error),
    }
}

fn known_pretension<T: Scalar>(leg: &BalancedLeg<T>, query: &Query<T>) -> MapEvaluation<T> {
    let distribution = &leg.distribution;
    let tensions = distribution.tensions(query.pretension_n);
    let (deviation_m, bending_stiffness_nm_per_rad) = match stiffness(leg, query, &tensions) {
        Ok(stiffness) => {
            let loaded = stiffness.total + leg.load.stiffness(&leg.direction);
            let sag = leg.sag(&stiffness.total, &stiffness);
            (sag.map(|sag| sag.deviation), leg.bending(&loaded))
        }
        Err(error) => (Err(error), Err(error)),
    };
    MapEvaluation {
        pretension_range_n: [distribution.pretension_min, distribution.pretension_max],
        tensions_n: Ok(tensions.into()),
        deviation_m,
        bending_stiffness_nm_per_rad,
    }
}

fn stiffness<T: Scalar>(
    leg: &BalancedLeg<T>,
    query: &Query<T>,
    tensions: &SVector<T, 3>,
) -> Result<StiffnessParts<T>, Error> {
    // Beyond a tendon's curve nothing is known of it, even where its stiffness is read at the pretension.
    leg.unstretched(&query.tendons, tensions)?;
    leg.stiffness(query, tensions)
}

/// Where the pretension does not hold the leg's twist: only the range of those that may.
fn pretension_limits_alone<T: Scalar>(
    rig: &Rig<T, 3>,
    query: &Query<T>,
    error: Error,
) -> Result<MapEvaluation<T>, Error> {
    if !query.support.twists() {
        return Err(error);
    }
    let pretension_n = T::HALF * query.f_min_n + T::HALF * query.f_max_n;
    let leg = BalancedLeg::new(
        *rig,
        &Query {
            pretension_n,
            ..*query
        },
    )?;
    Ok(MapEvaluation {
        pretension_range_n: [
            leg.distribution.pretension_min,
            leg.distribution.pretension_max,
        ],
        tensions_n: Err(error),
        deviation_m: Err(error),
        bending_stiffness_nm_per_rad: Err(error),
    })
}
