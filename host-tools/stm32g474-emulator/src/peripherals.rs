//! The bus between the processor and the peripherals, and what passes between these.

use crate::access::AccessChecks;
use crate::board::Board;
use crate::clocks::Clocks;
use crate::device::{Context, Device};
use crate::devices::{Devices, SystemBreak};
use crate::facts::{Block, Facts, Switch};
use crate::findings::Findings;
use crate::rcc::ResetFlag;

/// Up to this frequency, Hz, the processor's clock may be raised in one step: half of the chip's highest, to which RM0440's
/// own sequence, and ST's driver (stm32g4xx_hal_rcc.c), go at once.
const LARGE_STEP_HZ: u32 = 85_000_000;

/// How long the processor has to run at half of a higher frequency, with the voltage for that, µs: RM0440, change to range 1
/// boost mode.
const STEP_PAUSE_US: u64 = 1;

/// The peripherals, the time, and what the image did wrong.
#[derive(Clone)]
pub struct Peripherals {
    /// Cycles since the power-up.
    pub cycle: u64,
    /// The frequencies of the moment.
    pub clocks: Clocks,
    /// Since when the processor has had its frequency and its voltage, in cycles since the power-up.
    clocked_since: u64,
    /// The core's voltage, in words.
    voltage: &'static str,
    /// What the image did wrong.
    pub findings: Findings,
    /// What holds for all accesses.
    pub checks: AccessChecks,
    /// The peripherals.
    pub devices: Devices,
    resets: Vec<(Switch, &'static Block)>,
}

impl Peripherals {
    /// After a power-up.
    #[must_use]
    pub fn new(board: &Board) -> Self {
        let devices = Devices::new(board);
        Self {
            cycle: 0,
            clocks: Clocks::RESET,
            clocked_since: 0,
            voltage: devices.pwr.voltage(),
            findings: Findings::default(),
            checks: AccessChecks::default(),
            devices,
            resets: resets(),
        }
    }

    /// Says the moment: what follows happens then, and what is found belongs to it.
    pub fn set_cycle(&mut self, cycle: u64) {
        self.cycle = cycle;
        self.findings.set_cycle(cycle);
    }

    /// The peripherals at a moment, and what they see of the chip then.
    pub fn moment(&mut self, cycle: u64) -> (&mut Devices, Context<'_>) {
        self.set_cycle(cycle);
        self.now()
    }

    /// The same at the moment of the last call.
    fn now(&mut self) -> (&mut Devices, Context<'_>) {
        let context = Context {
            cycle: self.cycle,
            clocks: &self.clocks,
            findings: &mut self.findings,
        };
        (&mut self.devices, context)
    }

    /// The processor reads one, two or four bytes.
    pub fn read(&mut self, address: u32, width: u32) -> u32 {
        let answering = self
            .checks
            .answering(address, &self.devices.rcc, &mut self.findings);
        let Some((block, register)) = answering else {
            return 0;
        };
        let (devices, mut context) = self.now();
        let word = devices.read(block.name, register.offset, &mut context);
        match word {
            Some(word) => part(word, address, width),
            None => {
                self.findings.add(format!("{} is not modelled", block.name));
                0
            }
        }
    }

    /// The processor writes one, two or four bytes.
    pub fn write(&mut self, address: u32, width: u32, value: u32) {
        let answering = self
            .checks
            .answering(address, &self.devices.rcc, &mut self.findings);
        let Some((block, register)) = answering else {
            return;
        };
        // Parts of a word are written to data registers only, and at their lowest byte.
        let fits = register.name == "TDR" || register.known >> (8 * width.min(3)) == 0;
        if width < 4 && (address & 3 != 0 || !fits) {
            self.findings.add(format!(
                "{}_{} is written by {width} bytes",
                block.name, register.name
            ));
        }
        let answering = (block, register);
        if !self.checks.write(answering, value, &mut self.findings) {
            return;
        }
        let place = (register.offset, value);
        let (devices, mut context) = self.now();
        if devices.write(block.name, place, &mut context).is_none() {
            self.findings.add(format!("{} is not modelled", block.name));
        }
    }

    /// The processor reads from the flash's second bank.
    pub fn read_flash(&mut self, address: u32, width: u32) -> u32 {
        let (devices, mut context) = self.now();
        devices.flash.read_array(address, width, &mut context)
    }

    /// The processor writes to the flash's second bank.
    pub fn write_flash(&mut self, address: u32, width: u32, value: u32) {
        let (devices, mut context) = self.now();
        let flash = &mut devices.flash;
        flash.write_array(address, width, value, &mut context);
    }

