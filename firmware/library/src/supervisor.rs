//! What may be done: states, faults and the reactions to them. The supervisor can only take authority away.

mod fault;
mod fault_set;
mod monitors;
mod state;
mod table;

pub use fault::{Fault, Reaction};
pub use fault_set::FaultSet;
pub use monitors::{AxisView, Monitors, View};
pub use state::{Event, State};
pub use table::{FaultEntry, TABLE};

/// The state, and the faults that led to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Supervisor {
    state: State,
    latched: FaultSet,
    present: FaultSet,
}

impl Default for Supervisor {
    fn default() -> Self {
        Self {
            state: State::Boot,
            latched: FaultSet::NONE,
            present: FaultSet::NONE,
        }
    }
}

impl Supervisor {
    /// The state.
    #[must_use]
    #[inline(always)]
    pub fn state(&self) -> State {
        self.state
    }

    /// Faults that have not been cleared.
    #[must_use]
    #[inline(always)]
    pub fn latched(&self) -> FaultSet {
        self.latched
    }

    /// Faults whose cause is present now.
    #[must_use]
    #[inline(always)]
    pub fn present(&self) -> FaultSet {
        self.present
    }

    /// Takes over the faults that another supervisor has latched; those that only limit end with their cause.
    pub fn inherit(&mut self, latched: FaultSet) {
        self.latched = self.latched.with(latched.without_limits());
    }

    /// Takes the faults of a tick and reacts to the gravest that is latched.
    #[inline(always)]
    pub fn watch(&mut self, present: FaultSet) {
        self.present = present;
        self.latched = self.latched.with(present);
        // Those that only limit end with their cause.
        self.latched = self.latched.without_limits().with(present.limits());
        if self.latched.any()
            && let Some(reaction) = self.latched.gravest()
        {
            self.happen(Event::Reaction(reaction));
        }
    }

    /// Goes where an event leads; stays where it leads nowhere. An arm or a start of homing is refused while a fault is
    /// latched.
    #[inline(always)]
    pub fn happen(&mut self, event: Event) -> bool {
        let starts = matches!(event, Event::Arm | Event::Home);
        if starts && self.latched.without_limits().any() {
            return false;
        }
        match self.state.after(event) {
            Some(state) => {
                self.state = state;
                true
            }
            None => false,
        }
    }

    /// Clears the faults whose cause is gone; if none is left, goes on as the state allows. `homed` tells whether the
    /// leg knows its zero.
    pub fn clear(&mut self, homed: bool) -> bool {
        self.latched = self.present;
        let free = !self.latched.without_limits().any();
        free && self.happen(if homed {
            Event::ClearHomed
        } else {
            Event::Clear
        })
    }
}

#[cfg(test)]
mod tests;
