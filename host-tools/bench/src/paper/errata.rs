//! The errors of the print, each shown by its numbers.

mod rig;
mod statics;
mod stiffness;

use leg_base::numeric::by_rotation;
use leg_model::{Direction, Error, evaluate};
use leg_model_tools::plain_vectors::{Tendons, load_moment, rotation, turn};
use leg_rig::rig_file::RigFile;
use nalgebra::{Matrix3, Vector3};
use serde::Serialize;

/// An error of the print.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Erratum {
    /// Where it stands.
    pub place: &'static str,
    /// What is wrong there.
    pub wrong: &'static str,
    /// What is right.
    pub right: &'static str,
    /// What the two numbers are.
    pub number: &'static str,
    /// The number as printed.
    pub printed: f64,
    /// The number as corrected.
    pub corrected: f64,
    /// Their unit.
    pub unit: &'static str,
}

/// Azimuth and tilt at which the errors are shown, degrees.
const POSE_DEG: (f64, f64) = (30.0, 30.0);

/// The payload with which they are shown.
const PAYLOAD_KG: f64 = 2.0;

/// A leg at that pose, loaded.
struct Shown<'a> {
    rig: &'a RigFile,
    azimuth: f64,
    tilt: f64,
    direction: Direction<f64>,
    rotation: Matrix3<f64>,
    tensions: Vector3<f64>,
    tendons: Tendons<3>,
    load: Vector3<f64>,
}

/// Every erratum.
pub(super) fn all(rig: &RigFile) -> Result<Vec<Erratum>, Error> {
    let shown = Shown::new(rig)?;
    Ok(vec![
        shown.equation_1(),
        shown.equation_3(),
        shown.equations_5_6_23(),
        shown.equation_7(),
        shown.equation_14(),
        shown.equation_15(),
        shown.equation_18(),
        stiffness::equation_19(),
        shown.equation_20()?,
        shown.equation_21(),
        shown.mass()?,
        shown.centroid(),
        rig::figure_11(),
        rig::section_4(rig)?,
        rig::elastic_length(rig)?,
    ])
}

impl<'a> Shown<'a> {
    fn new(rig: &'a RigFile) -> Result<Self, Error> {
        let (azimuth, tilt) = (POSE_DEG.0.to_radians(), POSE_DEG.1.to_radians());
        let query = rig.query(POSE_DEG.0, POSE_DEG.1, PAYLOAD_KG);
        let rotation = rotation(azimuth, tilt, 0.0);
        Ok(Self {
            rig,
            azimuth,
            tilt,
            direction: Direction::from_angles(azimuth, tilt)?,
            rotation,
            tensions: evaluate(&rig.parameters, &query)?.tensions_n.into(),
            tendons: Tendons::new(&rig.parameters, &rotation),
            load: load_moment(&rig.parameters, &rotation, PAYLOAD_KG),
        })
    }

    /// ∂n/∂ψ of a tendon, by differences.
    fn change_of_pull(&self, tendon: usize) -> Matrix3<f64> {
        let parameters = &self.rig.parameters;
        by_rotation(|psi| Tendons::new(parameters, &(turn(&psi) * self.rotation)).pulls[tendon])
    }
}
