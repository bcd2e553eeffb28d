#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::Effect::{
    self, Branch, BranchRegister, Call, CallRegister, Down, High, Low, MayBranch, Return, Switch,
    Trap, UnknownStack,
};
use super::{Instruction, decode};

/// Where the instructions of these tests lie.
const HERE: u32 = 0x0800_1000;

/// Halfwords of an instruction, and what it is in assembly.
type Case = (&'static [u16], &'static str);

/// The effect of one whole instruction.
fn effect(halfwords: &[u16]) -> Effect {
    let bytes: Vec<u8> = halfwords
        .iter()
        .flat_map(|half| half.to_le_bytes())
        .collect();
    let Instruction { length, effect } = decode(&bytes, HERE).unwrap();
    assert_eq!(length as usize, bytes.len(), "{halfwords:04x?}");
    effect
}

fn assert_effect(wanted: Effect, cases: &[Case]) {
    for (halfwords, text) in cases {
        assert_eq!(effect(halfwords), wanted, "{text}");
    }
}

#[test]
fn stack_is_taken() {
    let cases: [(&[u16], u32, &str); 16] = [
        (&[0xb084], 16, "sub sp, #16"),
        (&[0xb0ff], 508, "sub sp, #508"),
        (&[0xb5f0], 20, "push {r4-r7, lr}"),
        (&[0xb480], 4, "push {r7}"),
        (&[0xe92d, 0x4ff0], 36, "push.w {r4-r11, lr}"),
        (&[0xe92d, 0x0b00], 12, "push.w {r8, r9, r11}"),
        (&[0xf84d, 0xbd04], 4, "str r11, [sp, #-4]!"),
        (&[0xe96d, 0x0102], 8, "strd r0, r1, [sp, #-8]!"),
        (&[0xed2d, 0x8b04], 16, "vpush {d8-d9}"),
        (&[0xed2d, 0x8b10], 64, "vpush {d8-d15}"),
        (&[0xed2d, 0x8a03], 12, "vpush {s16-s18}"),
        (&[0xf5ad, 0x6d80], 1024, "sub.w sp, sp, #1024"),
        (&[0xf5ad, 0x5d28], 10752, "sub.w sp, sp, #10752"),
        (&[0xf1ad, 0x0d0c], 12, "sub.w sp, sp, #12"),
        (&[0xf2ad, 0x4d34], 1076, "subw sp, sp, #1076"),
        (&[0xf6ad, 0x7dff], 4095, "subw sp, sp, #4095"),
    ];
    for (halfwords, bytes, text) in cases {
        assert_eq!(effect(halfwords), Down(bytes), "{text}");
    }
}

#[test]
fn no_stack_is_taken() {
    let cases: [Case; 17] = [
        (&[0xb004], "add sp, #16"),
        (&[0xf50d, 0x6d80], "add.w sp, sp, #1024"),
        (&[0xf20d, 0x4d34], "addw sp, sp, #1076"),
        (&[0xecbd, 0x8b04], "vpop {d8-d9}"),
        (&[0xe8bd, 0x0ff0], "pop.w {r4-r11}"),
        (&[0xbcf0], "pop {r4-r7}"),
        (&[0xf85d, 0xbb04], "ldr r11, [sp], #4"),
        (&[0xaf03], "add r7, sp, #12"),
        (&[0x466f], "mov r7, sp"),
        (&[0xed8d, 0x8b04], "vstr d8, [sp, #16]"),
        (&[0xe9cd, 0x0102], "strd r0, r1, [sp, #8]"),
        (&[0xe88d, 0x000f], "stm.w sp, {r0-r3}"),
        (&[0xc004], "stm r0!, {r2}"),
        (&[0xe920, 0x0006], "stmdb r0!, {r1, r2}"),
        (&[0xec41, 0x0b18], "vmov d8, r0, r1"),
        (&[0xe85d, 0x0f00], "ldrex r0, [sp]"),
        (&[0xf3bf, 0x8f4f], "dsb sy"),
    ];
    assert_effect(Effect::None, &cases);
}

