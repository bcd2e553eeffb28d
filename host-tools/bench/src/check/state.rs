//! One state of the mechanism, in numbers that f32 can hold.

use leg_firmware::settings::TendonParameters;
use leg_firmware_bench::kernels::KernelInput;
use leg_firmware_bench::query::QueryMessage;
use leg_model::{
    CurvePoint, Elasticity, Error, JointStiffness, Query, RigParameters, StiffnessAt,
    StiffnessDemand, SupportKind, TendonCurve,
};
use serde::Serialize;
use std::fmt;

/// Everything that the firmware gets, for a whole evaluation and for its kernels (which know no support).
#[derive(Clone, Copy, Debug)]
pub struct CheckedState {
    /// The mechanism, the pose, the load and the tendons.
    pub input: KernelInput,
    /// How the central support guides the leg.
    pub support: SupportKind,
    /// How its joint resists.
    pub joint: JointStiffness<f32>,
    /// How the tendons stretch.
    pub stretch: Stretch,
    /// Whether the evaluation has to find a pretension for the demanded stiffness: there has to be one that is allowed.
    pub demanded: bool,
}

/// How the tendons of a state stretch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stretch {
    /// With the state's stiffness at every tension.
    Constant,
    /// Along the paper's curve, scaled to have the state's stiffness at its pretension; read at the pretension.
    Curve,
    /// The same, read at each tendon's tension.
    CurveAtTension,
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
    /// Pretension, N.
    pub pretension_n: f64,
    /// Stiffness of each tendon, N/m.
    pub stiffness_n_per_m: f64,
    /// How the central support guides the leg.
    pub support: SupportKind,
    /// How the tendons stretch.
    pub stretch: Stretch,
}

impl CheckedState {
    /// Where it is.
    #[must_use]
    pub fn pose(&self) -> Pose {
        let input = &self.input;
        Pose {
            azimuth_deg: f64::from(input.azimuth_rad).to_degrees(),
            tilt_deg: f64::from(input.tilt_rad).to_degrees(),
            payload_kg: input.payload_kg.into(),
            pretension_n: input.pretension_n.into(),
            stiffness_n_per_m: input.stiffness_n_per_m.into(),
            support: self.support,
            stretch: self.stretch,
        }
    }

    /// What a whole evaluation gets.
    ///
    /// # Errors
    /// A pretension beyond the curve.
    pub fn message(&self) -> Result<QueryMessage, Error> {
        let (input, tendon) = (&self.input, self.tendon()?);
        Ok(QueryMessage {
            azimuth_rad: input.azimuth_rad,
            tilt_rad: input.tilt_rad,
            payload_kg: input.payload_kg,
            pretension_n: input.pretension_n,
            f_min_n: input.f_min_n,
            f_max_n: input.f_max_n,
            tendons: [tendon.clone(), tendon.clone(), tendon],
            stiffness_at: match self.stretch {
                Stretch::CurveAtTension => StiffnessAt::Tension,
                Stretch::Constant | Stretch::Curve => StiffnessAt::Pretension,
            },
            support: self.support,
            joint: self.joint,
            demand: self.demanded.then_some(StiffnessDemand {
                stiffness_nm_per_rad: input.demand_nm_per_rad,
                towards_rad: None,
            }),
        })
    }

    /// The same in f64.
    ///
    /// # Errors
    /// A pretension beyond the curve.
    pub fn query(&self) -> Result<Query<f64>, Error> {
        self.message()?.query()
    }

    fn tendon(&self) -> Result<TendonParameters, Error> {
        let (pretension, stiffness) = (self.input.pretension_n, self.input.stiffness_n_per_m);
        if self.stretch == Stretch::Constant {
            return Ok(TendonParameters::Constant(stiffness));
        }
        let points = CurvePoint::<f32>::PAPER;
        let softening = TendonCurve::new(&points)?.stiffness(pretension)? / stiffness;
        let scaled = points.iter().map(|point| point.scaled(softening, 1.0));
        Ok(TendonParameters::Curve(scaled.collect()))
    }

    /// The mechanism in f64.
    #[must_use]
    pub fn rig(&self) -> RigParameters<f64, 3> {
        self.input.rig.map(f64::from)
    }
}

impl Stretch {
    const fn words(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::Curve => "curve",
            Self::CurveAtTension => "curve at tension",
        }
    }
}

const fn support_words(kind: SupportKind) -> &'static str {
    match kind {
        SupportKind::TorsionFree => "torsion-free",
        SupportKind::Universal => "universal",
        SupportKind::Spherical => "spherical",
        SupportKind::ElasticUniversal => "elastic universal",
    }
}

impl fmt::Display for Pose {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "azimuth {:.1}°, tilt {:.1}°, {:.2} kg, {:.1} N, {:.2e} N/m, {}, {}",
            self.azimuth_deg,
            self.tilt_deg,
            self.payload_kg,
            self.pretension_n,
            self.stiffness_n_per_m,
            self.stretch.words(),
            support_words(self.support),
        )
    }
}
