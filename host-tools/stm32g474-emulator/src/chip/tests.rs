//! Processor and peripherals together, on programs of a few instructions.

use super::*;
use crate::device::FieldPlace;
use crate::memory_map::{CCM, RAM, SECOND_BANK};

/// Start, and the handler of the interrupt that cannot be masked.
const START: u32 = FLASH.start + 0x80;
const HANDLER: u32 = START + 0x40;

/// The vector of that interrupt.
const NMI: u32 = FLASH.start + 8;

/// Where the handler counts.
const COUNT: u32 = RAM.start;

const STAY: u16 = 0xe7fe; // b .
const UNDEFINED: u16 = 0xde00; // udf

/// Adds one to the count.
const COUNTING: [u16; 8] = [
    0x4802, // ldr r0, [pc, #8]
    0x6801, // ldr r1, [r0]
    0x3101, // adds r1, #1
    0x6001, // str r1, [r0]
    0x4770, // bx lr
    0xbf00, // nop
    (COUNT & 0xffff) as u16,
    (COUNT >> 16) as u16,
];

/// A chip whose program is one instruction.
fn chip(instruction: u16) -> Chip {
    let mut flash = vec![0xff; FLASH.len()];
    let mut put = |address: u32, bytes: &[u8]| {
        let at = (address - FLASH.start) as usize;
        flash[at..at + bytes.len()].copy_from_slice(bytes);
    };
    for (address, word) in [
        (FLASH.start, RAM.start + 0x1000),
        (FLASH.start + 4, START | 1),
        (NMI, HANDLER | 1),
    ] {
        put(address, &word.to_le_bytes());
    }
    put(START, &instruction.to_le_bytes());
    for (address, instruction) in (HANDLER..).step_by(2).zip(COUNTING) {
        put(address, &instruction.to_le_bytes());
    }
    let mut chip = Chip::new(&Image::unnamed(flash), &Board::default()).unwrap();
    chip.set_word(COUNT, 0);
    chip
}

/// Reads a register, sets a field, writes it: what was there before.
fn set(chip: &Chip, block: &str, register: &str, field: &str, value: u32) -> u32 {
    let block = Facts::chip().block(block).unwrap();
    let register = block.register(register).unwrap();
    let (offset, mask) = (register.offset, register.field(field).unwrap().mask);
    let place = FieldPlace { offset, mask };
    let mut peripherals = chip.peripherals();
    let word = peripherals.read(block.base + offset, 4);
    peripherals.write(block.base + offset, 4, place.insert(word, value));
    place.extract(word)
}

fn run(chip: &mut Chip, cycles: u64) -> Stop {
    chip.run(chip.cycle() + cycles)
}

/// How often the handler has run in some time.
fn handled(chip: &mut Chip) -> u32 {
    let count = |chip: &Chip| chip.processor().word(COUNT).unwrap();
    let before = count(chip);
    run(chip, 1_000);
    count(chip) - before
}

/// The crystal of a chip that watches it, and whose TIM1 listens to breaks, stops.
fn crystal_stopped() -> Chip {
    let mut chip = chip(STAY);
    set(&chip, "RCC", "APB2ENR", "TIM1EN", 1);
    set(&chip, "RCC", "CR", "HSEON", 1);
    set(&chip, "RCC", "CR", "CSSON", 1);
    run(&mut chip, 40_000);
    listen_to_breaks(&chip);
    assert_eq!(handled(&mut chip), 0);
    chip.stop_crystal();
    chip
}

/// TIM1 is switched on, and listens to breaks of the chip.
fn listen_to_breaks(chip: &Chip) {
    // Its other input has no pin, and rests low.
    for field in ["BKP0", "BKE0", "MOE"] {
        set(chip, "TIM1", "BDTR", field, 1);
    }
}

#[test]
fn a_failed_clock_interrupts_until_its_flag_is_cleared() {
    let mut chip = crystal_stopped();
    for _ in 0..2 {
        assert!(handled(&mut chip) > 10);
    }
    set(&chip, "RCC", "CICR", "CSSC", 1);
    handled(&mut chip);
    assert_eq!(handled(&mut chip), 0);
}

#[test]
fn a_failed_clock_breaks_until_its_flag_is_cleared() {
    let mut chip = crystal_stopped();
    // The flag cannot be cleared, nor the outputs switched on, while the clock's flag is set.
    for failed in [1, 1, 0] {
        if failed == 0 {
            set(&chip, "RCC", "CICR", "CSSC", 1);
            run(&mut chip, 100);
        }
        set(&chip, "TIM1", "SR", "SBIF", 0);
        set(&chip, "TIM1", "BDTR", "MOE", 1);
        run(&mut chip, 100);
        assert_eq!(set(&chip, "TIM1", "SR", "SBIF", 0), failed);
        assert_eq!(set(&chip, "TIM1", "BDTR", "MOE", 0), 1 - failed);
    }
}

