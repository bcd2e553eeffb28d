//! What an image did wrong.

use std::collections::BTreeSet;
use std::fmt;

/// Findings of one kind at one place are reported once; more kinds than these are not kept.
const FINDINGS_MAX: usize = 64;

/// Where the program is not known yet.
const UNKNOWN: u32 = 0;

/// Something that the real chip forbids, or that only works by chance.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChipFinding {
    /// When, cycles since the power-up.
    pub cycle: u64,
    /// Where the program was: the address of the instruction.
    pub pc: u32,
    /// What was wrong, as a sentence: `TIM1_CR1 is written while its clock is off`.
    pub text: String,
}

impl fmt::Display for ChipFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} (cycle {}, pc {:#010x})",
            self.text, self.cycle, self.pc
        )
    }
}

/// The findings of a run.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    list: Vec<ChipFinding>,
    known: BTreeSet<String>,
    /// The cycle that a finding belongs to.
    now: u64,
}

impl Findings {
    /// Says when what follows happens; where the program is, [`Self::locate`] says afterwards.
    pub fn set_cycle(&mut self, cycle: u64) {
        self.now = cycle;
    }

    /// Adds a finding, unless the same text is known.
    pub fn add(&mut self, text: impl Into<String>) {
        let text = text.into();
        if self.list.len() < FINDINGS_MAX && self.known.insert(text.clone()) {
            let (cycle, pc) = (self.now, UNKNOWN);
            self.list.push(ChipFinding { cycle, pc, text });
        }
    }

    /// Says where the program is, for the findings of the instruction that it has just executed.
    pub fn locate(&mut self, pc: u32) {
        for finding in self.list.iter_mut().rev().take_while(|f| f.pc == UNKNOWN) {
            finding.pc = pc;
        }
    }

    /// All of them, in the order in which they came.
    #[must_use]
    pub fn list(&self) -> &[ChipFinding] {
        &self.list
    }
}