#[test]
fn an_unknown_stack_is_reported() {
    let cases: [Case; 10] = [
        (&[0x46a5], "mov sp, r4"),
        (&[0x4485], "add sp, r0"),
        (&[0xebad, 0x0d00], "sub.w sp, sp, r0"),
        (&[0xf1a7, 0x0d08], "sub.w sp, r7, #8"),
        (&[0xf06f, 0x0d00], "mvn sp, #0"),
        (&[0xf240, 0x0d00], "movw sp, #0"),
        (&[0xf380, 0x8808], "msr msp, r0"),
        (&[0xf380, 0x8814], "msr control, r0"),
        (&[0xf8d0, 0xd000], "ldr.w sp, [r0]"),
        (&[0xe9d0, 0xd100], "ldrd sp, r1, [r0]"),
    ];
    assert_effect(UnknownStack, &cases);
}

#[test]
fn branches_have_targets() {
    let far = HERE.wrapping_sub(93_242);
    let cases: [(&[u16], Effect, &str); 12] = [
        (&[0xf000, 0xf80d], Call(HERE + 4 + 26), "bl forwards"),
        (&[0xf7e9, 0xf9e3], Call(far + 4), "bl backwards"),
        (&[0xf00a, 0xfa4e], Call(HERE + 4 + 42_140), "bl far"),
        (&[0xf000, 0xb804], Branch(HERE + 4 + 8), "b.w forwards"),
        (&[0xf7ff, 0xbffe], Branch(HERE), "b.w to itself"),
        (&[0xe7fe], Branch(HERE), "b to itself"),
        (&[0xe006], Branch(HERE + 4 + 12), "b forwards"),
        (&[0xd001], MayBranch(HERE + 4 + 2), "beq forwards"),
        (&[0xd1fa], MayBranch(HERE + 4 - 12), "bne backwards"),
        (
            &[0xf000, 0x80fc],
            MayBranch(HERE + 4 + 504),
            "beq.w forwards",
        ),
        (&[0xf43f, 0xaffe], MayBranch(HERE), "beq.w to itself"),
        (&[0xb108], MayBranch(HERE + 4 + 2), "cbz r0, forwards"),
    ];
    for (halfwords, wanted, text) in cases {
        assert_eq!(effect(halfwords), wanted, "{text}");
    }
}

#[test]
fn branches_by_register_and_ends() {
    let cases: [(&[u16], Effect, &str); 14] = [
        (&[0x4798], CallRegister, "blx r3"),
        (&[0x47c8], CallRegister, "blx r9"),
        (&[0x4718], BranchRegister, "bx r3"),
        (&[0x4760], BranchRegister, "bx r12"),
        (&[0x469f], BranchRegister, "mov pc, r3"),
        (&[0xf8d0, 0xf000], BranchRegister, "ldr.w pc, [r0]"),
        (&[0x4770], Return, "bx lr"),
        (&[0x46f7], Return, "mov pc, lr"),
        (&[0xbd80], Return, "pop {r7, pc}"),
        (&[0xe8bd, 0x8ff0], Return, "pop.w {r4-r11, pc}"),
        (&[0xf85d, 0xfb04], Return, "ldr pc, [sp], #4"),
        (&[0xe8df, 0xf002], Switch, "tbb [pc, r2]"),
        (&[0xe8df, 0xf011], Switch, "tbh [pc, r1, lsl #1]"),
        (&[0xde00], Trap, "udf #0"),
    ];
    for (halfwords, wanted, text) in cases {
        assert_eq!(effect(halfwords), wanted, "{text}");
    }
}

#[test]
fn halves_of_an_address_are_read() {
    let (register, low, high) = (3, 0x5679, 0x0801);
    let movw = effect(&[0xf245, 0x6379]);
    assert_eq!(
        movw,
        Low {
            register,
            value: low
        }
    );
    let movt = effect(&[0xf6c0, 0x0301]);
    assert_eq!(
        movt,
        High {
            register,
            value: high
        }
    );
}

#[test]
fn an_instruction_that_is_cut_off_is_none() {
    // Half a halfword, and the first half of `bl`.
    for bytes in [&[0x00_u8] as &[u8], &[0x00, 0xf0]] {
        assert_eq!(decode(bytes, HERE), None);
    }
}
