//! Errata in the description of the rig.

use super::{LoadedPose, Numbers, POSE_DEG};
use crate::paper::kinematics::CONFIGURATIONS;
use leg_model::{Elasticity, Error, RigParameters, Tendon, evaluate};
use leg_model_tools::plain_vectors::load_moment;
use leg_rig::rig_file::RigFile;
use nalgebra::Matrix3;

impl LoadedPose<'_> {
    pub(super) fn mass(&self) -> Result<Numbers, Error> {
        let sag = |leg_mass_kg: f64| {
            let parameters = RigParameters {
                leg_mass_kg,
                ..self.rig.parameters
            };
            let query = self.rig.query(POSE_DEG.0, POSE_DEG.1, 0.0);
            evaluate(&parameters, &query).map(|evaluation| evaluation.deviation_m * 1e3)
        };
        Ok((sag(1.0)?, sag(self.rig.parameters.leg_mass_kg)?))
    }

    pub(super) fn centroid(&self) -> Result<Numbers, Error> {
        let p = &self.rig.parameters;
        // (28, 91, 0) in {A}: 91 mm beside the vertical axis.
        let distance_m = 0.028_f64.hypot(0.091);
        Ok((
            distance_m * p.leg_mass_kg * p.gravity_m_per_s2,
            load_moment(p, &Matrix3::identity(), 0.0).norm(),
        ))
    }
}

pub(super) fn figure_11() -> Result<Numbers, Error> {
    let configuration = &CONFIGURATIONS[0];
    let moment = configuration
        .model()
        .map(|(_, map)| (map * configuration.tensions_n).y);
    Ok((100.0, moment.unwrap_or(f64::NAN)))
}

/// The test piece (0.6 mm × 120 mm) is not the rig's tendon (0.8 mm × 100 mm), whose geometric length is 35 mm.
pub(super) fn section_4(rig: &RigFile) -> Result<Numbers, Error> {
    let [tendon, ..] = &rig.tendons;
    let Tendon::Curve(curve) = tendon else {
        return Err(Error::Singular);
    };
    let section = (0.8_f64 / 0.6).powi(2);
    let scaled: Vec<_> = curve
        .points()
        .map(|point| point.scaled(100.0 / 120.0, section))
        .collect();
    Ok((
        tendon.stiffness(8.0)?,
        Tendon::curve(&scaled)?.stiffness(8.0)?,
    ))
}

/// Between the plates a tendon is 35 mm long when the leg hangs; it stretches over the 100 mm to its slider.
pub(super) fn elastic_length(rig: &RigFile) -> Result<Numbers, Error> {
    let p = &rig.parameters;
    let hanging = evaluate(p, &rig.query(0.0, 0.0, 0.0))?;
    let [length_m, ..] = hanging.lengths_m;
    let [tendon, ..] = &rig.tendons;
    let right = tendon.stiffness(rig.pretension_n)?;
    Ok((right * ELASTIC_LENGTH_M / length_m, right))
}

/// From the leg's plate to the slider, m.
const ELASTIC_LENGTH_M: f64 = 0.1;
