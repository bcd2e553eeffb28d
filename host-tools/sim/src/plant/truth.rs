//! What no sensor tells.

use super::work::Work;
use leg_model::Direction;
use nalgebra::Vector3;

/// The state of the simulated leg as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// Time since the start, s.
    pub time_s: f64,
    /// Where the leg points.
    pub direction: Direction<f64>,
    /// Its torsion beyond that which the joint itself gives it, rad.
    pub torsion_rad: f64,
    /// Its rotation in frame {A}, rad/s.
    pub rate_rad_per_s: Vector3<f64>,
    /// The tip in frame {A}, m, without the stretch of joint and shaft along the leg.
    pub tip_m: Vector3<f64>,
    /// Tension of each tendon, N.
    pub tensions_n: [f64; 3],
    /// Length of each tendon without tension, m.
    pub unstretched_m: [f64; 3],
    /// kg.
    pub payload_kg: f64,
    /// Current of each motor, A.
    pub currents_a: [f64; 3],
    /// Speed of each rotor, rad/s.
    pub speeds_rad_per_s: [f64; 3],
    /// Voltage at the drivers, V.
    pub supply_v: f64,
    /// Where the energy is.
    pub energy: Energy,
    /// What went in and out since the start.
    pub work: Work,
}

/// Energy of the leg, J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy {
    /// Of its motion.
    pub kinetic_j: f64,
    /// Of the stretched tendons.
    pub tendons_j: f64,
    /// Of the elastic joint.
    pub joint_j: f64,
    /// Of the weights; zero with the leg pretension.
    pub weights_j: f64,
}

impl Energy {
    /// All of it, J.
    #[must_use]
    pub fn total_j(&self) -> f64 {
        self.kinetic_j + self.tendons_j + self.joint_j + self.weights_j
    }
}
