//! Instructions of two halfwords.

use super::{Effect, PC, SP, bit, bits, target};

pub(super) fn effect(first: u32, second: u32, address: u32) -> Effect {
    match bits(first, 9, 4) {
        0b0100 if bit(first, 6) => dual_or_table(first, second),
        0b0100 => multiple(first, second),
        // Coprocessors 10 and 11 are the floating-point unit.
        0b0110 | 0b1110 => coprocessor_memory(first, second),
        0b0101 => registers(second),
        0b1000..=0b1011 if bit(second, 15) => branch_or_control(first, second, address),
        0b1000..=0b1011 => immediate(first, second),
        0b1100 => single(first, second),
        _ => Effect::None,
    }
}

/// What moving the base register of a memory access by `bytes` does.
const fn write_back(first: u32, up: bool, bytes: u32) -> Effect {
    match (bits(first, 0, 4), up) {
        (SP, false) => Effect::Down(bytes),
        _ => Effect::None,
    }
}

/// `stmia`, `stmdb`, `ldmia`, `ldmdb`: `push.w` and `pop.w` are two of them.
const fn multiple(first: u32, second: u32) -> Effect {
    let (load, write, up) = (bit(first, 4), bit(first, 5), bit(first, 7));
    let of_stack = bits(first, 0, 4) == SP;
    if load && bit(second, SP) {
        return Effect::UnknownStack;
    }
    if load && bit(second, PC) {
        return if of_stack && up && write {
            Effect::Return
        } else {
            Effect::BranchRegister
        };
    }
    if write {
        return write_back(first, up, second.count_ones() * 4);
    }
    Effect::None
}

/// `strd`, `ldrd`, the exclusive accesses, `tbb` and `tbh`.
const fn dual_or_table(first: u32, second: u32) -> Effect {
    if first & 0xfff0 == 0xe8d0 && second & 0xffe0 == 0xf000 {
        return Effect::Switch;
    }
    let (before, up, write) = (bit(first, 8), bit(first, 7), bit(first, 5));
    if !before && !write {
        // An exclusive access leaves its base as it is.
        return Effect::None;
    }
    if bit(first, 4) && (bits(second, 12, 4) == SP || bits(second, 8, 4) == SP) {
        return Effect::UnknownStack;
    }
    if write {
        return write_back(first, up, bits(second, 0, 8) * 4);
    }
    Effect::None
}

/// `vpush`, `vpop`, `vstm`, `vldm`, `vstr`, `vldr`; the transfers of two registers write no base.
const fn coprocessor_memory(first: u32, second: u32) -> Effect {
    if bit(first, 5) {
        return write_back(first, bit(first, 7), bits(second, 0, 8) * 4);
    }
    Effect::None
}

/// Arithmetic on registers: only `add`, `sub` and `mov` may write the stack pointer, by an amount in a register.
const fn registers(second: u32) -> Effect {
    match bits(second, 8, 4) {
        SP => Effect::UnknownStack,
        _ => Effect::None,
    }
}

/// Arithmetic with a constant.
fn immediate(first: u32, second: u32) -> Effect {
    let register = bits(second, 8, 4);
    let constant = bits(first, 10, 1) << 11 | bits(second, 12, 3) << 8 | bits(second, 0, 8);
    let of_stack = register == SP && bits(first, 0, 4) == SP;
    let half = bits(first, 0, 4) << 12 | constant;
    match (bit(first, 9), bits(first, 4, 5)) {
        // `sub.w` and `subs.w`, then `subw`.
        (false, 0b11010 | 0b11011) if of_stack => Effect::Down(expand(constant)),
        (true, 0b01010) if of_stack => Effect::Down(constant),
        // `add.w` and `adds.w`, then `addw`.
        (false, 0b10000 | 0b10001) | (true, 0b00000) if of_stack => Effect::None,
        _ if register == SP => Effect::UnknownStack,
        (true, 0b00100) => Effect::Low {
            register,
            value: half,
        },
        (true, 0b01100) => Effect::High {
            register,
            value: half,
        },
        _ => Effect::None,
    }
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

/// Branches, and what touches special registers.
const fn branch_or_control(first: u32, second: u32, address: u32) -> Effect {
    match (bit(second, 14), bit(second, 12)) {
        (true, true) => Effect::Call(target(address, long_offset(first, second), 25)),
        (false, true) => Effect::Branch(target(address, long_offset(first, second), 25)),
        // `blx` to ARM code, which a Cortex-M has not.
        (true, false) => Effect::Trap,
        (false, false) if bits(first, 7, 3) == 0b111 => control(first, second),
        (false, false) => Effect::MayBranch(target(address, conditional_offset(first, second), 21)),
    }
}

const fn long_offset(first: u32, second: u32) -> u32 {
    let sign = bits(first, 10, 1);
    let upper = (bits(second, 13, 1) ^ sign ^ 1) << 1 | (bits(second, 11, 1) ^ sign ^ 1);
    sign << 24 | upper << 22 | bits(first, 0, 10) << 12 | bits(second, 0, 11) << 1
}

const fn conditional_offset(first: u32, second: u32) -> u32 {
    let upper = bits(first, 10, 1) << 2 | bits(second, 11, 1) << 1 | bits(second, 13, 1);
    upper << 18 | bits(first, 0, 6) << 12 | bits(second, 0, 11) << 1
}

/// `msr` to a stack pointer or to the choice between them; `udf.w`; what is left is a hint or a barrier.
const fn control(first: u32, second: u32) -> Effect {
    if first & 0xffe0 == 0xf380 && matches!(bits(second, 0, 8), 8 | 9 | 20) {
        return Effect::UnknownStack;
    }
    if first & 0xfff0 == 0xf7f0 && bits(second, 12, 4) == 0b1010 {
        return Effect::Trap;
    }
    Effect::None
}

/// Loads and stores of one register.
const fn single(first: u32, second: u32) -> Effect {
    let word = bit(first, 4) && bits(first, 5, 2) == 0b10;
    let register = bits(second, 12, 4);
    if word && register == SP {
        return Effect::UnknownStack;
    }
    if word && register == PC {
        // `ldr pc, [sp], #n` is `pop {pc}`.
        let popped = first == 0xf85d && bits(second, 8, 4) == 0b1011;
        return if popped {
            Effect::Return
        } else {
            Effect::BranchRegister
        };
    }
    let written = !bit(first, 7) && bit(second, 11) && bit(second, 8);
    if written {
        return write_back(first, bit(second, 9), bits(second, 0, 8));
    }
    Effect::None
}
