//! The schedule of a cycle: which part of the control law each of its four ticks computes.

/// A tick of the cycle. The control law is spread over [`CYCLE_TICKS`](crate::control::CYCLE_TICKS) of them, so that no
/// tick computes all of it; the axes' controllers run in every tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Estimates pose and load, and watches whether the sensors agree.
    Estimate,
    /// Makes one step of the search for the pretension.
    Pretension,
    /// Computes the next target and the goals of the axes; the monitors check axis 1.
    Target,
    /// Goes on with the plan of a trajectory; the monitors check axes 2 and 3.
    Plan,
}

impl Phase {
    /// The phase of the next tick.
    #[inline(always)]
    pub const fn next(self) -> Self {
        match self {
            Self::Estimate => Self::Pretension,
            Self::Pretension => Self::Target,
            Self::Target => Self::Plan,
            Self::Plan => Self::Estimate,
        }
    }

    /// The axes, from 0 to 2, that the monitors check in this tick: where the control law leaves most time.
    #[inline(always)]
    pub const fn monitored_axes(self) -> &'static [usize] {
        match self {
            Self::Estimate | Self::Pretension => &[],
            Self::Target => &[0],
            Self::Plan => &[1, 2],
        }
    }
}
