//! Commands that wait for their cycle, and what became of those that were executed.

use crate::command::{Command, CommandRefusal};
use heapless::Deque;

/// Commands that may wait: a cycle executes one.
const COMMANDS_MAX: usize = 8;

/// What became of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// The number that the command was given.
    pub number: u16,
    /// Whether it was executed.
    pub result: Result<(), CommandRefusal>,
}

/// Two queues: commands in, outcomes out.
#[derive(Clone, Debug, Default)]
pub struct CommandQueue {
    waiting: Deque<(u16, Command), COMMANDS_MAX>,
    outcomes: Deque<Outcome, COMMANDS_MAX>,
}

impl CommandQueue {
    /// Takes a command; false if there is no room.
    pub fn push(&mut self, number: u16, command: Command) -> bool {
        self.waiting.push_back((number, command)).is_ok()
    }

    /// The command that has waited longest.
    #[inline(always)]
    pub fn pop(&mut self) -> Option<(u16, Command)> {
        self.waiting.pop_front()
    }

    /// Refuses every command that waits: a stop comes first.
    pub fn supersede(&mut self) {
        while let Some((number, _)) = self.pop() {
            self.report(number, Err(CommandRefusal::Superseded));
        }
    }

    /// Notes what became of a command.
    pub fn report(&mut self, number: u16, result: Result<(), CommandRefusal>) {
        if self.outcomes.is_full() {
            // Nobody reads them: the oldest is lost.
            self.outcomes.pop_front();
        }
        let _ = self.outcomes.push_back(Outcome { number, result });
    }

    /// The oldest outcome that has not been read.
    pub fn outcome(&mut self) -> Option<Outcome> {
        self.outcomes.pop_front()
    }

    /// Takes over the outcomes of another queue.
    pub fn inherit_outcomes(&mut self, before: &mut Self) {
        core::mem::swap(&mut self.outcomes, &mut before.outcomes);
    }
}
