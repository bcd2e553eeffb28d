//! Where the leg's energy is, and what goes into it and out of it.

use super::Plant;
use std::ops::AddAssign;

/// Energy of the leg, J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy {
    /// Of its motion.
    pub kinetic_j: f64,
    /// Of the stretched tendons.
    pub tendons_j: f64,
    /// Of the elastic joint.
    pub joint_j: f64,
    /// Of the weights; zero with the leg horizontal.
    pub weights_j: f64,
}

impl Energy {
    /// All of it, J.
    #[must_use]
    pub fn total_j(&self) -> f64 {
        self.kinetic_j + self.tendons_j + self.joint_j + self.weights_j
    }
}

/// Work since the start, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Work {
    /// Of the sliders on the tendons.
    pub sliders_j: f64,
    /// Of the pushes at the tip.
    pub push_j: f64,
    /// Brought by payload that was put on, in its place and with the leg's speed.
    pub payload_j: f64,
    /// Lost in the joint.
    pub joint_damping_j: f64,
    /// Lost in the tendons.
    pub tendon_damping_j: f64,
    /// Lost in blows on the stop.
    pub stop_j: f64,
    /// Lost with tendons that were cut.
    pub cut_j: f64,
}

impl Work {
    /// All that went in less all that was lost, J: the change of the leg's energy, but for the integration's error.
    #[must_use]
    pub fn gained_j(&self) -> f64 {
        self.sliders_j + self.push_j + self.payload_j - self.lost_j()
    }

    /// What the leg lost, J.
    #[must_use]
    pub fn lost_j(&self) -> f64 {
        self.joint_damping_j + self.tendon_damping_j + self.stop_j + self.cut_j
    }
}

impl AddAssign for Work {
    fn add_assign(&mut self, other: Self) {
        self.sliders_j += other.sliders_j;
        self.push_j += other.push_j;
        self.payload_j += other.payload_j;
        self.joint_damping_j += other.joint_damping_j;
        self.tendon_damping_j += other.tendon_damping_j;
        self.stop_j += other.stop_j;
        self.cut_j += other.cut_j;
    }
}

impl Plant {
    /// Where the energy is.
    #[must_use]
    pub fn energy(&self) -> Energy {
        let (mechanism, leg) = (&self.mechanism, &self.leg);
        let support = &mechanism.support;
        Energy {
            kinetic_j: mechanism.body.kinetic_j(&leg.direction, &leg.rate),
            tendons_j: mechanism.springs_j(leg, self.unstretched_m()),
            joint_j: support.joint_energy(&leg.direction, leg.torsion_rad),
            weights_j: mechanism.load.energy(&leg.direction),
        }
    }

    /// What went in and out since the start.
    #[must_use]
    pub fn work(&self) -> Work {
        self.work
    }
}
