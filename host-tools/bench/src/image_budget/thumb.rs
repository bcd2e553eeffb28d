//! What an instruction of the Cortex-M4F does to the stack pointer and to the program counter, and nothing else.
//!
//! The encodings are those of the ARMv7-M Architecture Reference Manual, DDI 0403E, chapters A5 to A7. An instruction
//! that sets the stack pointer to something that its bytes do not show is [`Effect::UnknownStack`], so that a
//! gap in what is decoded is an error and not a stack that is reported too small.
//!
//! Our own, because yaxpeax-arm 0.5 decodes no floating-point instruction: 44 % of the image for QEMU, `vpush` included.
//! The compiler's call-frame information (`.debug_frame`) gives no frame size: a function that has a frame pointer, as nearly
//! all here have, counts its frame from that, and what it takes below for its variables is not said.

#[cfg(test)]
mod tests;

use Effect::{
    Branch, BranchRegister, Call, CallRegister, Down, Filler, High, Low, MayBranch, Other, Return,
    Switch, Trap, UnknownStack,
};

/// Instructions that have these bits: a mask, its bits' values, and what such a word does at its address.
type Encoding = (u32, u32, fn(u32, u32) -> Effect);

/// Instructions of one halfword; the first row that fits counts, and what is in none does nothing.
static NARROW: [Encoding; 18] = [
    (0xffff, 0xbf00, |_, _| Filler), // `nop`
    (0xffff, 0x0000, |_, _| Filler), // `movs r0, r0`, as a filler
    // `add` and `mov` of any registers.
    (0xff87, 0x4485, |_, _| UnknownStack),   // `add sp, rm`
    (0xff87, 0x4487, |_, _| BranchRegister), // `add pc, rm`
    (0xff87, 0x4685, |_, _| UnknownStack),   // `mov sp, rm`
    (0xffff, 0x46f7, |_, _| Return),         // `mov pc, lr`
    (0xff87, 0x4687, |_, _| BranchRegister), // `mov pc, rm`
    // `blx`, `bx lr`, `bx`.
    (0xff80, 0x4780, |_, _| CallRegister),   // `blx rm`
    (0xfff8, 0x4770, |_, _| Return),         // `bx lr`
    (0xff80, 0x4700, |_, _| BranchRegister), // `bx rm`
    // `sub sp`, `push`, `pop` with the program counter.
    (0xff80, 0xb080, |word, _| Down(bits(word, 0, 7) * 4)), // `sub sp, #n`
    (0xfe00, 0xb400, |word, _| Down(ones(word, 9) * 4)),    // `push`
    (0xff00, 0xbd00, |_, _| Return),                        // `pop {…, pc}`
    (0xf500, 0xb100, compare_and_branch),                   // `cbz`, `cbnz`
    // `udf`, `svc`, which share their first bits with the conditional branch.
    (0xff00, 0xde00, |_, _| Trap),  // `udf`
    (0xff00, 0xdf00, |_, _| Other), // `svc`
    (0xf000, 0xd000, |word, address| {
        MayBranch(target(address, bits(word, 0, 8) << 1, 9))
    }), // `b<c>`
    (0xf800, 0xe000, |word, address| {
        Branch(target(address, bits(word, 0, 11) << 1, 12))
    }), // `b`
];

