//! What the model says of a leg that tendons of constant stiffness hold at a pose.

use super::MjcfError;
use crate::leg_shape::LegShape;
use crate::line_error::LineError;
use leg_model::{
    Direction, Elasticity, Error, Evaluation, Query, Rig, RigParameters, Support, evaluate,
    inverse_kinematics,
};
use leg_rig::number::decimal;
use leg_rig::rig_file::RigFile;
use nalgebra::{Rotation3, Vector3};
use std::f64::consts::TAU;

/// Azimuths at the greatest tilt between which the lengths of the tendons are looked for.
const AZIMUTHS: u32 = 72;

/// A tendon in its straight line, the tangent of its curve at its tension; and the motor that pulls it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeldTendon {
    /// N/m.
    pub stiffness_n_per_m: f64,
    /// Length without tension, m.
    pub unstretched_m: f64,
    /// How far the motor has to pay out, below zero, and reel in to reach every pose of the workspace from this one, m.
    pub travel_m: [f64; 2],
    /// Length for a count of the encoder, m.
    pub m_per_count: f64,
    /// Time constant of the motor's servo, s.
    pub servo_time_s: f64,
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
    /// Sizes and inertias.
    pub(crate) shape: LegShape,
    /// Damping of the joint against every rotation, N·m·s/rad.
    pub joint_damping_nm_s_per_rad: f64,
    /// Damping of a taut tendon, N·s/m.
    pub tendon_damping_n_s_per_m: f64,
}

impl HeldLeg {
    /// The leg at the pose, the load and the pretension of a query.
    ///
    /// The stiffness of each tendon is that at its tension, and its unstretched length is such that its tension balances the
    /// load.
    ///
    /// # Errors
    /// What [`evaluate`] refuses; [`MjcfError::Infeasible`] and [`MjcfError::Pretension`] if a tension is outside its bounds;
    /// [`MjcfError::Shape`].
    pub fn new(rig: &RigFile, query: &Query<f64>) -> Result<Self, MjcfError> {
        let parameters = &rig.parameters;
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
            tendons: tendons(rig, query, &evaluation).map_err(LineError::from)?,
            shape: LegShape::new(rig, query.payload_kg)?,
            joint_damping_nm_s_per_rad: rig.plant.joint_damping_nm_s_per_rad,
            tendon_damping_n_s_per_m: rig.plant.tendon_damping_n_s_per_m,
        })
    }

    /// From the joint centre to the tip, m.
    #[must_use]
    pub fn tip_m(&self) -> f64 {
        self.parameters.joint_length_m + self.parameters.leg_length_m
    }

    /// Inertia against a tilt about the joint centre, kg·m², the payload's as that of a point.
    #[must_use]
    pub fn tilt_inertia_kg_m2(&self) -> f64 {
        let (tip, centroid) = (self.tip_m(), self.parameters.leg_centroid_m);
        let [across, _] = self.shape.inertia;
        across + self.parameters.leg_mass_kg * centroid * centroid + self.payload_kg * tip * tip
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

fn tendons(
    rig: &RigFile,
    query: &Query<f64>,
    evaluation: &Evaluation<f64>,
) -> Result<[HeldTendon; 3], Error> {
    let workspace_m = lengths_in_workspace(rig, &query.support)?;
    let mut tendons = [HeldTendon::default(); 3];
    for (i, tendon) in tendons.iter_mut().enumerate() {
        let (tension, length) = (evaluation.tensions_n[i], evaluation.lengths_m[i]);
        tendon.stiffness_n_per_m = query.tendons[i].stiffness(tension)?;
        tendon.unstretched_m = length - tension / tendon.stiffness_n_per_m;
        let [shortest, longest] = workspace_m[i];
        // The pose may be beyond the workspace.
        tendon.travel_m = [(length - longest).min(0.0), (length - shortest).max(0.0)];
        tendon.m_per_count = rig.calibration.m_per_count[i].abs();
        tendon.servo_time_s = 1.0 / decimal(rig.gains.servos[i].position_gain_per_s);
    }
    Ok(tendons)
}

/// The least and the greatest length of each tendon, m, where the leg leans the farthest.
fn lengths_in_workspace(rig: &RigFile, support: &Support<f64>) -> Result<[[f64; 2]; 3], Error> {
    let straight = Rig::new(&rig.parameters)?;
    let mut lengths = [[f64::INFINITY, 0.0]; 3];
    for i in 0..AZIMUTHS {
        let azimuth_rad = TAU * f64::from(i) / f64::from(AZIMUTHS);
        let direction = Direction::from_angles(azimuth_rad, rig.tilt_deg.to_radians())?;
        let geometry = straight.geometry().twisted(&support.twist(&direction));
        let found = inverse_kinematics(&geometry, &direction)?.lengths;
        for ([shortest, longest], length) in lengths.iter_mut().zip(&found) {
            *shortest = shortest.min(*length);
            *longest = longest.max(*length);
        }
    }
    Ok(lengths)
}
