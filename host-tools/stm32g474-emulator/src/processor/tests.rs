//! The work-around of the core's faults, on programs of a few instructions.

#![allow(clippy::unwrap_used)]

use super::*;

/// Where the instructions are: of the start, and of the first interrupt's handler.
const START: u32 = FLASH.start + 0x80;
const HANDLER: u32 = START + 0x40;

/// Sets r3 and r5, and neither r4 nor r6, in one IT block.
const BLOCK: &[u16] = &[
    0x2000, // movs r0, #0
    0xbf0b, // itete eq
    0x2301, // moveq r3, #1
    0x2401, // movne r4, #1
    0x2501, // moveq r5, #1
    0x2601, // movne r6, #1
    0xe7fe, // b .
];

/// Sets r3 to 1 where s0 is below s1, else to 2.
const COMPARISON: &[u16] = &[
    0xeeb4, 0x0a60, // vcmp.f32 s0, s1
    0xbf00, // nop
    0xeef1, 0xfa10, // vmrs apsr_nzcv, fpscr
    0xbf4c, // ite mi
    0x2301, // movmi r3, #1
    0x2302, // movpl r3, #2
    0xe7fe, // b .
];

const RETURN: u16 = 0x4770; // bx lr

/// What r3 to r6 are in the end.
const AFTER_BLOCK: [u32; 4] = [1, 0, 1, 0];
const AFTER_COMPARISON: [u32; 4] = [1, 0, 0, 0];

/// The switch of the floating-point unit (CPACR), and both its fields.
const FLOATING_POINT: (u32, u32) = (0xe000_ed88, 0xf << 20);

/// Nothing answers here.
#[derive(Debug)]
struct Nothing;

impl MemOps for Nothing {
    fn read(&self, _: u64, _: &mut [u8], _: MemAttrs) -> rsemu::core::space::MemResult {
        Err(rsemu::core::error::BusError::Unassigned)
    }

    fn write(&self, _: u64, _: &[u8], _: MemAttrs) -> rsemu::core::space::MemResult {
        Err(rsemu::core::error::BusError::Unassigned)
    }
}

/// A processor at the start of the program, with its first interrupt enabled.
fn started(program: &[u16]) -> Processor {
    let mut flash = vec![0xff; FLASH.len()];
    let mut put = |address: u32, bytes: &[u8]| {
        let at = (address - FLASH.start) as usize;
        flash[at..at + bytes.len()].copy_from_slice(bytes);
    };
    let vector = FLASH.start + 4 * u32::from(FIRST_INTERRUPT);
    for (address, word) in [
        (FLASH.start, RAM.start + 0x1000),
        (FLASH.start + 4, START | 1),
        (vector, HANDLER | 1),
    ] {
        put(address, &word.to_le_bytes());
    }
    for (address, instruction) in (START..).step_by(2).zip(program) {
        put(address, &instruction.to_le_bytes());
    }
    put(HANDLER, &RETURN.to_le_bytes());
    let nothing = || Arc::new(Nothing);
    let processor = Processor::new(&flash, nothing(), nothing(), nothing()).unwrap();
    for register in 0..8 {
        processor.core.set_reg(register, 0);
    }
    let interrupt = Exception(FIRST_INTERRUPT);
    processor.core.with_sys(|system| {
        system.set_enable(interrupt, true);
        system.write_word(FLOATING_POINT.0, FLOATING_POINT.1);
    });
    processor
}

/// Runs a program with an interrupt at one of its half words, raised and lowered as it is told: r3 to r6.
fn interrupted_at(
    program: &[u16],
    half_word: u32,
    raise: impl Fn(&mut Processor, bool),
) -> [u32; 4] {
    let mut processor = started(program);
    let mut handled = 0;
    let mut raised = false;
    for _ in 0..40 {
        if processor.pc() == START {
            processor.core.set_s(0, 1_f32.to_bits());
            processor.core.set_s(1, 2_f32.to_bits());
        }
        if processor.pc() == START + 2 * half_word && !raised && handled == 0 {
            raised = true;
            raise(&mut processor, true);
        }
        if processor.pc() == HANDLER {
            handled += 1;
            raise(&mut processor, false);
        }
        processor.step();
    }
    assert_eq!(handled, 1, "at {half_word}");
    [3, 4, 5, 6].map(|register| processor.core.reg(register))
}

/// Instructions by their first half words.
const BLOCK_STARTS: [u32; 7] = [0, 1, 2, 3, 4, 5, 6];
const COMPARISON_STARTS: [u32; 6] = [0, 2, 3, 5, 6, 8];

#[test]
fn an_interrupt_within_an_it_block_or_a_comparison_changes_nothing() {
    let cases = [
        (BLOCK, &BLOCK_STARTS[..], AFTER_BLOCK),
        (COMPARISON, &COMPARISON_STARTS, AFTER_COMPARISON),
    ];
    for (program, starts, right) in cases {
        for &start in starts {
            let found = interrupted_at(program, start, |processor, level| {
                processor.set_lines(u128::from(level));
            });
            assert_eq!(found, right, "at {start}");
        }
    }
}

/// Once this fails, `rsemu` keeps what an IT block has still to do.
#[test]
fn the_core_alone_still_forgets_the_it_block() {
    let found = interrupted_at(BLOCK, 3, |processor, level| {
        processor.core.set_irq(0, level)
    });
    assert_ne!(
        found, AFTER_BLOCK,
        "rsemu was mended: `Processor::settle` need not look at IT blocks"
    );
}

/// Once this fails, `rsemu` keeps the flags of the interrupted program's comparison.
#[test]
fn the_core_alone_still_forgets_the_flags_of_a_comparison() {
    let found = interrupted_at(COMPARISON, 3, |processor, level| {
        processor.core.set_irq(0, level);
    });
    assert_ne!(
        found, AFTER_COMPARISON,
        "rsemu was mended: `Processor::settle` need not look at comparisons"
    );
}

#[test]
fn every_seed_leaves_another_ram() {
    let ram = |seed| {
        let mut processor = started(BLOCK);
        processor.scramble_ram(seed);
        [RAM.start, CCM.start, RAM.end - 4].map(|address| processor.word(address).unwrap())
    };
    let all = [0, 1, 2, 3].map(ram);
    for (seed, words) in all.iter().enumerate() {
        assert_eq!(ram(seed as u64), *words);
        assert!(all.iter().skip(seed + 1).all(|other| other != words));
    }
}
