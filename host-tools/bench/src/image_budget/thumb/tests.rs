#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{Effect, Instruction, decode};

/// Where the instructions of these tests lie.
const HERE: u32 = 0x0800_1000;

/// What two or four bytes do, which must be one whole instruction.
fn effect(bytes: &[u8]) -> Effect {
    let Instruction { length, effect } = decode(bytes, HERE).unwrap();
    assert_eq!(length as usize, bytes.len(), "{bytes:02x?}");
    effect
}

#[test]
fn what_takes_stack() {
    let cases: [(&[u8], u32, &str); 16] = [
        (&[0x84, 0xb0], 16, "sub sp, #16"),
        (&[0xff, 0xb0], 508, "sub sp, #508"),
        (&[0xf0, 0xb5], 20, "push {r4-r7, lr}"),
        (&[0x80, 0xb4], 4, "push {r7}"),
        (&[0x2d, 0xe9, 0xf0, 0x4f], 36, "push.w {r4-r11, lr}"),
        (&[0x2d, 0xe9, 0x00, 0x0b], 12, "push.w {r8, r9, r11}"),
        (&[0x4d, 0xf8, 0x04, 0xbd], 4, "str r11, [sp, #-4]!"),
        (&[0x6d, 0xe9, 0x02, 0x01], 8, "strd r0, r1, [sp, #-8]!"),
        (&[0x2d, 0xed, 0x04, 0x8b], 16, "vpush {d8-d9}"),
        (&[0x2d, 0xed, 0x10, 0x8b], 64, "vpush {d8-d15}"),
        (&[0x2d, 0xed, 0x03, 0x8a], 12, "vpush {s16-s18}"),
        (&[0xad, 0xf5, 0x80, 0x6d], 1024, "sub.w sp, sp, #1024"),
        (&[0xad, 0xf5, 0x28, 0x5d], 10752, "sub.w sp, sp, #10752"),
        (&[0xad, 0xf1, 0x0c, 0x0d], 12, "sub.w sp, sp, #12"),
        (&[0xad, 0xf2, 0x34, 0x4d], 1076, "subw sp, sp, #1076"),
        (&[0xad, 0xf6, 0xff, 0x7d], 4095, "subw sp, sp, #4095"),
    ];
    for (bytes, down, text) in cases {
        assert_eq!(effect(bytes), Effect::Down(down), "{text}");
    }
}

#[test]
fn what_takes_no_stack() {
    let cases: [(&[u8], &str); 17] = [
        (&[0x04, 0xb0], "add sp, #16"),
        (&[0x0d, 0xf5, 0x80, 0x6d], "add.w sp, sp, #1024"),
        (&[0x0d, 0xf2, 0x34, 0x4d], "addw sp, sp, #1076"),
        (&[0xbd, 0xec, 0x04, 0x8b], "vpop {d8-d9}"),
        (&[0xbd, 0xe8, 0xf0, 0x0f], "pop.w {r4-r11}"),
        (&[0xf0, 0xbc], "pop {r4-r7}"),
        (&[0x5d, 0xf8, 0x04, 0xbb], "ldr r11, [sp], #4"),
        (&[0x03, 0xaf], "add r7, sp, #12"),
        (&[0x6f, 0x46], "mov r7, sp"),
        (&[0x8d, 0xed, 0x04, 0x8b], "vstr d8, [sp, #16]"),
        (&[0xcd, 0xe9, 0x02, 0x01], "strd r0, r1, [sp, #8]"),
        (&[0x8d, 0xe8, 0x0f, 0x00], "stm.w sp, {r0-r3}"),
        (&[0x04, 0xc0], "stm r0!, {r2}"),
        (&[0x20, 0xe9, 0x06, 0x00], "stmdb r0!, {r1, r2}"),
        (&[0x41, 0xec, 0x18, 0x0b], "vmov d8, r0, r1"),
        (&[0x5d, 0xe8, 0x00, 0x0f], "ldrex r0, [sp]"),
        (&[0xbf, 0xf3, 0x4f, 0x8f], "dsb sy"),
    ];
    for (bytes, text) in cases {
        assert_eq!(effect(bytes), Effect::None, "{text}");
    }
}

#[test]
fn what_cannot_be_told_is_said_so() {
    let cases: [(&[u8], &str); 10] = [
        (&[0xa5, 0x46], "mov sp, r4"),
        (&[0x85, 0x44], "add sp, r0"),
        (&[0xad, 0xeb, 0x00, 0x0d], "sub.w sp, sp, r0"),
        (&[0xa7, 0xf1, 0x08, 0x0d], "sub.w sp, r7, #8"),
        (&[0x6f, 0xf0, 0x00, 0x0d], "mvn sp, #0"),
        (&[0x40, 0xf2, 0x00, 0x0d], "movw sp, #0"),
        (&[0x80, 0xf3, 0x08, 0x88], "msr msp, r0"),
        (&[0x80, 0xf3, 0x14, 0x88], "msr control, r0"),
        (&[0xd0, 0xf8, 0x00, 0xd0], "ldr.w sp, [r0]"),
        (&[0xd0, 0xe9, 0x00, 0xd1], "ldrd sp, r1, [r0]"),
    ];
    for (bytes, text) in cases {
        assert_eq!(effect(bytes), Effect::UnknownStack, "{text}");
    }
}

