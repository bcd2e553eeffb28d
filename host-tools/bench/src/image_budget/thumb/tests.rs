#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::Effect::{
    self, Branch, BranchRegister, Call, CallRegister, Down, High, Low, MayBranch, Other, Return,
    Switch, Trap, UnknownStack,
};
use super::decode;

/// Where the instructions of these tests lie.
const HERE: u32 = 0x0800_1000;

const FAR: u32 = HERE - 93_242;

/// An instruction, its first halfword in the upper bits if it has two; what it does, and what it is in assembly.
const CASES: &[(u32, Effect, &str)] = &[
    (0xb084, Down(16), "sub sp, #16"),
    (0xb0ff, Down(508), "sub sp, #508"),
    (0xb5f0, Down(20), "push {r4-r7, lr}"),
    (0xb480, Down(4), "push {r7}"),
    (0xe92d_4ff0, Down(36), "push.w {r4-r11, lr}"),
    (0xe92d_0b00, Down(12), "push.w {r8, r9, r11}"),
    (0xf84d_bd04, Down(4), "str r11, [sp, #-4]!"),
    (0xe96d_0102, Down(8), "strd r0, r1, [sp, #-8]!"),
    (0xed2d_8b04, Down(16), "vpush {d8-d9}"),
    (0xed2d_8b10, Down(64), "vpush {d8-d15}"),
    (0xed2d_8a03, Down(12), "vpush {s16-s18}"),
    (0xf5ad_6d80, Down(1024), "sub.w sp, sp, #1024"),
    (0xf5ad_5d28, Down(10752), "sub.w sp, sp, #10752"),
    (0xf1ad_0d0c, Down(12), "sub.w sp, sp, #12"),
    (0xf2ad_4d34, Down(1076), "subw sp, sp, #1076"),
    (0xf6ad_7dff, Down(4095), "subw sp, sp, #4095"),
    (0xb004, Other, "add sp, #16"),
    (0xf50d_6d80, Other, "add.w sp, sp, #1024"),
    (0xf20d_4d34, Other, "addw sp, sp, #1076"),
    (0xecbd_8b04, Other, "vpop {d8-d9}"),
    (0xe8bd_0ff0, Other, "pop.w {r4-r11}"),
    (0xbcf0, Other, "pop {r4-r7}"),
    (0xf85d_bb04, Other, "ldr r11, [sp], #4"),
    (0xaf03, Other, "add r7, sp, #12"),
    (0x466f, Other, "mov r7, sp"),
    (0xed8d_8b04, Other, "vstr d8, [sp, #16]"),
    (0xe9cd_0102, Other, "strd r0, r1, [sp, #8]"),
    (0xe88d_000f, Other, "stm.w sp, {r0-r3}"),
    (0xc004, Other, "stm r0!, {r2}"),
    (0xe920_0006, Other, "stmdb r0!, {r1, r2}"),
    (0xec41_0b18, Other, "vmov d8, r0, r1"),
    (0xe85d_0f00, Other, "ldrex r0, [sp]"),
    (0xf3bf_8f4f, Other, "dsb sy"),
    (0x46a5, UnknownStack, "mov sp, r4"),
    (0x4485, UnknownStack, "add sp, r0"),
    (0xebad_0d00, UnknownStack, "sub.w sp, sp, r0"),
    (0xf1a7_0d08, UnknownStack, "sub.w sp, r7, #8"),
    (0xf06f_0d00, UnknownStack, "mvn sp, #0"),
    (0xf240_0d00, UnknownStack, "movw sp, #0"),
    (0xf380_8808, UnknownStack, "msr msp, r0"),
    (0xf380_8814, UnknownStack, "msr control, r0"),
    (0xf8d0_d000, UnknownStack, "ldr.w sp, [r0]"),
    (0xe9d0_d100, UnknownStack, "ldrd sp, r1, [r0]"),
    (0xf000_f80d, Call(HERE + 4 + 26), "bl forwards"),
    (0xf7e9_f9e3, Call(FAR + 4), "bl backwards"),
    (0xf00a_fa4e, Call(HERE + 4 + 42_140), "bl far"),
    (0xf000_b804, Branch(HERE + 4 + 8), "b.w forwards"),
    (0xf7ff_bffe, Branch(HERE), "b.w to itself"),
    (0xe7fe, Branch(HERE), "b to itself"),
    (0xe006, Branch(HERE + 4 + 12), "b forwards"),
    (0xd001, MayBranch(HERE + 4 + 2), "beq forwards"),
    (0xd1fa, MayBranch(HERE + 4 - 12), "bne backwards"),
    (0xf000_80fc, MayBranch(HERE + 4 + 504), "beq.w forwards"),
    (0xf43f_affe, MayBranch(HERE), "beq.w to itself"),
    (0xb108, MayBranch(HERE + 4 + 2), "cbz r0, forwards"),
    (0x4798, CallRegister, "blx r3"),
    (0x47c8, CallRegister, "blx r9"),
    (0x4718, BranchRegister, "bx r3"),
    (0x4760, BranchRegister, "bx r12"),
    (0x469f, BranchRegister, "mov pc, r3"),
    (0xf8d0_f000, BranchRegister, "ldr.w pc, [r0]"),
    (0x4770, Return, "bx lr"),
    (0x46f7, Return, "mov pc, lr"),
    (0xbd80, Return, "pop {r7, pc}"),
    (0xe8bd_8ff0, Return, "pop.w {r4-r11, pc}"),
    (0xf85d_fb04, Return, "ldr pc, [sp], #4"),
    (0xe8df_f002, Switch, "tbb [pc, r2]"),
    (0xe8df_f011, Switch, "tbh [pc, r1, lsl #1]"),
    (0xde00, Trap, "udf #0"),
    (0xf245_6379, Low(3, 0x5679), "movw r3, #0x5679"),
    (0xf6c0_0301, High(3, 0x0801), "movt r3, #0x0801"),
];

#[test]
fn decoded_instructions_have_the_effects_of_the_manual() {
    let mut mismatches = Vec::new();
    for &(word, wanted, text) in CASES {
        let [low, high] = [word as u16, (word >> 16) as u16].map(u16::to_le_bytes);
        let bytes = if word > 0xffff {
            [high, low].concat()
        } else {
            low.to_vec()
        };
        let found = decode(&bytes, HERE).map(|found| (found.length as usize, found.effect));
        if found != Some((bytes.len(), wanted)) {
            mismatches.push((text, found));
        }
    }
    assert!(mismatches.is_empty(), "{mismatches:#?}");
}

#[test]
fn an_instruction_that_is_cut_off_is_none() {
    // Half a halfword, and the first half of `bl`.
    for bytes in [&[0x00_u8] as &[u8], &[0x00, 0xf0]] {
        assert_eq!(decode(bytes, HERE), None);
    }
}
