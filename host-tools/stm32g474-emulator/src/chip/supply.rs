//! What happens to a chip whose supply or crystal fails.

use super::Chip;
use crate::devices::SystemBreak;
use crate::rcc::ResetFlag;

/// The supply below which the datasheet promises nothing, mV.
const SUPPLY_MIN_MV: u32 = 1_710;

/// The supply from which on RAM keeps what it holds, mV: the datasheet has no figure for a chip in reset, so this one is
/// chosen.
const RAM_KEPT_MV: u32 = 1_000;

impl Chip {
    /// Takes the supply away and gives it back: RAM then holds anything, and what was being written to the flash is half
    /// done.
    pub fn cycle_power(&mut self, seed: u64) {
        self.dip_supply(0, seed);
    }

    /// Lets the supply fall to so many millivolts for a moment. Below the brown-out level of the option bytes that is a
    /// reset; without one, a supply outside of the datasheet's range is a finding. True if the chip was reset.
    pub fn dip_supply(&mut self, lowest_mv: u32, seed: u64) -> bool {
        let mut peripherals = self.peripherals();
        if lowest_mv >= peripherals.devices.flash.brown_out_mv() {
            if lowest_mv < SUPPLY_MIN_MV {
                peripherals.findings.add(format!(
                    "the chip runs at {lowest_mv} mV, below its {SUPPLY_MIN_MV} mV"
                ));
            }
            if peripherals.devices.pwr.detects(lowest_mv) {
                peripherals.break_by(SystemBreak::Supply);
            }
            return false;
        }
        peripherals.advance();
        peripherals.lose_power();
        drop(peripherals);
        if lowest_mv < RAM_KEPT_MV {
            self.processor.scramble_ram(seed);
        }
        self.reset(ResetFlag::BrownOut);
        true
    }

    /// Lets the crystal stop.
    pub fn stop_crystal(&mut self) {
        self.peripherals().stop_crystal();
    }

    /// Lets a crystal that stood still swing again, at so many Hz.
    pub fn start_crystal(&mut self, crystal_hz: u32) {
        self.peripherals().start_crystal(crystal_hz);
    }
}
