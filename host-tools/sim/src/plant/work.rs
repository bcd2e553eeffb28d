//! What goes into the leg and out of it: the books of its energy.

use std::ops::AddAssign;

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
