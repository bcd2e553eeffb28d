//! A leg in the place of another on the same board: with other settings, or at their defaults.

use super::Leg;
use super::mode::Mode;
use leg_model::Scalar;

impl<T: Scalar> Leg<T> {
    /// Forgets where its tendons are: it has to home.
    pub fn forget_zero(&mut self) {
        self.shared.zero_m = None;
    }

    /// Refuses the commands that wait. Whoever lets another leg take this one's place does it before, where that takes too long at once.
    pub fn refuse_commands(&mut self) {
        self.queue.refuse_waiting();
    }

    /// Starts in the place of another leg on the same board: with its count of ticks and the faults that nobody has cleared.
    /// The commands that wait are refused, and their outcomes reported from here.
    pub fn inherit_from(&mut self, before: &mut Self) {
        self.queue.inherit_outcomes(&mut before.queue);
        self.tick = before.tick;
        self.mode = Mode::boot();
        self.supervisor.inherit_faults(before.supervisor.latched());
    }
}
