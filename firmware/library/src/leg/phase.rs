//! The schedule of two cycles: which part of the control law each of their eight ticks computes.

/// A tick of the cycle. The control law is spread over [`CYCLE_TICKS`](crate::control::CYCLE_TICKS) of them, so that no
/// tick computes all of it; the axes' controllers run in every tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Estimates the pose; the monitors check the motor of axis 1.
    Estimate,
    /// Makes a step of the load and of what is added to the lengths, in every other cycle.
    Offsets,
    /// Makes a step of the search for the pretension, in the other cycles.
    Pretension,
    /// Executes a command in the place of that search: no command keeps the load and the brake of the swing waiting.
    Command,
    /// Computes the next target and the goals of the axes; the monitors check the motor of axis 2.
    Target,
    /// Goes on with the plan of a trajectory, and watches whether the sensors agree; the monitors check the
    /// load cells, and the motor of axis 3.
    Plan,
}

impl Phase {
    /// The phase of the next tick; `offsets_had` is whether the offsets had the last cycle.
    #[inline(always)]
    pub const fn next(self, offsets_had: &mut bool) -> Self {
        match self {
            Self::Estimate => {
                *offsets_had = !*offsets_had;
                if *offsets_had {
                    Self::Offsets
                } else {
                    Self::Pretension
                }
            }
            Self::Offsets | Self::Pretension | Self::Command => Self::Target,
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
            Self::Offsets | Self::Pretension | Self::Command => None,
            Self::Target => Some(1),
            Self::Plan => Some(2),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Phase;

    /// Offsets and search have every other cycle, of four ticks each.
    #[test]
    fn the_second_tick_of_a_cycle_is_that_of_the_offsets_or_of_the_search() {
        let (mut phase, mut offsets_had) = (Phase::Estimate, true);
        for second in [Phase::Pretension, Phase::Offsets, Phase::Pretension] {
            for next in [second, Phase::Target, Phase::Plan, Phase::Estimate] {
                phase = phase.next(&mut offsets_had);
                assert_eq!(phase, next);
            }
        }
    }
}
