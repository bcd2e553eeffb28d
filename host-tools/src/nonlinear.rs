//! How far the tip really sags: the equilibrium of the whole mechanism, without linearisation.
//!
//! Without gravity the leg rests at its pose, pulled by the pretension alone. Then the weights are switched on, and
//! the leg turns until tendons and weights balance again. This is the paper's static simulation, against which the
//! linear deviation is judged.

mod balance;

pub use balance::Balance;

use leg_model::{
    Direction, Distribution, Error, Query, RigParameters, SupportKind, Tendon, TensionBounds,
    deviation, distribute, inverse_kinematics,
};
use nalgebra::{SVector, Vector3};

/// Steps after which a search without convergence ends.
const STEPS_MAX: u32 = 100;

/// The search has converged when a step is not longer than this, rad: a hundred times its rounding.
const STEP_RAD: f64 = 1e-13;

/// Distance of the tip from the pose after the weights are switched on, m.
///
/// `None` where that has no meaning: on a ball joint, whose pose at the level already depends on the weights (they
/// twist it), and at a level that would have a tendon push, so that nothing holds the leg before the weights come.
///
/// # Errors
/// What [`leg_model::evaluate`] refuses; [`Error::Unstable`] if the leg comes to no rest below the horizon;
/// [`Error::NotConverged`].
pub fn deviation_m(
    parameters: &RigParameters<f64, 3>,
    query: &Query<f64>,
) -> Result<Option<f64>, Error> {
    let start = Direction::from_angles(query.azimuth_rad, query.tilt_rad)?;
    let Some(balance) = pretensioned(parameters, query, &start)? else {
        return Ok(None);
    };
    let end = search(&balance, start)?;
    let displacement = (end.vector() - start.vector()) * balance.tip_m();
    Ok(Some(deviation(&displacement)))
}

/// The mechanism whose tendons hold it at `start` without weights.
fn pretensioned(
    parameters: &RigParameters<f64, 3>,
    query: &Query<f64>,
    start: &Direction<f64>,
) -> Result<Option<Balance>, Error> {
    if query.support == SupportKind::Spherical {
        return Ok(None);
    }
    let tendon = Tendon::new(query.stiffness_n_per_m)?;
    let mut balance = Balance::new(parameters, query.payload_kg, query.support, tendon)?;
    let (geometry, plane) = balance.guided(start);
    let kinematics = inverse_kinematics(&geometry, start)?;
    let bounds = TensionBounds::new(query.tension_floor_n, query.tension_ceiling_n)?;
    let internal: Distribution<f64, 3> =
        distribute(&kinematics.moment_map, &plane, &Vector3::zeros(), &bounds)?;
    let tensions = internal.per_level * query.level_n;
    if tensions.iter().any(|&tension| tension < 0.0) {
        return Ok(None);
    }
    balance.unstretched_m =
        SVector::from_fn(|i, _| tendon.unstretched(kinematics.lengths[i], tensions[i]));
    Ok(Some(balance))
}

/// Walks down the potential energy, by Newton's steps where they lead down and by shorter ones elsewhere.
fn search(balance: &Balance, start: Direction<f64>) -> Result<Direction<f64>, Error> {
    let mut here = start;
    for _ in 0..STEPS_MAX {
        let (next, step_rad) = balance.step(&here)?;
        if step_rad <= STEP_RAD {
            return Ok(next);
        }
        here = next;
    }
    Err(Error::NotConverged)
}

#[cfg(test)]
mod tests;
