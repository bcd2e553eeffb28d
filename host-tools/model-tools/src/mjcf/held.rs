//! What the model says of a leg that tendons of constant stiffness hold at a pose.

use super::MjcfError;
use crate::line_error::LineError;
use leg_model::{
    Direction, Elasticity, Error, Evaluation, Query, RigParameters, StiffnessAt, Support, evaluate,
};
use nalgebra::{Rotation3, Vector3};

/// Damping beside the critical one.
const DAMPING_RATIO: f64 = 0.1;

/// A tendon in its straight line: the tangent of its curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldTendon {
    /// N/m.
    pub stiffness_n_per_m: f64,
    /// Length without tension, m.
    pub unstretched_m: f64,
}

/// A loaded leg at rest at a pose.
#[derive(Clone, Copy, Debug)]
pub struct HeldLeg {
    /// The geometry and the masses.
    pub parameters: RigParameters<f64, 3>,
    /// The central support.
    pub support: Support<f64>,
    /// Direction towards which the leg leans, degrees.
    pub azimuth_deg: f64,
    /// How far, degrees.
    pub tilt_deg: f64,
    /// Mass at the tip, kg.
    pub payload_kg: f64,
    /// Pretension, N.
    pub pretension_n: f64,
    /// R: the rotation of the leg, its torsion included.
    pub rotation: Rotation3<f64>,
    /// What holds it there.
    pub tendons: [HeldTendon; 3],
    /// The smallest stiffness against a tilt, N·m/rad.
    pub bending_nm_per_rad: f64,
}

impl HeldLeg {
    /// The leg at the pose, the load and the pretension of a query.
    ///
    /// The stiffness of each tendon is read where the query says, and its unstretched length is such that its tension
    /// balances the load.
    ///
    /// # Errors
    /// What [`evaluate`] refuses; [`MjcfError::Infeasible`] and [`MjcfError::Pretension`] if a tension is outside its bounds.
    pub fn new(parameters: &RigParameters<f64, 3>, query: &Query<f64>) -> Result<Self, MjcfError> {
        let evaluation = evaluate(parameters, query).map_err(LineError::from)?;
        check_pretension(query.pretension_n, &evaluation)?;
        let rotation = rotation(query, evaluation.torsion_rad).map_err(LineError::from)?;
        Ok(Self {
            parameters: *parameters,
            support: query.support,
            azimuth_deg: query.azimuth_rad.to_degrees(),
            tilt_deg: query.tilt_rad.to_degrees(),
            payload_kg: query.payload_kg,
            pretension_n: query.pretension_n,
            rotation,
            tendons: tendons(query, &evaluation).map_err(LineError::from)?,
            bending_nm_per_rad: evaluation.bending_stiffness_nm_per_rad[0],
        })
    }

    /// From the joint centre to the tip, m.
    #[must_use]
    pub fn tip_m(&self) -> f64 {
        self.parameters.joint_length_m + self.parameters.leg_length_m
    }

    /// Inertia against a tilt about the joint centre, kg·m²: the leg's as that of a slender rod, the payload's as that
    /// of a point.
    #[must_use]
    pub fn tilt_inertia_kg_m2(&self) -> f64 {
        let (tip, centroid) = (self.tip_m(), self.parameters.leg_centroid_m);
        self.parameters.leg_mass_kg * (tip * tip / 12.0 + centroid * centroid)
            + self.payload_kg * tip * tip
    }

    /// Damping of a tilt, N·m·s/rad: a tenth of the critical.
    #[must_use]
    pub fn damping_nm_s_per_rad(&self) -> f64 {
        2.0 * DAMPING_RATIO * (self.bending_nm_per_rad * self.tilt_inertia_kg_m2()).sqrt()
    }
}

fn check_pretension(pretension_n: f64, evaluation: &Evaluation<f64>) -> Result<(), MjcfError> {
    let [lowest_n, highest_n] = evaluation.pretension_range_n;
    if !evaluation.feasible {
        return Err(MjcfError::Infeasible);
    }
    if pretension_n < lowest_n || pretension_n > highest_n {
        return Err(MjcfError::Pretension {
            pretension_n,
            lowest_n,
            highest_n,
        });
    }
    Ok(())
}

fn rotation(query: &Query<f64>, torsion_rad: f64) -> Result<Rotation3<f64>, Error> {
    let direction = Direction::from_angles(query.azimuth_rad, query.tilt_rad)?;
    let tilted = Rotation3::from_matrix_unchecked(direction.rotation());
    Ok(tilted * Rotation3::from_axis_angle(&Vector3::z_axis(), torsion_rad))
}

fn tendons(query: &Query<f64>, evaluation: &Evaluation<f64>) -> Result<[HeldTendon; 3], Error> {
    let mut tendons = [HeldTendon {
        stiffness_n_per_m: 0.0,
        unstretched_m: 0.0,
    }; 3];
    for (i, tendon) in tendons.iter_mut().enumerate() {
        let tension = evaluation.tensions_n[i];
        let read_at_n = match query.stiffness_at {
            StiffnessAt::Pretension => query.pretension_n,
            StiffnessAt::Tension => tension,
        };
        tendon.stiffness_n_per_m = query.tendons[i].stiffness(read_at_n)?;
        tendon.unstretched_m = evaluation.lengths_m[i] - tension / tendon.stiffness_n_per_m;
    }
    Ok(tendons)
}
