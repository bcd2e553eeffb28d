//! Errata in the description of the rig.

use super::{Erratum, POSE_DEG, Shown};
use crate::paper::kinematics::CONFIGURATIONS;
use leg_model::{Elasticity, Error, RigParameters, Tendon, evaluate};
use leg_model_tools::plain_vectors::load_moment;
use leg_rig::rig_file::RigFile;
use nalgebra::Matrix3;

impl Shown<'_> {
    pub(super) fn mass(&self) -> Result<Erratum, Error> {
        let sag = |leg_mass_kg: f64| {
            let parameters = RigParameters {
                leg_mass_kg,
                ..self.rig.parameters
            };
            let query = self.rig.query(POSE_DEG.0, POSE_DEG.1, 0.0);
            evaluate(&parameters, &query).map(|evaluation| evaluation.deviation_m * 1e3)
        };
        Ok(Erratum {
            place: "Table 1",
            wrong: "the leg's mass is 1 kg",
            right: "1.5 kg, as the note in Fig. 9 says",
            number: "deviation of the unloaded leg, 2 mm in Fig. 9",
            printed: sag(1.0)?,
            corrected: sag(self.rig.parameters.leg_mass_kg)?,
            unit: "mm",
        })
    }

    pub(super) fn centroid(&self) -> Erratum {
        let p = &self.rig.parameters;
        // (28, 91, 0) in {A}: 91 mm beside the vertical axis.
        let beside = 0.028_f64.hypot(0.091);
        Erratum {
            place: "Table 1",
            wrong: "the centroid (28, 91, 0) mm is not in the axes of {A}",
            right: "on the leg's axis, 91 mm below the joint",
            number: "moment of the leg's weight when it hangs straight down",
            printed: beside * p.leg_mass_kg * p.gravity_m_per_s2,
            corrected: load_moment(p, &Matrix3::identity(), 0.0).norm(),
            unit: "N·m",
        }
    }
}

pub(super) fn figure_11() -> Erratum {
    let configuration = &CONFIGURATIONS[0];
    let moment = configuration
        .model()
        .map(|(_, map)| (map * configuration.tensions_n).y);
    Erratum {
        place: "Fig. 11",
        wrong: "a moment of 100 N·m",
        right: "100 N·mm",
        number: "what the printed tensions balance",
        printed: 100.0,
        corrected: moment.unwrap_or(f64::NAN),
        unit: "N·m",
    }
}

/// The test piece (0.6 mm × 120 mm) is not the rig's tendon (0.8 mm × 100 mm), whose geometric length is 35 mm.
pub(super) fn section_4(rig: &RigFile) -> Result<Erratum, Error> {
    let [tendon, ..] = &rig.tendons;
    let Tendon::Curve(curve) = tendon else {
        return Err(Error::Singular);
    };
    let section = (0.8_f64 / 0.6).powi(2);
    let scaled: Vec<_> = curve
        .points()
        .map(|point| point.scaled(100.0 / 120.0, section))
        .collect();
    Ok(Erratum {
        place: "Sec. 4",
        wrong: "the stiffness of a rope of 0.6 mm × 120 mm is used for one of 0.8 mm × 100 mm",
        right: "by length and section the tendon is 32/15 as stiff",
        number: "lowest stiffness as tested, and scaled",
        printed: tendon.stiffness(8.0)?,
        corrected: Tendon::curve(&scaled)?.stiffness(8.0)?,
        unit: "N/m",
    })
}

/// Between the plates a tendon is 35 mm long when the leg hangs; it stretches over the 100 mm to its slider.
pub(super) fn elastic_length(rig: &RigFile) -> Result<Erratum, Error> {
    let p = &rig.parameters;
    let hanging = evaluate(p, &rig.query(0.0, 0.0, 0.0))?;
    let [length_m, ..] = hanging.lengths_m;
    let [tendon, ..] = &rig.tendons;
    let right = tendon.stiffness(rig.pretension_n)?;
    Ok(Erratum {
        place: "Sec. 4, Table 1",
        wrong: "the length between the plates is taken as what stretches",
        right: "the 100 mm to the slider, whatever the pose",
        number: "stiffness at the pretension, if only the length between the plates stretched",
        printed: right * ELASTIC_LENGTH_M / length_m,
        corrected: right,
        unit: "N/m",
    })
}

/// From the leg's plate to the slider, m.
const ELASTIC_LENGTH_M: f64 = 0.1;