#[test]
fn where_branches_lead() {
    let far = HERE.wrapping_sub(93_242);
    let cases: [(&[u8], Effect, &str); 12] = [
        (
            &[0x00, 0xf0, 0x0d, 0xf8],
            Effect::Call(HERE + 4 + 26),
            "bl forwards",
        ),
        (
            &[0xe9, 0xf7, 0xe3, 0xf9],
            Effect::Call(far + 4),
            "bl backwards",
        ),
        (
            &[0x0a, 0xf0, 0x4e, 0xfa],
            Effect::Call(HERE + 4 + 42_140),
            "bl far",
        ),
        (
            &[0x00, 0xf0, 0x04, 0xb8],
            Effect::Branch(HERE + 4 + 8),
            "b.w forwards",
        ),
        (
            &[0xff, 0xf7, 0xfe, 0xbf],
            Effect::Branch(HERE),
            "b.w to itself",
        ),
        (&[0xfe, 0xe7], Effect::Branch(HERE), "b to itself"),
        (&[0x06, 0xe0], Effect::Branch(HERE + 4 + 12), "b forwards"),
        (
            &[0x01, 0xd0],
            Effect::MayBranch(HERE + 4 + 2),
            "beq forwards",
        ),
        (
            &[0xfa, 0xd1],
            Effect::MayBranch(HERE + 4 - 12),
            "bne backwards",
        ),
        (
            &[0x00, 0xf0, 0xfc, 0x80],
            Effect::MayBranch(HERE + 4 + 504),
            "beq.w forwards",
        ),
        (
            &[0x3f, 0xf4, 0xfe, 0xaf],
            Effect::MayBranch(HERE),
            "beq.w to itself",
        ),
        (
            &[0x08, 0xb1],
            Effect::MayBranch(HERE + 4 + 2),
            "cbz r0, forwards",
        ),
    ];
    for (bytes, wanted, text) in cases {
        assert_eq!(effect(bytes), wanted, "{text}");
    }
}

#[test]
fn what_leaves_by_a_register_or_ends() {
    let cases: [(&[u8], Effect, &str); 14] = [
        (&[0x98, 0x47], Effect::CallRegister, "blx r3"),
        (&[0xc8, 0x47], Effect::CallRegister, "blx r9"),
        (&[0x18, 0x47], Effect::BranchRegister, "bx r3"),
        (&[0x60, 0x47], Effect::BranchRegister, "bx r12"),
        (&[0x9f, 0x46], Effect::BranchRegister, "mov pc, r3"),
        (
            &[0xd0, 0xf8, 0x00, 0xf0],
            Effect::BranchRegister,
            "ldr.w pc, [r0]",
        ),
        (&[0x70, 0x47], Effect::Return, "bx lr"),
        (&[0xf7, 0x46], Effect::Return, "mov pc, lr"),
        (&[0x80, 0xbd], Effect::Return, "pop {r7, pc}"),
        (
            &[0xbd, 0xe8, 0xf0, 0x8f],
            Effect::Return,
            "pop.w {r4-r11, pc}",
        ),
        (
            &[0x5d, 0xf8, 0x04, 0xfb],
            Effect::Return,
            "ldr pc, [sp], #4",
        ),
        (&[0xdf, 0xe8, 0x02, 0xf0], Effect::Switch, "tbb [pc, r2]"),
        (
            &[0xdf, 0xe8, 0x11, 0xf0],
            Effect::Switch,
            "tbh [pc, r1, lsl #1]",
        ),
        (&[0x00, 0xde], Effect::Trap, "udf #0"),
    ];
    for (bytes, wanted, text) in cases {
        assert_eq!(effect(bytes), wanted, "{text}");
    }
}

#[test]
fn halves_of_an_address() {
    // movw r3, #0x5679, then movt r3, #0x0801.
    let (register, low, high) = (3, 0x5679, 0x0801);
    let value = low;
    assert_eq!(
        effect(&[0x45, 0xf2, 0x79, 0x63]),
        Effect::Low { register, value }
    );
    let value = high;
    assert_eq!(
        effect(&[0xc0, 0xf6, 0x01, 0x03]),
        Effect::High { register, value }
    );
}

#[test]
fn an_instruction_that_is_cut_off_is_none() {
    assert_eq!(decode(&[0x00], HERE), None);
    // The first half of `bl`.
    assert_eq!(decode(&[0x00, 0xf0], HERE), None);
}
