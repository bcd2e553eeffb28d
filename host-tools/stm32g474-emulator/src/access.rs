//! What holds for every access to a register, whichever the block.

use crate::facts::{Access, Block, Facts, Register};
use crate::findings::Findings;
use crate::rcc::Rcc;
use std::collections::BTreeMap;

/// A write, for the list of what an image sets.
#[derive(Clone, Copy, Debug)]
pub struct Write {
    /// The block.
    pub block: &'static Block,
    /// The register.
    pub register: &'static Register,
    /// What was written there before, or what a reset gives.
    pub before: u32,
    /// What is written.
    pub value: u32,
}

/// Checks accesses, and remembers what was written.
#[derive(Clone, Debug, Default)]
pub struct AccessChecks {
    last: BTreeMap<u32, u32>,
    /// The writes since the start, while they are recorded.
    recorded: Option<Vec<Write>>,
}

/// A register that answers.
pub type Answering = (&'static Block, &'static Register);

impl AccessChecks {
    /// Forgets what was written: after a reset.
    pub fn reset(&mut self) {
        self.last.clear();
    }

    /// Forgets what was written to a block: after its reset.
    pub fn reset_block(&mut self, block: &Block) {
        self.last
            .retain(|address, _| !(block.base..block.base + block.size).contains(address));
    }

    /// What was written to a register last, or what a reset gives.
    #[must_use]
    pub fn last_written(&self, (block, register): Answering) -> u32 {
        let address = block.base + register.offset;
        self.last.get(&address).copied().unwrap_or(register.reset)
    }

    /// Records all writes from now on.
    pub fn record(&mut self) {
        self.recorded = Some(Vec::new());
    }

    /// The writes that were recorded; recording ends.
    pub fn take_recorded(&mut self) -> Vec<Write> {
        self.recorded.take().unwrap_or_default()
    }

    /// The register at an address, if its block answers.
    pub fn answering(&self, address: u32, rcc: &Rcc, findings: &mut Findings) -> Option<Answering> {
        let Some(block) = Facts::chip().block_at(address) else {
            findings.add(format!(
                "{address:#010x} is accessed, where no peripheral is"
            ));
            return None;
        };
        if block.enable.is_some_and(|switch| !rcc.enabled(switch)) {
            findings.add(format!("{} is accessed while its clock is off", block.name));
            return None;
        }
        if block.reset.is_some_and(|switch| rcc.enabled(switch)) {
            findings.add(format!("{} is accessed while it is in reset", block.name));
            return None;
        }
        let offset = (address - block.base) & !3;
        let Some(register) = block.register_at(offset) else {
            findings.add(format!(
                "{} has no register at offset {offset:#x}, which is accessed",
                block.name
            ));
            return None;
        };
        if register.contradicted {
            findings.add(format!(
                "{}_{} is accessed, about which the makers' descriptions contradict each other, and no ruling says what holds",
                block.name, register.name
            ));
            return None;
        }
        Some((block, register))
    }

    /// Checks a write; false if it has no effect.
    pub fn write(
        &mut self,
        (block, register): Answering,
        value: u32,
        findings: &mut Findings,
    ) -> bool {
        let name = || format!("{}_{}", block.name, register.name);
        if register.access == Access::Read {
            findings.add(format!("{} is written, and can only be read", name()));
            return false;
        }
        let before = self.last_written((block, register));
        let reserved = !register.known & (value ^ register.reset);
        if reserved != 0 && !is_tolerated(block.name, &register.name) {
            findings.add(format!(
                "{} is written with reserved bits {reserved:#010x} changed",
                name()
            ));
        }
        for field in &register.fields {
            if let Some(values) = &field.values {
                let shifted = field.value(value);
                let changed = (value ^ before) & field.mask != 0;
                if changed && !values.contains(&shifted) {
                    findings.add(format!(
                        "{}.{} is set to {shifted}, which has no meaning",
                        name(),
                        field.name
                    ));
                }
            }
        }
        if let Some(recorded) = &mut self.recorded {
            recorded.push(Write {
                block,
                register,
                before,
                value,
            });
        }
        self.last.insert(block.base + register.offset, value);
        true
    }
}

/// Registers in which the drivers write ones to reserved bits on purpose: what the blocks' names begin with, the register,
/// and why nothing comes of it.
const TOLERATED: [(&str, &str, &str); 3] = [
    (
        "TIM",
        "SR",
        "zeros clear a timer's flags, so a driver writes ones everywhere else",
    ),
    (
        "LPUART",
        "ICR",
        "embassy clears the flags by what ISR showed, which has bits that ICR has not",
    ),
    (
        "FDCAN",
        "TXBTIE",
        "embassy enables the interrupts of 32 buffers, of which this chip has three",
    ),
];

fn is_tolerated(block: &str, register: &str) -> bool {
    let mut known = TOLERATED.iter();
    known.any(|(start, name, _)| block.starts_with(start) && register == *name)
}
