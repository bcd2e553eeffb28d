//! How a simulation begins.

use super::leg::Leg;
use super::tendon_pull::RealTendon;
use leg_model::{
    Direction, Error, HoldError, Load, Quantity, Reason, Rig, TensionBounds, elastic_torsion,
    inverse_kinematics, inverse_statics,
};
use leg_rig::rig_file::RigFile;

/// How the leg is at first; it is at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    /// It hangs straight down without a payload, and every tendon is longer than its way by as much.
    Slack {
        /// m.
        slack_m: f64,
    },
    /// The tendons hold it at a pose with a payload, as [`leg_model::inverse_statics`] says.
    Held {
        /// Azimuth, degrees.
        azimuth_deg: f64,
        /// Tilt, degrees.
        tilt_deg: f64,
        /// Pretension, N.
        pretension_n: f64,
        /// kg.
        payload_kg: f64,
    },
}

impl Start {
    /// Where the leg points, as horizontal components.
    #[must_use]
    pub fn direction(&self) -> [f64; 2] {
        match *self {
            Self::Slack { .. } => [0.0; 2],
            Self::Held {
                azimuth_deg,
                tilt_deg,
                ..
            } => {
                let (sin, cos) = azimuth_deg.to_radians().sin_cos();
                let sine = tilt_deg.to_radians().sin();
                [sine * cos, sine * sin]
            }
        }
    }
}

/// What a start says of the leg and its tendons.
#[derive(Clone, Copy, Debug)]
pub(super) struct Begun {
    pub leg: Leg,
    /// Length of each tendon without tension, m.
    pub unstretched_m: [f64; 3],
    pub payload_kg: f64,
}

impl Start {
    pub(super) fn begin(
        &self,
        file: &RigFile,
        rig: &Rig<f64, 3>,
        tendons: &[RealTendon; 3],
    ) -> Result<Begun, Error> {
        match *self {
            Self::Slack { slack_m } => slack(rig, slack_m),
            Self::Held {
                azimuth_deg,
                tilt_deg,
                pretension_n,
                payload_kg,
            } => {
                let direction =
                    Direction::from_angles(azimuth_deg.to_radians(), tilt_deg.to_radians())?;
                held(file, rig, tendons, direction, pretension_n, payload_kg)
            }
        }
    }
}

/// No support twists the leg that hangs straight down.
fn slack(rig: &Rig<f64, 3>, slack_m: f64) -> Result<Begun, Error> {
    let down = Direction::down();
    let lengths = inverse_kinematics(rig.geometry(), &down)?.lengths;
    Ok(Begun {
        leg: Leg::at_rest(down, 0.0),
        unstretched_m: lengths.add_scalar(slack_m).into(),
        payload_kg: 0.0,
    })
}

fn held(
    file: &RigFile,
    rig: &Rig<f64, 3>,
    tendons: &[RealTendon; 3],
    direction: Direction<f64>,
    pretension_n: f64,
    payload_kg: f64,
) -> Result<Begun, Error> {
    let bounds = TensionBounds::new(file.f_min_n, file.f_max_n)?;
    let moment = Load::new(rig, payload_kg)?.moment(&direction);
    let support = &file.support;
    let torsion = elastic_torsion(rig, support, &direction, &moment, &bounds, pretension_n)?;
    let hold = inverse_statics(
        rig,
        support,
        &direction,
        &moment,
        &bounds,
        &file.tendons,
        pretension_n,
    )
    .map_err(refusal)?;
    let mut unstretched_m: [f64; 3] = hold.unstretched.into();
    for (i, tendon) in tendons.iter().enumerate() {
        let tension = hold.tensions[i];
        unstretched_m[i] += file_elongation_m(file, i, tension)? - tendon.elongation_m(tension)?;
    }
    Ok(Begun {
        leg: Leg::at_rest(direction, torsion),
        unstretched_m,
        payload_kg,
    })
}

/// What the rig file's curve has in the place of the real tendon's elongation, m.
fn file_elongation_m(file: &RigFile, tendon: usize, tension_n: f64) -> Result<f64, Error> {
    use leg_model::Elasticity;
    file.tendons[tendon].elongation(tension_n)
}

fn refusal(error: HoldError) -> Error {
    match error {
        HoldError::Model(error) => error,
        HoldError::OutOfBounds(_) => Error::Refused {
            quantity: Quantity::Pretension,
            reason: Reason::OutOfRange,
        },
        HoldError::Infeasible(_) => Error::Infeasible,
    }
}
