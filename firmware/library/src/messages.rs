//! The model's arguments as they cross the link: numbers that are validated where they arrive.

use heapless::Vec;
use leg_model::{
    CURVE_POINTS_MAX, CurvePoint, Error, JointStiffness, Query, RigParameters, Scalar, StiffnessAt,
    StiffnessDemand, Support, SupportKind, Tendon,
};
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// [`RigParameters`] of a mechanism with three tendons, as they cross the link.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
#[allow(missing_docs, reason = "each field is documented at RigParameters")]
pub struct RigMessage {
    pub base_anchors_m: [[f32; 2]; 3],
    pub leg_anchors_m: [[f32; 2]; 3],
    pub upper_length_m: f32,
    pub joint_length_m: f32,
    pub leg_length_m: f32,
    pub leg_mass_kg: f32,
    pub leg_centroid_m: f32,
    pub gravity_m_per_s2: f32,
}

impl From<RigParameters<f32, 3>> for RigMessage {
    fn from(rig: RigParameters<f32, 3>) -> Self {
        Self {
            base_anchors_m: rig.base_anchors_m,
            leg_anchors_m: rig.leg_anchors_m,
            upper_length_m: rig.upper_length_m,
            joint_length_m: rig.joint_length_m,
            leg_length_m: rig.leg_length_m,
            leg_mass_kg: rig.leg_mass_kg,
            leg_centroid_m: rig.leg_centroid_m,
            gravity_m_per_s2: rig.gravity_m_per_s2,
        }
    }
}

impl<T: Scalar> From<RigMessage> for RigParameters<T, 3> {
    fn from(rig: RigMessage) -> Self {
        let anchors = |points: [[f32; 2]; 3]| points.map(|point| point.map(T::from));
        Self {
            base_anchors_m: anchors(rig.base_anchors_m),
            leg_anchors_m: anchors(rig.leg_anchors_m),
            upper_length_m: rig.upper_length_m.into(),
            joint_length_m: rig.joint_length_m.into(),
            leg_length_m: rig.leg_length_m.into(),
            leg_mass_kg: rig.leg_mass_kg.into(),
            leg_centroid_m: rig.leg_centroid_m.into(),
            gravity_m_per_s2: rig.gravity_m_per_s2.into(),
        }
    }
}

/// A [`Support`], as it crosses the link.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct SupportMessage {
    /// How it guides the leg.
    pub kind: SupportKind,
    /// How its joint resists.
    pub joint: JointStiffness<f32>,
}

/// A [`Tendon`], as it crosses the link.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub enum TendonMessage {
    /// Of constant stiffness, N/m.
    Constant(f32),
    /// With a curve through points.
    Curve(Vec<CurvePoint<f32>, CURVE_POINTS_MAX>),
}

/// The three tendons, as they cross the link.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Schema)]
#[allow(
    clippy::large_enum_variant,
    reason = "a message is kept in place: there is no allocation on the board"
)]
pub enum TendonsMessage {
    /// All of one kind.
    Alike(TendonMessage),
    /// Each its own.
    Each([TendonMessage; 3]),
}

/// A [`Query`], as it crosses the link.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Schema)]
#[allow(missing_docs, reason = "each field is documented at Query")]
pub struct QueryMessage {
    pub azimuth_rad: f32,
    pub tilt_rad: f32,
    pub payload_kg: f32,
    pub pretension_n: f32,
    pub f_min_n: f32,
    pub f_max_n: f32,
    pub tendons: TendonsMessage,
    pub stiffness_at: StiffnessAt,
    pub support: SupportMessage,
    pub demand: Option<StiffnessDemand<f32>>,
}

impl QueryMessage {
    /// The query, its tendons and its support validated.
    ///
    /// # Errors
    /// What [`Tendon`] and [`Support`] refuse.
    pub fn query<T: Scalar>(&self) -> Result<Query<T>, Error> {
        Ok(Query {
            azimuth_rad: self.azimuth_rad.into(),
            tilt_rad: self.tilt_rad.into(),
            payload_kg: self.payload_kg.into(),
            pretension_n: self.pretension_n.into(),
            f_min_n: self.f_min_n.into(),
            f_max_n: self.f_max_n.into(),
            tendons: self.tendons.tendons()?,
            stiffness_at: self.stiffness_at,
            support: self.support.support()?,
            demand: self.demand.map(|demand| StiffnessDemand {
                stiffness_nm_per_rad: demand.stiffness_nm_per_rad.into(),
                towards_rad: demand.towards_rad.map(T::from),
            }),
        })
    }
}

impl SupportMessage {
    /// The support, validated.
    ///
    /// # Errors
    /// What [`Support::new`] refuses.
    pub fn support<T: Scalar>(&self) -> Result<Support<T>, Error> {
        let joint = JointStiffness {
            bending_nm_per_rad: self.joint.bending_nm_per_rad.into(),
            torsion_nm_per_rad: self.joint.torsion_nm_per_rad.into(),
            axial_compliance_m_per_n: self.joint.axial_compliance_m_per_n.into(),
        };
        Support::new(self.kind, joint)
    }
}

impl TendonsMessage {
    /// The tendons, validated.
    ///
    /// # Errors
    /// What [`Tendon`] refuses.
    pub fn tendons<T: Scalar>(&self) -> Result<[Tendon<T>; 3], Error> {
        match self {
            Self::Alike(tendon) => Ok([tendon.tendon()?; 3]),
            Self::Each([a, b, c]) => Ok([a.tendon()?, b.tendon()?, c.tendon()?]),
        }
    }
}

impl TendonMessage {
    fn tendon<T: Scalar>(&self) -> Result<Tendon<T>, Error> {
        match self {
            Self::Constant(stiffness) => Tendon::constant((*stiffness).into()),
            Self::Curve(points) => {
                let mut widened_points = Vec::<CurvePoint<T>, CURVE_POINTS_MAX>::new();
                for point in points {
                    // Both have the same capacity; to collect would panic beyond it.
                    let _ = widened_points.push(widened(point));
                }
                Tendon::curve(&widened_points)
            }
        }
    }
}

/// A point in another precision.
#[must_use]
pub fn widened<T: Scalar>(point: &CurvePoint<f32>) -> CurvePoint<T> {
    CurvePoint {
        tension_n: point.tension_n.into(),
        elongation_m: point.elongation_m.into(),
        stiffness_n_per_m: point.stiffness_n_per_m.into(),
    }
}
