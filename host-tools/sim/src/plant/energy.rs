//! Energy of the leg and the work done on it: the tests check their balance.
//!
//! The work is counted in every build and not for tests alone, so that what they check is the step that runs.

use super::Plant;

/// Work since the start, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Work {
    /// Of the sliders on the tendons.
    pub sliders_j: f64,
    /// Of the pushes at the tip.
    pub push_j: f64,
    /// Brought by payload that was put on, in its place and with the leg's speed.
    pub payload_j: f64,
    /// Lost in joint and tendons.
    pub damping_j: f64,
    /// Lost in impacts on the stop.
    pub stop_j: f64,
    /// Lost with tendons that were cut.
    pub cut_j: f64,
}

impl Plant {
    /// Energy of the motion, the tendons, the joint and the weights, J; that of the weights is zero with the leg horizontal.
    pub(super) fn energy_j(&self) -> f64 {
        let (dynamics, leg) = (&self.dynamics, &self.leg);
        let joint_j = dynamics
            .support
            .joint_energy(&leg.direction, leg.torsion_rad);
        dynamics.inertia.kinetic_j(&leg.direction, &leg.rate)
            + dynamics.springs_j(leg, self.unstretched_m())
            + joint_j
            + dynamics.load.energy(&leg.direction)
    }

    /// By how much the energy differs from that at a time before any work, and the work since then, J: the error of the
    /// integration.
    #[cfg(test)]
    pub(super) fn energy_gap_j(&self, before_j: f64) -> f64 {
        let work = &self.work;
        let lost_j = work.damping_j + work.stop_j + work.cut_j;
        self.energy_j() - before_j - (work.sliders_j + work.push_j + work.payload_j - lost_j)
    }
}