/// Instructions of two halfwords, the first in the upper bits; the first row that fits counts.
static WIDE: [Encoding; 31] = [
    // `ldm` and `stm`: `push.w` and `pop.w` are two of them.
    (0xfe50_2000, 0xe810_2000, |_, _| UnknownStack), // `ldm {…, sp}`
    (0xfeff_8000, 0xe8bd_8000, |_, _| Return),       // `pop.w {…, pc}`
    (0xfe50_8000, 0xe810_8000, |_, _| BranchRegister), // `ldm {…, pc}`
    (0xfeef_0000, 0xe82d_0000, |word, _| Down(ones(word, 16) * 4)), // `push.w`
    // `tbb` and `tbh`; an exclusive access leaves its base as it is; `ldrd` and `strd`.
    (0xfff0_ffe0, 0xe8d0_f000, |_, _| Switch), // `tbb`, `tbh`
    (0xff60_0000, 0xe840_0000, |_, _| Other),  // `ldrex`, `strex`
    (0xfe50_f000, 0xe850_d000, |_, _| UnknownStack), // `ldrd sp, rt2`
    (0xfe50_0f00, 0xe850_0d00, |_, _| UnknownStack), // `ldrd rt, sp`
    (0xfeef_0000, 0xe86d_0000, lower_by_words), // `strd rt, rt2, [sp, #-n]!`
    // `vpush`, `vpop`, `vstm`, `vldm`, `vstr`, `vldr`; the transfers of two registers write no base.
    (0xeeaf_0000, 0xec2d_0000, lower_by_words), // `vpush`
    // Arithmetic on registers: an amount in a register.
    (0xfe00_0f00, 0xea00_0d00, |_, _| UnknownStack), // as `sub.w sp, rn, rm`
    // Arithmetic with a constant: `sub.w`, `subw`, `add.w`, `addw` of the stack pointer, then what else writes it.
    (0xfbef_8f00, 0xf1ad_0d00, |word, _| {
        Down(expand(constant(word)))
    }), // `sub.w sp, sp, #n`
    (0xfbff_8f00, 0xf2ad_0d00, |word, _| Down(constant(word))), // `subw sp, sp, #n`
    (0xfbef_8f00, 0xf10d_0d00, |_, _| Other),                   // `add.w sp, sp, #n`
    (0xfbff_8f00, 0xf20d_0d00, |_, _| Other),                   // `addw sp, sp, #n`
    (0xf800_8f00, 0xf000_0d00, |_, _| UnknownStack),            // as `sub.w sp, rn, #n`
    // `movw` and `movt`.
    (0xfbf0_8000, 0xf240_0000, |word, _| {
        Low(bits(word, 8, 4), half(word))
    }), // `movw`
    (0xfbf0_8000, 0xf2c0_0000, |word, _| {
        High(bits(word, 8, 4), half(word))
    }), // `movt`
    // `bl`, `b.w`, and `blx` to ARM code, which a Cortex-M has not.
    (0xf800_d000, 0xf000_d000, |word, address| {
        Call(target(address, long_offset(word), 25))
    }), // `bl`
    (0xf800_d000, 0xf000_9000, |word, address| {
        Branch(target(address, long_offset(word), 25))
    }), // `b.w`
    (0xf800_d000, 0xf000_c000, |_, _| Trap), // `blx`
    // `msr` to a stack pointer or to the choice between them; `udf.w`; what is left is a hint or a barrier.
    (0xffe0_d0ff, 0xf380_8008, |_, _| UnknownStack), // `msr msp`
    (0xffe0_d0ff, 0xf380_8009, |_, _| UnknownStack), // `msr psp`
    (0xffe0_d0ff, 0xf380_8014, |_, _| UnknownStack), // `msr control`
    (0xfff0_f000, 0xf7f0_a000, |_, _| Trap),         // `udf.w`
    (0xfb80_d000, 0xf380_8000, |_, _| Other),        // `msr`, `mrs`, hints, barriers
    (0xf800_d000, 0xf000_8000, |word, address| {
        MayBranch(target(address, conditional_offset(word), 21))
    }), // `b<c>.w`
    // Loads and stores of one register; `ldr pc, [sp], #n` is `pop {pc}`.
    (0xfe70_f000, 0xf850_d000, |_, _| UnknownStack), // `ldr sp`
    (0xffff_ff00, 0xf85d_fb00, |_, _| Return),       // `ldr pc, [sp], #n`
    (0xfe70_f000, 0xf850_f000, |_, _| BranchRegister), // `ldr pc`
    (0xfe8f_0b00, 0xf80d_0900, |word, _| Down(bits(word, 0, 8))), // `str rt, [sp, #-n]!`
];