    /// The host sends a byte on the serial line.
    pub fn send(&mut self, byte: u8, baud: u32) {
        let (devices, mut context) = self.now();
        devices.lpuart.host_send(byte, baud, &mut context);
    }

    /// The supply is gone: what is being written to the flash stays half done, and what only a power-up resets is reset.
    pub fn lose_power(&mut self) {
        self.devices.flash.cut_power();
        self.devices.dbgmcu.reset();
        self.devices.rcc.forget_causes();
    }

    /// A reset of the chip, whose supply stays.
    pub fn reset(&mut self, cause: ResetFlag) {
        self.devices.reset();
        self.devices.rcc.note_cause(cause);
        self.checks.reset();
    }

    /// Something of the chip itself: TIM1 breaks if SYSCFG says so. All but a lockup passes.
    pub fn break_by(&mut self, cause: SystemBreak) {
        self.devices.locked_up |= cause == SystemBreak::Lockup;
        let (devices, mut context) = self.now();
        if devices.breaks_by(cause) {
            devices.tim1.set_system_break(true, &mut context);
        }
        self.advance();
    }

    /// The crystal stops: if the chip watches it, an NMI comes, and TIM1 breaks.
    pub fn stop_crystal(&mut self) {
        self.devices.rcc.stop_crystal();
        self.advance();
    }

    /// A crystal that stood still swings again, at so many Hz.
    pub fn start_crystal(&mut self, crystal_hz: u32) {
        let (devices, context) = self.now();
        devices.rcc.start_crystal(crystal_hz, &context);
        self.advance();
    }

    /// Resets the blocks that the image holds in reset.
    fn reset_blocks(&mut self) {
        for (switch, block) in &self.resets {
            if self.devices.rcc.enabled(*switch) {
                self.devices.reset_block(block.name);
                self.checks.reset_block(block);
            }
        }
    }

    /// Lets everything happen that is due, and hands on what passes between peripherals.
    pub fn advance(&mut self) {
        self.note_voltage();
        if self.devices.rcc.take_changed() {
            self.change_clocks();
            self.reset_blocks();
        }
        let (devices, mut context) = self.now();
        devices.advance(&mut context);
        self.check_speed();
    }
}

impl Peripherals {
    /// Takes over what the image has made of the clock tree, and whether the chip can run so.
    fn change_clocks(&mut self) {
        let before = self.clocks;
        self.clocks = self.devices.rcc.clocks(self.cycle);
        if before.hclk != self.clocks.hclk {
            let rates = (before.hclk, self.clocks.hclk);
            self.devices.iwdg.rate_changes(self.cycle, rates.0, rates.1);
            self.check_step(before.hclk);
            self.clocked_since = self.cycle;
        }
    }

    /// The time at half of a frequency counts from the change of the voltage, too.
    fn note_voltage(&mut self) {
        let voltage = self.devices.pwr.voltage();
        if voltage != self.voltage {
            self.voltage = voltage;
            self.clocked_since = self.cycle;
        }
    }

    /// Reports a step to a high frequency that is too large, or that follows another, or a change of the voltage, too soon.
    fn check_step(&mut self, before_hz: u32) {
        let after_hz = self.clocks.hclk;
        let waited = (self.cycle - self.clocked_since) * 1_000_000;
        let settled = waited >= STEP_PAUSE_US * u64::from(before_hz);
        if after_hz > LARGE_STEP_HZ && (before_hz < after_hz / 2 || !settled) {
            self.findings.add(format!(
                "the processor's clock goes from {before_hz} Hz to {after_hz} Hz without {STEP_PAUSE_US} µs at half of that"
            ));
        }
    }

    /// Reports a processor that is too fast for its voltage or its flash.
    fn check_speed(&mut self) {
        let (devices, mut context) = self.now();
        let (clocks, wait_states) = (context.clocks, devices.flash.latency());
        devices.pwr.check(clocks, wait_states, &mut context);
    }
}

/// What holds each block in reset.
fn resets() -> Vec<(Switch, &'static Block)> {
    let blocks = Facts::chip().blocks.iter();
    blocks
        .filter_map(|block| Some((block.reset?, block)))
        .collect()
}

/// The bytes of a word that an access asks for, in the lowest.
fn part(word: u32, address: u32, width: u32) -> u32 {
    let shifted = word >> (8 * (address & 3));
    match width {
        1 => shifted & 0xff,
        2 => shifted & 0xffff,
        _ => shifted,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests;
