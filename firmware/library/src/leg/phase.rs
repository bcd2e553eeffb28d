//! The schedule of a cycle: which part of the control law each of its four ticks computes.

/// A tick of the cycle. The control law is spread over [`CYCLE_TICKS`](crate::control::CYCLE_TICKS) of them, so that no
/// tick computes all of it; the axes' controllers run in every tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Estimates the pose; the monitors check the motor of axis 1.
    Estimate,
    /// Makes one step of the search for the pretension or, in every other cycle, of the load and of what is added to the lengths.
    Pretension,
    /// Executes a command in the place of that.
    Command,
    /// Computes the next target and the goals of the axes; the monitors check the motor of axis 2.
    Target,
    /// Goes on with the plan of a trajectory, and watches whether the sensors agree; the monitors check the
    /// load cells, and the motor of axis 3.
    Plan,
}

impl Phase {
    /// The phase of the next tick.
    #[inline(always)]
    pub const fn next(self) -> Self {
        match self {
            Self::Estimate => Self::Pretension,
            Self::Pretension | Self::Command => Self::Target,
            Self::Target => Self::Plan,
            Self::Plan => Self::Estimate,
        }
    }

    /// Whether the monitors check the load cells in this tick: in the one that has the most time left.
    #[inline(always)]
    pub const fn monitors_cells(self) -> bool {
        matches!(self, Self::Plan)
    }

    /// The motor, from 0 to 2, that the monitors check in this tick.
    #[inline(always)]
    pub const fn monitored_motor(self) -> Option<usize> {
        match self {
            Self::Estimate => Some(0),
            Self::Pretension | Self::Command => None,
            Self::Target => Some(1),
            Self::Plan => Some(2),
        }
    }
}