fn effect(encodings: &[Encoding], word: u32, address: u32) -> Effect {
    let fits = |&&(mask, value, _): &&Encoding| word & mask == value;
    let row = encodings.iter().find(fits);
    row.map_or(Other, |(_, _, effect)| effect(word, address))
}

/// What an instruction does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Effect {
    /// Nothing that matters here; the stack pointer stays or goes up.
    Other,
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
    /// Sets a register, by its number, to 16 bits.
    Low(u32, u32),
    /// Sets the upper half of a register, by its number, to 16 bits.
    High(u32, u32),
}

impl Effect {
    /// Whether the core need not go on with the next instruction.
    ///
    /// A call may be of a function that does not return, and then no code follows.
    pub(super) const fn may_end(self) -> bool {
        !matches!(
            self,
            Self::Other
                | Self::Filler
                | Self::Down(_)
                | Self::UnknownStack
                | Self::MayBranch(_)
                | Self::Low(..)
                | Self::High(..)
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
            effect: effect(&NARROW, first, address),
        });
    }
    let word = first << 16 | halfword(bytes, 2)?;
    Some(Instruction {
        length: 4,
        effect: effect(&WIDE, word, address),
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

/// How many of the lowest bits are set.
const fn ones(word: u32, count: u32) -> u32 {
    bits(word, 0, count).count_ones()
}

/// A multiple access that moves the stack pointer down by a number of words.
const fn lower_by_words(word: u32, _: u32) -> Effect {
    Down(bits(word, 0, 8) * 4)
}

/// `cbz` and `cbnz` lead forwards only.
const fn compare_and_branch(word: u32, address: u32) -> Effect {
    let offset = bits(word, 9, 1) << 6 | bits(word, 3, 5) << 1;
    MayBranch(address.wrapping_add(4 + offset))
}

/// The constant of twelve bits of an arithmetic instruction.
const fn constant(word: u32) -> u32 {
    bits(word, 26, 1) << 11 | bits(word, 12, 3) << 8 | bits(word, 0, 8)
}

/// The constant of sixteen bits of `movw` and `movt`.
const fn half(word: u32) -> u32 {
    bits(word, 16, 4) << 12 | constant(word)
}

/// A constant of twelve bits that stands for one of 32: a byte repeated, or a byte with its top bit set, rotated.
const fn expand(constant: u32) -> u32 {
    let byte = bits(constant, 0, 8);
    match bits(constant, 8, 4) {
        0 => byte,
        1 => byte << 16 | byte,
        2 => byte << 24 | byte << 8,
        3 => byte << 24 | byte << 16 | byte << 8 | byte,
        _ => (1 << 7 | bits(constant, 0, 7)).rotate_right(bits(constant, 7, 5)),
    }
}

const fn long_offset(word: u32) -> u32 {
    let sign = bits(word, 26, 1);
    let upper = (bits(word, 13, 1) ^ sign ^ 1) << 1 | (bits(word, 11, 1) ^ sign ^ 1);
    sign << 24 | upper << 22 | bits(word, 16, 10) << 12 | bits(word, 0, 11) << 1
}

const fn conditional_offset(word: u32) -> u32 {
    let upper = bits(word, 26, 1) << 2 | bits(word, 11, 1) << 1 | bits(word, 13, 1);
    upper << 18 | bits(word, 16, 6) << 12 | bits(word, 0, 11) << 1
}

/// Where a branch leads whose offset is signed and has `width` bits.
const fn target(address: u32, offset: u32, width: u32) -> u32 {
    let unused = 32 - width;
    let signed = ((offset << unused).cast_signed() >> unused).cast_unsigned();
    // The program counter reads as two halfwords ahead.
    address.wrapping_add(4).wrapping_add(signed)
}
