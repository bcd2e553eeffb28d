//! The constant parts of the leg, what it carries, and how its tendons stretch.

use super::inertia::Inertia;
use super::leg::LegState;
use super::tendon_pull::RealTendon;
use leg_model::{Kinematics, Load, Rig, Support, inverse_kinematics};
use nalgebra::{SMatrix, Vector3};

/// The constant parts of the mechanism, and what they carry.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dynamics {
    pub rig: Rig<f64, 3>,
    pub support: Support<f64>,
    pub tendons: [RealTendon; 3],
    /// Which tendons are cut.
    pub cut: [bool; 3],
    /// The leg with its payload.
    pub inertia: Inertia,
    pub load: Load<f64>,
    /// Force at the tip beside the weights, N.
    pub push_n: Vector3<f64>,
    pub joint_damping_nm_s_per_rad: f64,
    pub tendon_damping_n_s_per_m: f64,
}

impl Dynamics {
    /// From the joint centre to the tip, m.
    pub fn tip_m(&self, leg: &LegState) -> Vector3<f64> {
        leg.direction.vector() * self.rig.tip_m()
    }

    /// Elastic energy of the tendons, J.
    pub fn springs_j(&self, leg: &LegState, unstretched_m: [f64; 3]) -> f64 {
        let elongations = self.elongations_m(&self.kinematics(leg), unstretched_m);
        let pairs = self.tendons.iter().zip(elongations);
        pairs
            .map(|(tendon, elongation)| tendon.energy_j(elongation))
            .sum()
    }

    /// Elongation of each tendon, m; a slack or cut one has zero or less.
    pub fn elongations_m(
        &self,
        kinematics: &Kinematics<f64, 3>,
        unstretched_m: [f64; 3],
    ) -> [f64; 3] {
        std::array::from_fn(|i| {
            if self.cut[i] {
                0.0
            } else {
                kinematics.lengths[i] - unstretched_m[i]
            }
        })
    }

    /// Lengths and moments of the tendons. The stop keeps the leg away from where a tendon has no length.
    pub fn kinematics(&self, leg: &LegState) -> Kinematics<f64, 3> {
        let geometry = leg.geometry(self.rig.geometry(), &self.support);
        inverse_kinematics(&geometry, &leg.direction).unwrap_or(Kinematics {
            lengths: nalgebra::SVector::zeros(),
            moment_map: SMatrix::zeros(),
        })
    }
}
