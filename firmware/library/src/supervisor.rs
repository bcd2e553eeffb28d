//! What may be done: states, faults and the reactions to them. The supervisor can only take authority away.

mod fault;
mod fault_set;
mod monitors;
mod reaction;
mod state;

pub use fault::{FAULT_TABLE, Fault, FaultEntry};
pub use fault_set::FaultSet;
pub use monitors::{
    AWAY_PART, Agreement, ErrorGrowth, Excess, FAR_CYCLES, JAMMED_PART, MonitorInput, Monitors,
    SETTLE_CYCLES,
};
pub use reaction::{Clearing, Reaction};
pub use state::{Event, State};

/// The faults, and what they allow. The state itself is that of the leg's mode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Supervisor {
    latched: FaultSet,
    present: FaultSet,
}

impl Supervisor {
    /// Faults that have not been cleared.
    #[must_use]
    #[inline(always)]
    pub fn latched(&self) -> FaultSet {
        self.latched
    }

    /// Takes over the faults that another supervisor has latched; those that only limit end with their cause.
    pub fn inherit_faults(&mut self, latched: FaultSet) {
        self.latched = self.latched.union(latched.stopping());
    }

    /// Latches the faults of a tick; the state after the most severe reaction of all that are latched.
    #[inline(always)]
    pub fn react(&mut self, state: State, present: FaultSet) -> State {
        self.present = present;
        // Those that only limit end with their cause.
        let latched = self.latched.union(present).stopping();
        self.latched = latched.union(present.limits());
        match self.latched.most_severe() {
            Some(reaction) => state.next(Event::Reaction(reaction)).unwrap_or(state),
            None => state,
        }
    }

    /// The state after an event; none where the event leads nowhere. An arm, a start of homing or a jog leads nowhere while a fault is
    /// latched.
    #[must_use]
    #[inline(always)]
    pub fn next(&self, state: State, event: Event) -> Option<State> {
        let starts = matches!(event, Event::Arm | Event::Home | Event::Jog);
        if starts && self.stopped() {
            return None;
        }
        state.next(event)
    }

    /// Clears the faults whose cause is gone; the next state if none is left. `homed`: whether the leg knows its zero.
    /// `causes` are those that are there, but were not named before.
    pub fn clear(&mut self, state: State, homed: bool, causes: FaultSet) -> Option<State> {
        self.latched = self.present.union(causes);
        if self.stopped() {
            return None;
        }
        state.next(if homed {
            Event::ClearHomed
        } else {
            Event::Clear
        })
    }

    /// Whether another fault than this one is latched that does more than limit.
    #[must_use]
    #[inline(always)]
    pub fn stopped_by_another(&self, fault: Fault) -> bool {
        self.latched
            .stopping()
            .difference(FaultSet::single(fault))
            .any()
    }

    /// Whether a fault is latched that does more than limit.
    #[must_use]
    #[inline(always)]
    pub fn stopped(&self) -> bool {
        self.latched.stopping().any()
    }
}

#[cfg(test)]
mod tests;
