//! The work-around of the core's fault, on a program of a few instructions.

#![allow(clippy::unwrap_used)]

use super::*;

/// Sixteen bytes of instructions each: start, and the handler of the first interrupt.
const START: u32 = FLASH.start + 0x80;
const HANDLER: u32 = START + 0x40;

/// Sets r3 and r5, and neither r4 nor r6, in one IT block.
const PROGRAM: [u16; 7] = [
    0x2000, // movs r0, #0
    0xbf0b, // itete eq
    0x2301, // moveq r3, #1
    0x2401, // movne r4, #1
    0x2501, // moveq r5, #1
    0x2601, // movne r6, #1
    0xe7fe, // b .
];

const RETURN: u16 = 0x4770; // bx lr

/// What r3 to r6 are in the end.
const RIGHT: [u32; 4] = [1, 0, 1, 0];

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
fn started() -> Processor {
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
    for (address, instruction) in (START..).step_by(2).zip(PROGRAM) {
        put(address, &instruction.to_le_bytes());
    }
    put(HANDLER, &RETURN.to_le_bytes());
    let nothing = || Arc::new(Nothing);
    let processor = Processor::new(&flash, nothing(), nothing(), nothing()).unwrap();
    for register in 0..8 {
        processor.core.set_reg(register, 0);
    }
    let interrupt = Exception(FIRST_INTERRUPT);
    processor
        .core
        .with_sys(|system| system.set_enable(interrupt, true));
    processor
}

/// Runs the program with an interrupt before one of its instructions, raised and lowered as it is told: r3 to r6.
fn interrupted_before(instruction: u32, raise: impl Fn(&mut Processor, bool)) -> [u32; 4] {
    let mut processor = started();
    let mut handled = 0;
    let mut raised = false;
    for _ in 0..40 {
        if processor.pc() == START + 2 * instruction && !raised && handled == 0 {
            raised = true;
            raise(&mut processor, true);
        }
        if processor.pc() == HANDLER {
            handled += 1;
            raise(&mut processor, false);
        }
        processor.step();
    }
    assert_eq!(handled, 1, "before instruction {instruction}");
    [3, 4, 5, 6].map(|register| processor.core.reg(register))
}

#[test]
fn an_interrupt_within_an_it_block() {
    for instruction in 0..PROGRAM.len() as u32 {
        let found = interrupted_before(instruction, |processor, level| {
            processor.set_line(0, level);
        });
        assert_eq!(found, RIGHT, "before instruction {instruction}");
    }
}

/// Once this fails, `rsemu` keeps what an IT block has still to do: [`Processor::settle`] may then hand lines on at once.
#[test]
fn the_core_alone_still_forgets_the_it_block() {
    let found = interrupted_before(3, |processor, level| processor.core.set_irq(0, level));
    assert_ne!(
        found, RIGHT,
        "rsemu was mended: the work-around in `Processor::settle` can go"
    );
}
