//! How far the tip really sags: the equilibrium of the whole mechanism, without linearisation.
//!
//! Without gravity the leg rests at its pose, pulled by the pretension alone. Then the weights are switched on, and
//! the leg turns until tendons, joint and weights balance again. This is the paper's static simulation, against which
//! the linear deviation is judged.

mod balance;

pub use balance::{Balance, Posture};

use leg_model::{
    Direction, Elasticity, Error, Load, Query, Rig, RigParameters, TensionBounds, Twist, deviation,
    distribute, elastic_torsion, inverse_kinematics,
};
use nalgebra::{SVector, Vector3};

/// Distance of the tip from the pose after the weights are switched on, m.
///
/// `None` where that has no meaning: at a pretension that would have a tendon push, so that nothing holds the leg before
/// the weights come.
///
/// # Errors
/// What [`leg_model::evaluate`] refuses; [`Error::Unstable`] if the leg comes to no rest below the horizon; a tension
/// beyond a tendon's curve; [`Error::NotConverged`].
pub fn deviation_m(
    parameters: &RigParameters<f64, 3>,
    query: &Query<f64>,
) -> Result<Option<f64>, Error> {
    let Some((without_weights, start)) = pretensioned(parameters, query)? else {
        return Ok(None);
    };
    let loaded = without_weights.with_payload(query.payload_kg)?;
    let end = loaded.rest(start)?;
    let turned = (end.direction.vector() - start.direction.vector()) * loaded.tip_m();
    let stretch = loaded.axial_stretch_m(&end)? - without_weights.axial_stretch_m(&start)?;
    Ok(Some(deviation(
        &(turned + end.direction.vector() * stretch),
    )))
}

/// The mechanism without weights, its tendons made to hold it at the query's pose, and its posture there.
fn pretensioned(
    parameters: &RigParameters<f64, 3>,
    query: &Query<f64>,
) -> Result<Option<(Balance, Posture)>, Error> {
    let rig = Rig::new(parameters)?;
    let (support, pretension) = (query.support, query.pretension_n);
    let direction = Direction::from_angles(query.azimuth_rad, query.tilt_rad)?;
    let bounds = TensionBounds::new(query.f_min_n, query.f_max_n)?;
    let torsion = elastic_torsion(
        &rig,
        &support,
        &direction,
        &Vector3::zeros(),
        &bounds,
        pretension,
    )?;
    let twist = support
        .twist(&direction)
        .composed(&Twist::from_torsion(torsion));
    let kinematics = inverse_kinematics(&rig.geometry().twisted(&twist), &direction)?;
    let (map, plane) = (&kinematics.moment_map, support.plane(&direction));
    let joint_moment = support.joint_moment(&direction, torsion);
    let tensions: SVector<f64, 3> =
        distribute(map, &plane, &joint_moment, &bounds)?.tensions(pretension);
    if tensions.iter().any(|&tension| tension < 0.0) {
        return Ok(None);
    }
    let mut unstretched = kinematics.lengths;
    for (i, tendon) in query.tendons.iter().enumerate() {
        unstretched[i] -= tendon.elongation(tensions[i])?;
    }
    let balance = Balance::new(rig, Load::none(), support, query.tendons, unstretched);
    Ok(Some((balance, Posture { direction, torsion })))
}

#[cfg(test)]
mod tests;
