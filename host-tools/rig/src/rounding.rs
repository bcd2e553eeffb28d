//! The model's arguments in f64, rounded to what crosses the link.

use leg_firmware::messages::{QueryMessage, SupportMessage, TendonMessage, TendonsMessage};
use leg_model::{
    CurvePoint, JointStiffness, Query, RigParameters, StiffnessDemand, Support, Tendon,
};

/// A mechanism.
#[must_use]
pub fn round_rig(rig: &RigParameters<f64, 3>) -> RigParameters<f32, 3> {
    RigParameters {
        base_anchors_m: rig.base_anchors_m.map(|point| point.map(round)),
        leg_anchors_m: rig.leg_anchors_m.map(|point| point.map(round)),
        upper_length_m: round(rig.upper_length_m),
        joint_length_m: round(rig.joint_length_m),
        leg_length_m: round(rig.leg_length_m),
        leg_mass_kg: round(rig.leg_mass_kg),
        leg_centroid_m: round(rig.leg_centroid_m),
        gravity_m_per_s2: round(rig.gravity_m_per_s2),
    }
}

/// A query.
#[must_use]
pub fn round_query(query: &Query<f64>) -> QueryMessage {
    QueryMessage {
        azimuth_rad: round(query.azimuth_rad),
        tilt_rad: round(query.tilt_rad),
        payload_kg: round(query.payload_kg),
        pretension_n: round(query.pretension_n),
        f_min_n: round(query.f_min_n),
        f_max_n: round(query.f_max_n),
        tendons: round_tendons(&query.tendons),
        stiffness_at: query.stiffness_at,
        support: round_support(&query.support),
        demand: query.demand.map(|demand| StiffnessDemand {
            stiffness_nm_per_rad: round(demand.stiffness_nm_per_rad),
            towards_rad: demand.towards_rad.map(round),
        }),
    }
}

/// A support.
#[must_use]
pub fn round_support(support: &Support<f64>) -> SupportMessage {
    let joint = support.joint();
    SupportMessage {
        kind: support.kind(),
        joint: JointStiffness {
            bending_nm_per_rad: round(joint.bending_nm_per_rad),
            torsion_nm_per_rad: round(joint.torsion_nm_per_rad),
            axial_compliance_m_per_n: round(joint.axial_compliance_m_per_n),
        },
    }
}

/// Three tendons; those that are alike cross the link once.
#[must_use]
pub fn round_tendons(tendons: &[Tendon<f64>; 3]) -> TendonsMessage {
    let [first, second, third] = tendons;
    if first == second && second == third {
        TendonsMessage::Alike(round_tendon(first))
    } else {
        TendonsMessage::Each(tendons.each_ref().map(round_tendon))
    }
}

fn round_tendon(tendon: &Tendon<f64>) -> TendonMessage {
    match tendon {
        Tendon::Constant(constant) => TendonMessage::Constant(round(constant.stiffness_n_per_m())),
        Tendon::Curve(curve) => TendonMessage::Curve(curve.points().map(round_point).collect()),
    }
}

fn round_point(point: CurvePoint<f64>) -> CurvePoint<f32> {
    CurvePoint {
        tension_n: round(point.tension_n),
        elongation_m: round(point.elongation_m),
        stiffness_n_per_m: round(point.stiffness_n_per_m),
    }
}

/// To the nearest f32; beyond its range that is infinite, and the model refuses it by name.
#[must_use]
#[allow(
    clippy::cast_possible_truncation,
    reason = "rounding is what is asked for"
)]
pub fn round(value: f64) -> f32 {
    value as f32
}
