//! What an instruction of the Cortex-M4F does to the stack pointer and to the program counter, and nothing else.
//!
//! The encodings are those of the ARMv7-M Architecture Reference Manual, DDI 0403E, chapters A5 to A7. An instruction
//! that sets the stack pointer to something that its bytes do not show is [`Effect::UnknownStack`], so that a
//! gap in what is decoded is an error and not a stack that is reported too small.
//!
//! Our own, because yaxpeax-arm 0.5 decodes no floating-point instruction: 44 % of the image for QEMU, `vpush` included.

mod narrow;
#[cfg(test)]
mod tests;
mod wide;

/// Number of the stack pointer among the registers.
const SP: u32 = 13;

/// Number of the link register.
const LR: u32 = 14;

/// Number of the program counter.
const PC: u32 = 15;

/// What an instruction does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Effect {
    /// Nothing that matters here; the stack pointer stays or goes up.
    None,
    /// Nothing at all: what fills a gap behind a function's end.
    Filler,
    /// The stack pointer goes down by so many bytes.
    Down(u32),
    /// The stack pointer is set to what the instruction alone does not tell.
    UnknownStack,
    /// `bl` to an address.
    Call(u32),
    /// A branch to an address, which may or may not be taken.
    MayBranch(u32),
    /// A branch to an address.
    Branch(u32),
    /// `blx` to an address in a register.
    CallRegister,
    /// A branch to an address in a register or in memory that is not a return.
    BranchRegister,
    /// A branch by the table behind the instruction, within the function.
    Switch,
    /// The function's end.
    Return,
    /// The undefined instruction: a fault.
    Trap,
    /// Sets a register to 16 bits.
    Low {
        /// The register's number.
        register: u32,
        /// The bits.
        value: u32,
    },
    /// Sets the upper half of a register to 16 bits.
    High {
        /// The register's number.
        register: u32,
        /// The bits.
        value: u32,
    },
}

impl Effect {
    /// Whether the core need not go on with the next instruction.
    ///
    /// A call may be of a function that does not return, and then no code follows.
    pub(super) const fn may_end(self) -> bool {
        !matches!(
            self,
            Self::None
                | Self::Filler
                | Self::Down(_)
                | Self::UnknownStack
                | Self::MayBranch(_)
                | Self::Low { .. }
                | Self::High { .. }
        )
    }
}

/// An instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Instruction {
    /// Its bytes: 2 or 4.
    pub(super) length: u32,
    /// What it does.
    pub(super) effect: Effect,
}

/// The instruction at the start of `bytes`, which lies at `address`; nothing if the bytes end within it.
pub(super) fn decode(bytes: &[u8], address: u32) -> Option<Instruction> {
    let first = halfword(bytes, 0)?;
    // Three of the 32 values of the uppermost five bits begin an instruction of two halfwords.
    if first >> 11 < 0b11101 {
        return Some(Instruction {
            length: 2,
            effect: narrow::effect(first, address),
        });
    }
    Some(Instruction {
        length: 4,
        effect: wide::effect(first, halfword(bytes, 2)?, address),
    })
}

fn halfword(bytes: &[u8], at: usize) -> Option<u32> {
    let pair = bytes.get(at..at + 2)?;
    Some(u32::from(*pair.first()?) | u32::from(*pair.get(1)?) << 8)
}

/// Some bits of a word.
const fn bits(word: u32, lowest: u32, count: u32) -> u32 {
    (word >> lowest) & ((1 << count) - 1)
}

const fn bit(word: u32, at: u32) -> bool {
    bits(word, at, 1) == 1
}

/// Where a branch leads whose offset is signed and has `width` bits.
const fn target(address: u32, offset: u32, width: u32) -> u32 {
    let unused = 32 - width;
    let signed = ((offset << unused).cast_signed() >> unused).cast_unsigned();
    // The program counter reads as two halfwords ahead.
    address.wrapping_add(4).wrapping_add(signed)
}
