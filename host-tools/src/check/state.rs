//! One state of the mechanism, in numbers that f32 can hold.

use crate::support_word;
use leg_firmware::kernels::KernelInput;
use leg_model::{Query, RigParameters, SupportKind};
use serde::Serialize;
use std::fmt;

/// Everything that the firmware gets, for a whole evaluation and for its kernels (which know no support).
#[derive(Clone, Copy, Debug)]
pub struct State {
    /// The mechanism, the pose, the load and the tendons.
    pub input: KernelInput,
    /// How the central support guides the leg.
    pub support: SupportKind,
}

/// Where a state is, in a human's units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pose {
    /// Azimuth, degrees.
    pub azimuth_deg: f64,
    /// Tilt, degrees.
    pub tilt_deg: f64,
    /// Payload, kg.
    pub payload_kg: f64,
    /// Level of pretension, N.
    pub level_n: f64,
    /// Stiffness of each tendon, N/m.
    pub stiffness_n_per_m: f64,
    /// How the central support guides the leg.
    pub support: SupportKind,
}

impl State {
    /// Where it is.
    #[must_use]
    pub fn pose(&self) -> Pose {
        let input = &self.input;
        Pose {
            azimuth_deg: f64::from(input.azimuth_rad).to_degrees(),
            tilt_deg: f64::from(input.tilt_rad).to_degrees(),
            payload_kg: input.payload_kg.into(),
            level_n: input.level_n.into(),
            stiffness_n_per_m: input.stiffness_n_per_m.into(),
            support: self.support,
        }
    }

    /// What a whole evaluation gets, in either precision.
    #[must_use]
    pub fn query<T: From<f32>>(&self) -> Query<T> {
        let input = &self.input;
        Query {
            azimuth_rad: input.azimuth_rad.into(),
            tilt_rad: input.tilt_rad.into(),
            payload_kg: input.payload_kg.into(),
            level_n: input.level_n.into(),
            tension_floor_n: input.tension_floor_n.into(),
            tension_ceiling_n: input.tension_ceiling_n.into(),
            stiffness_n_per_m: input.stiffness_n_per_m.into(),
            support: self.support,
        }
    }

    /// The mechanism in f64.
    #[must_use]
    pub fn rig(&self) -> RigParameters<f64, 3> {
        let rig = &self.input.rig;
        RigParameters {
            base_anchors_m: rig.base_anchors_m.map(|point| point.map(f64::from)),
            leg_anchors_m: rig.leg_anchors_m.map(|point| point.map(f64::from)),
            upper_length_m: rig.upper_length_m.into(),
            joint_length_m: rig.joint_length_m.into(),
            leg_length_m: rig.leg_length_m.into(),
            leg_mass_kg: rig.leg_mass_kg.into(),
            leg_centroid_m: rig.leg_centroid_m.into(),
            gravity_m_per_s2: rig.gravity_m_per_s2.into(),
        }
    }
}

impl fmt::Display for Pose {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "azimuth {:.1}°, tilt {:.1}°, {:.2} kg, {:.1} N, {:.2e} N/m, {}",
            self.azimuth_deg,
            self.tilt_deg,
            self.payload_kg,
            self.level_n,
            self.stiffness_n_per_m,
            support_word::of(self.support),
        )
    }
}
