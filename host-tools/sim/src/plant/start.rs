//! How a simulated leg starts.

use super::leg::LegState;
use super::tendon_pull::RealTendon;
use crate::range;
use leg_base::angles;
use leg_model::{
    Direction, Elasticity, Error, HoldError, Load, Quantity, Reason, Rig, TensionBounds,
    elastic_torsion, inverse_kinematics, inverse_statics,
};
use leg_rig::rig_file::RigFile;
use serde::Deserialize;

/// How the leg is at first; it is at rest.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Start {
    /// It hangs straight down without a payload, every tendon slack by as much. It has to be homed.
    Slack {
        /// mm.
        #[serde(deserialize_with = "range::slack_mm")]
        slack_mm: f64,
    },
    /// The tendons hold it at a pose with a payload, as [`leg_model::inverse_statics`] says. Its zero is known.
    Held {
        /// Azimuth, degrees.
        #[serde(deserialize_with = "range::azimuth_deg")]
        azimuth_deg: f64,
        /// Tilt, degrees.
        #[serde(deserialize_with = "range::start_tilt_deg")]
        tilt_deg: f64,
        /// Pretension, N.
        #[serde(deserialize_with = "range::start_pretension_n")]
        pretension_n: f64,
        /// kg.
        #[serde(deserialize_with = "range::payload_kg")]
        payload_kg: f64,
    },
}

impl Default for Start {
    fn default() -> Self {
        Self::hanging(70.0)
    }
}

/// What a start says of the leg and its tendons.
#[derive(Clone, Copy, Debug)]
pub(super) struct Started {
    pub leg: LegState,
    /// Length of each tendon without tension, m.
    pub unstretched_m: [f64; 3],
    pub payload_kg: f64,
}

impl Start {
    /// Straight down without a payload, the tendons at a pretension, N.
    #[must_use]
    pub const fn hanging(pretension_n: f64) -> Self {
        Self::Held {
            azimuth_deg: 0.0,
            tilt_deg: 0.0,
            pretension_n,
            payload_kg: 0.0,
        }
    }

    /// Where the leg points, as horizontal components.
    #[must_use]
    pub fn direction(&self) -> [f64; 2] {
        match *self {
            Self::Slack { .. } => [0.0; 2],
            Self::Held {
                azimuth_deg,
                tilt_deg,
                ..
            } => angles::direction(azimuth_deg, tilt_deg),
        }
    }

    /// Whether the leg has to be homed.
    #[must_use]
    pub const fn is_slack(&self) -> bool {
        matches!(self, Self::Slack { .. })
    }

    pub(super) fn started(
        &self,
        file: &RigFile,
        rig: &Rig<f64, 3>,
        tendons: &[RealTendon; 3],
    ) -> Result<Started, Error> {
        let (azimuth_deg, tilt_deg, pretension_n, payload_kg) = match *self {
            Self::Slack { slack_mm } => return slack(rig, slack_mm / 1000.0),
            Self::Held {
                azimuth_deg,
                tilt_deg,
                pretension_n,
                payload_kg,
            } => (azimuth_deg, tilt_deg, pretension_n, payload_kg),
        };
        let direction = Direction::from_angles(azimuth_deg.to_radians(), tilt_deg.to_radians())?;
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
            let n = hold.tensions[i];
            unstretched_m[i] += file.tendons[i].elongation(n)? - tendon.elongation_m(n)?;
        }
        Ok(Started {
            leg: LegState::resting(direction, torsion),
            unstretched_m,
            payload_kg,
        })
    }
}

/// No support twists the leg that hangs straight down.
fn slack(rig: &Rig<f64, 3>, slack_m: f64) -> Result<Started, Error> {
    let down = Direction::straight_down();
    let lengths = inverse_kinematics(rig.geometry(), &down)?.lengths;
    Ok(Started {
        leg: LegState::resting(down, 0.0),
        unstretched_m: lengths.add_scalar(slack_m).into(),
        payload_kg: 0.0,
    })
}

fn refusal(error: HoldError) -> Error {
    match error {
        HoldError::Model(error) => error,
        HoldError::OutOfBounds(_) => Error::Refused {
            quantity: Quantity::Pretension,
            reason: Reason::OutOfRange,
        },
        _ => Error::Infeasible,
    }
}
