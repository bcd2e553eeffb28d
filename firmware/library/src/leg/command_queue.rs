//! Commands that wait for their cycle, and what became of those that were executed.

use crate::command::{Command, CommandRefusal};
use heapless::Deque;

/// Commands that may wait: two cycles execute one.
const COMMANDS_MAX: usize = 8;

/// What became of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CommandOutcome {
    /// The number that the command was given.
    pub number: u16,
    /// Whether it was executed.
    pub result: Result<(), CommandRefusal>,
}

/// Two queues: commands in, outcomes out.
///
/// What a task does here holds the control interrupt off, so none of it takes longer the more commands wait: a stop only
/// marks them as superseded, and they are refused one by one.
#[derive(Clone, Debug, Default)]
pub struct CommandQueue {
    waiting: Deque<(u16, Command), COMMANDS_MAX>,
    /// How many of those that wait are superseded: the oldest.
    superseded: usize,
    /// One more: a stop refuses all that waits, and is answered, too.
    outcomes: Deque<CommandOutcome, { COMMANDS_MAX + 1 }>,
}

impl CommandQueue {
    /// Takes a command; false if there is no room.
    pub fn push(&mut self, number: u16, command: Command) -> bool {
        if self.waiting.is_full()
            && let Some(refused) = self.refuse()
        {
            self.note(refused);
        }
        self.waiting.push_back((number, command)).is_ok()
    }

    /// The command that has waited longest.
    #[inline(always)]
    pub fn pop(&mut self) -> Option<(u16, Command)> {
        if self.superseded > 0 {
            self.refuse_all();
        }
        self.waiting.pop_front()
    }

    /// Refuses every command that waits: a stop comes first, and finds room.
    pub fn supersede(&mut self) {
        self.superseded = self.waiting.len();
    }

    /// Refuses the oldest command, if it is superseded.
    fn refuse(&mut self) -> Option<CommandOutcome> {
        self.superseded = self.superseded.checked_sub(1)?;
        let (number, _) = self.waiting.pop_front()?;
        let result = Err(CommandRefusal::Superseded);
        Some(CommandOutcome { number, result })
    }

    /// Refuses every command that waits, now.
    pub fn refuse_waiting(&mut self) {
        self.supersede();
        self.refuse_all();
    }

    /// Refuses what is superseded and was not yet.
    #[cold]
    #[inline(never)]
    fn refuse_all(&mut self) {
        while let Some(refused) = self.refuse() {
            self.note(refused);
        }
    }

    /// Notes what became of a command.
    pub fn report(&mut self, number: u16, result: Result<(), CommandRefusal>) {
        self.note(CommandOutcome { number, result });
    }

    fn note(&mut self, outcome: CommandOutcome) {
        if self.outcomes.is_full() {
            // Nobody reads them: the oldest is lost.
            self.outcomes.pop_front();
        }
        let _ = self.outcomes.push_back(outcome);
    }

    /// The oldest outcome that has not been read.
    pub fn outcome(&mut self) -> Option<CommandOutcome> {
        self.outcomes.pop_front().or_else(|| self.refuse())
    }

    /// Takes over the outcomes of another queue, whose commands are refused.
    pub fn inherit_outcomes(&mut self, before: &mut Self) {
        before.refuse_waiting();
        core::mem::swap(&mut self.outcomes, &mut before.outcomes);
    }
}
