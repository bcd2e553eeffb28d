//! Every check of the bus, of the ports and of the clock tree: a mistake, and the sentence that it is reported by.

mod clock_tree;

use super::*;
use crate::device::FieldPlace;
use crate::facts::{Block, Register};
use clock_tree::{CLOCK_TREE, SPEEDS};

/// The processor's side of the peripherals.
struct Bus(Peripherals);

fn block(name: &str) -> &'static Block {
    Facts::chip().block(name).unwrap()
}

fn register(block: &'static Block, name: &str) -> &'static Register {
    block.register(name).unwrap()
}

impl Bus {
    fn new() -> Self {
        Self(Peripherals::new(&Board::default()))
    }

    /// Sets a bit of RCC.
    fn switch(&mut self, switch: Option<Switch>) {
        let (rcc, switch) = (block("RCC"), switch.unwrap());
        let address = rcc.base + switch.offset;
        let word = self.0.read(address, 4) | 1 << switch.bit;
        self.0.write(address, 4, word);
    }

    fn address(name: &str, of: &str) -> u32 {
        block(name).base + register(block(name), of).offset
    }

    fn read(&mut self, block: &str, of: &str) -> u32 {
        self.0.read(Self::address(block, of), 4)
    }

    fn write(&mut self, block: &str, of: &str, value: u32) {
        self.0.write(Self::address(block, of), 4, value);
    }

    /// Reads a register, sets a field, writes it.
    fn set(&mut self, name: &str, of: &str, field: &str, value: u32) {
        let (offset, mask) = {
            let register = register(block(name), of);
            (register.offset, register.field(field).unwrap().mask)
        };
        let word = FieldPlace { offset, mask }.insert(self.read(name, of), value);
        self.write(name, of, word);
    }

    fn rcc(&mut self, of: &str, field: &str, value: u32) {
        self.set("RCC", of, field, value);
    }

    /// Lets 2.5 ms of the internal oscillator pass.
    fn wait(&mut self) {
        let cycle = self.0.cycle + 40_000;
        self.0.set_cycle(cycle);
        self.0.advance();
    }

    /// Runs the PLL at 170 MHz from the crystal of 24 MHz; the processor does not use it.
    fn lock_pll(&mut self) {
        self.rcc("CR", "HSEON", 1);
        self.wait();
        self.divide_crystal();
        self.rcc("CR", "PLLON", 1);
        self.wait();
    }

    fn divide_crystal(&mut self) {
        self.rcc("PLLCFGR", "PLLSRC", 3);
        self.rcc("PLLCFGR", "PLLM", 5);
        self.rcc("PLLCFGR", "PLLN", 85);
        self.rcc("PLLCFGR", "PLLREN", 1);
    }

    /// Lets the processor run from the PLL, slowly enough for the state after a reset.
    fn run_from_pll(&mut self) {
        self.lock_pll();
        self.rcc("CFGR", "HPRE", 12);
        self.rcc("CFGR", "SW", 3);
        self.wait();
    }

    /// Lets the processor run at half of the PLL's 170 MHz, with the wait states of the whole.
    fn run_at_half(&mut self) {
        self.lock_pll();
        self.set("FLASH", "ACR", "LATENCY", 4);
        self.rcc("CFGR", "HPRE", 8);
        self.rcc("CFGR", "SW", 3);
        self.0.advance();
    }

    fn texts(&self) -> Vec<&str> {
        let list = self.0.findings.list();
        list.iter().map(|finding| finding.text.as_str()).collect()
    }
}

/// What is done, on a bus on which the clocks of some blocks are on, and all that is found.
type Row = (&'static [&'static str], fn(&mut Bus), &'static str);

const ACCESSES: &[Row] = &[
    (
        &[],
        |b| b.0.write(0x5fff_fffc, 4, 0),
        "0x5ffffffc is accessed, where no peripheral is",
    ),
    (
        &[],
        |b| b.write("TIM1", "CR1", 0),
        "TIM1 is accessed while its clock is off",
    ),
    (
        &["TIM1"],
        |b| {
            b.switch(block("TIM1").reset);
            b.read("TIM1", "CR1");
        },
        "TIM1 is accessed while it is in reset",
    ),
    (
        &["TIM15"],
        |b| b.0.write(block("TIM15").base + 0x1c, 4, 0),
        "TIM15 has no register at offset 0x1c, which is accessed",
    ),
    (
        &["TIM8"],
        |b| b.0.write(contradicted("TIM8"), 4, 0),
        "TIM8_CCR3 is accessed, about which the makers' descriptions contradict each other, and no ruling says what holds",
    ),
    (
        &["GPIOA"],
        |b| b.write("GPIOA", "IDR", 0),
        "GPIOA_IDR is written, and can only be read",
    ),
    (
        &["GPIOA"],
        |b| b.write("GPIOA", "LCKR", 0x8000_0000),
        "GPIOA_LCKR is written with reserved bits 0x80000000 changed",
    ),
    (
        &[],
        |b| b.rcc("PLLCFGR", "PLLSRC", 1),
        "RCC_PLLCFGR.PLLSRC is set to 1, which has no meaning",
    ),
    (
        &["GPIOA"],
        |b| b.0.write(Bus::address("GPIOA", "ODR"), 1, 0),
        "GPIOA_ODR is written by 1 bytes",
    ),
    (
        &["GPIOA"],
        |b| b.0.write(Bus::address("GPIOA", "ODR") + 2, 2, 0),
        "GPIOA_ODR is written by 2 bytes",
    ),
    (
        &["ADC4"],
        |b| {
            b.read("ADC4", "ISR");
        },
        "ADC4 is not modelled",
    ),
    (
        &["ADC5"],
        |b| b.write("ADC5", "IER", 0),
        "ADC5 is not modelled",
    ),
    (
        &["USART1"],
        |b| {
            b.read("USART1", "CR1");
        },
        "USART1 is not modelled",
    ),
    (
        &["USART1"],
        |b| b.write("USART1", "CR2", 0),
        "USART1 is not modelled",
    ),
];

const PORTS: &[Row] = &[
    (
        &["GPIOC"],
        |b| {
            b.set("GPIOC", "MODER", "MODER5", 0);
            b.read("GPIOC", "IDR");
        },
        "PC5 is read while nothing gives it a level: no pull, nothing outside",
    ),
    (
        &["GPIOC"],
        |b| {
            b.set("GPIOC", "AFRL", "AFR0", 15);
            b.set("GPIOC", "AFRL", "AFR0", 9);
            b.set("GPIOC", "MODER", "MODER0", 2);
        },
        "PC0 is given alternate function 9, which it does not have",
    ),
    (
        &["GPIOC"],
        |b| {
            b.set("GPIOC", "AFRH", "AFR1", 4);
            b.set("GPIOC", "MODER", "MODER9", 2);
            b.set("GPIOC", "AFRH", "AFR1", 9);
        },
        "PC9 is given alternate function 9, which it does not have",
    ),
];

#[test]
fn mistakes_are_found() {
    let tables = [ACCESSES, PORTS, CLOCK_TREE, SPEEDS];
    for (blocks, mistake, expected) in tables.into_iter().flatten() {
        let mut bus = Bus::new();
        for name in *blocks {
            bus.switch(block(name).enable);
        }
        assert_eq!(bus.texts(), [""; 0]);
        mistake(&mut bus);
        assert_eq!(bus.texts(), [*expected]);
    }
}

/// The address of a block's first register about which the descriptions contradict each other.
fn contradicted(name: &str) -> u32 {
    let block = block(name);
    let mut registers = block.registers.iter();
    block.base + registers.find(|one| one.contradicted).unwrap().offset
}

#[test]
fn what_is_right_is_not_found() {
    let mut bus = Bus::new();
    bus.switch(block("GPIOC").enable);
    bus.switch(block("TIM1").enable);
    bus.run_from_pll();
    // Zeros clear a timer's flags.
    bus.write("TIM1", "SR", u32::MAX);
    // A function that the pin has not does no harm before the pin is given to it.
    bus.set("GPIOC", "AFRL", "AFR0", 9);
    bus.set("GPIOC", "AFRL", "AFR0", 0);
    bus.rcc("CR", "HSION", 0);
    bus.rcc("CCIPR", "FDCANSEL", 2);
    bus.switch(block("FDCAN2").enable);
    assert_eq!(bus.texts(), [""; 0]);
}

#[test]
fn a_microsecond_at_half_of_the_frequency_is_right() {
    let mut bus = Bus::new();
    bus.switch(block("PWR").enable);
    bus.set("PWR", "CR5", "R1MODE", 0);
    bus.run_at_half();
    bus.0.set_cycle(bus.0.cycle + 85);
    bus.rcc("CFGR", "HPRE", 0);
    bus.0.advance();
    assert_eq!(bus.0.clocks.hclk, 170_000_000);
    assert_eq!(bus.texts(), [""; 0]);
}

#[test]
fn a_finding_has_the_cycle_in_which_it_came() {
    let mut bus = Bus::new();
    bus.wait();
    bus.0.set_cycle(50_000);
    bus.write("TIM1", "CR1", 0);
    bus.0.set_cycle(70_000);
    bus.rcc("CFGR", "SW", 2);
    let cycles: Vec<_> = bus.0.findings.list().iter().map(|one| one.cycle).collect();
    assert_eq!(cycles, [50_000, 70_000]);
}

#[test]
fn each_cause_breaks_tim1_by_its_field_alone() {
    let causes = [
        SystemBreak::Lockup,
        SystemBreak::Supply,
        SystemBreak::Ecc,
        SystemBreak::Parity,
    ];
    for (field, cause) in ["CLL", "PVDL", "ECCL", "SPL"].into_iter().zip(causes) {
        let mut bus = Bus::new();
        bus.switch(block("SYSCFG").enable);
        bus.set("SYSCFG", "CFGR2", field, 1);
        let breaking = causes.map(|one| bus.0.devices.breaks_by(one));
        assert_eq!(breaking, causes.map(|one| one == cause));
    }
}