#[test]
fn wrong_bits_in_the_flash_interrupt_until_their_flag_is_cleared() {
    let mut chip = chip(STAY);
    let mut peripherals = chip.peripherals();
    peripherals.devices.flash.damage(SECOND_BANK);
    peripherals.read_flash(SECOND_BANK, 4);
    drop(peripherals);
    for _ in 0..2 {
        assert!(handled(&mut chip) > 10);
    }
    set(&chip, "FLASH", "ECCR", "ECCD", 1);
    handled(&mut chip);
    assert_eq!(handled(&mut chip), 0);
}

#[test]
fn wrong_bits_in_the_flash_break_where_syscfg_says_so() {
    for listens in [0, 1] {
        let mut chip = chip(STAY);
        set(&chip, "RCC", "APB2ENR", "TIM1EN", 1);
        set(&chip, "RCC", "APB2ENR", "SYSCFGEN", 1);
        set(&chip, "SYSCFG", "CFGR2", "ECCL", listens);
        listen_to_breaks(&chip);
        chip.peripherals().devices.flash.damage(SECOND_BANK);
        run(&mut chip, 100);
        assert_eq!(set(&chip, "TIM1", "SR", "SBIF", 0), 0);
        chip.peripherals().read_flash(SECOND_BANK, 4);
        run(&mut chip, 100);
        assert_eq!(set(&chip, "TIM1", "BDTR", "MOE", 1), 1 - listens);
        assert_eq!(set(&chip, "TIM1", "SR", "SBIF", 0), listens);
    }
}

#[test]
fn a_lock_up_is_seen_within_a_tenth_of_a_millisecond() {
    // No handler of a fault: its vector is erased.
    let mut chip = chip(UNDEFINED);
    assert_eq!(run(&mut chip, 1_000_000), Stop::LockedUp);
    assert!(chip.cycle() <= LOOK_CYCLES, "{}", chip.cycle());
}

fn texts(chip: &Chip) -> Vec<String> {
    let peripherals = chip.peripherals();
    let list = peripherals.findings.list().iter();
    list.map(|finding| finding.text.clone()).collect()
}

#[test]
fn an_interrupt_that_is_asked_for_and_not_enabled_is_found() {
    for asked in [0, 1] {
        let mut chip = chip(STAY);
        set(&chip, "RCC", "APB2ENR", "TIM1EN", 1);
        set(&chip, "TIM1", "DIER", "UIE", asked);
        set(&chip, "TIM1", "EGR", "UG", 1);
        run(&mut chip, unserved::STEADY_CYCLES / 2);
        assert_eq!(texts(&chip), [""; 0]);
        run(&mut chip, 2 * unserved::STEADY_CYCLES);
        let text = "the interrupt TIM1_UP_TIM16 stays pending: the program asks for it, and has not enabled it";
        assert_eq!(texts(&chip), vec![text; asked as usize]);
    }
}

#[test]
fn a_write_to_a_protected_page_of_the_ccm_is_found() {
    let mut chip = chip(STAY);
    set(&chip, "RCC", "APB2ENR", "SYSCFGEN", 1);
    let syscfg = Facts::chip().block("SYSCFG").unwrap();
    let protection = syscfg.base + syscfg.register("SWPR").unwrap().offset;
    chip.peripherals().write(protection, 4, 0b10);
    run(&mut chip, 100);
    for (page, found) in [(0, 0), (2, 0), (1, 1)] {
        let address = CCM.start + page * CCM_PAGE as u32;
        let word = chip.processor().word(address).unwrap();
        assert!(chip.set_word(address, !word));
        chip.check_protected();
        let text = "page 1 of the CCM is written, which SYSCFG_SWPR protects: the chip keeps what was there";
        assert_eq!(texts(&chip), vec![text; found], "page {page}");
    }
}

#[test]
fn a_reset_ends_the_protection_of_the_ccm() {
    let mut chip = chip(STAY);
    set(&chip, "RCC", "APB2ENR", "SYSCFGEN", 1);
    let syscfg = Facts::chip().block("SYSCFG").unwrap();
    let protection = syscfg.base + syscfg.register("SWPR").unwrap().offset;
    chip.peripherals().write(protection, 4, u32::MAX);
    run(&mut chip, 100);
    chip.cycle_power(7);
    run(&mut chip, 100);
    chip.check_protected();
    assert_eq!(texts(&chip), [""; 0]);
}

#[test]
fn a_reset_tells_where_the_program_was() {
    let mut chip = chip(STAY);
    run(&mut chip, 100);
    chip.reset(ResetFlag::Pin);
    assert_eq!(chip.place().0.pc, START);
    run(&mut chip, 100);
    assert_eq!(chip.place().0, chip.processor().place());
}
