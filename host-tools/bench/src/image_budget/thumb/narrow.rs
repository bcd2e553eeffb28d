//! Instructions of one halfword.

use super::{Effect, LR, PC, SP, bit, bits, target};

pub(super) fn effect(word: u32, address: u32) -> Effect {
    match word >> 8 {
        // `nop`, and a halfword of zeros.
        _ if matches!(word, 0xbf00 | 0x0000) => Effect::Filler,
        0x44 => add_registers(word),
        0x46 => move_register(word),
        0x47 => exchange(word),
        0xb0 if bit(word, 7) => Effect::Down(bits(word, 0, 7) * 4),
        0xb4 | 0xb5 => Effect::Down(bits(word, 0, 9).count_ones() * 4),
        0xbd => Effect::Return,
        0xb1 | 0xb3 | 0xb9 | 0xbb => Effect::MayBranch(compare_target(word, address)),
        0xd0..=0xdd => Effect::MayBranch(target(address, bits(word, 0, 8) << 1, 9)),
        0xde => Effect::Trap,
        0xe0..=0xe7 => Effect::Branch(target(address, bits(word, 0, 11) << 1, 12)),
        _ => Effect::None,
    }
}

/// The register that `add`, `mov` and `cmp` of any registers write.
const fn destination(word: u32) -> u32 {
    bits(word, 7, 1) << 3 | bits(word, 0, 3)
}

const fn add_registers(word: u32) -> Effect {
    match destination(word) {
        SP => Effect::UnknownStack,
        PC => Effect::BranchRegister,
        _ => Effect::None,
    }
}

const fn move_register(word: u32) -> Effect {
    match (destination(word), bits(word, 3, 4)) {
        (SP, _) => Effect::UnknownStack,
        (PC, LR) => Effect::Return,
        (PC, _) => Effect::BranchRegister,
        _ => Effect::None,
    }
}

/// `bx` and `blx`.
const fn exchange(word: u32) -> Effect {
    match (bit(word, 7), bits(word, 3, 4)) {
        (true, _) => Effect::CallRegister,
        (false, LR) => Effect::Return,
        (false, _) => Effect::BranchRegister,
    }
}

/// `cbz` and `cbnz` lead forwards only.
const fn compare_target(word: u32, address: u32) -> u32 {
    let offset = bits(word, 9, 1) << 6 | bits(word, 3, 5) << 1;
    address.wrapping_add(4 + offset)
}
