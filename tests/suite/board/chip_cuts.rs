//! Power that fails while the board's image saves settings, on the emulated chip.

use crate::common::chip::{
    MS, Outcome, carry_out, done, findings, identity, identity_after, other_settings, send,
    settings, started,
};
use leg_firmware::host_link::HostRequest;
use leg_firmware::settings::Settings;
use leg_firmware::store::{RECORD_MAX, WORD_SIZE};
use std::error::Error;
use stm32g474_emulator::chip::Chip;
use stm32g474_emulator::rcc::ResetCause;

/// A part of the time that a double word takes, 85 µs: the supply fails within it.
const WITHIN_WORD_US: u64 = 80;

/// Steps in which the flash is looked at.
const STEP_CYCLES: u64 = 5 * MS / 1_000;

/// Saves until power fails within an operation of the flash, counted from 1; false if the save ends before.
fn cut_at(chip: &mut Chip, operation: u64, delay_us: u64) -> Result<bool, Box<dyn Error>> {
    let before = operations(chip);
    send(chip, &HostRequest::SaveSettings)?;
    let end = chip.cycle() + 100 * MS;
    while operations(chip) < before + operation {
        if chip.cycle() >= end {
            return Ok(false);
        }
        chip.run(chip.cycle() + STEP_CYCLES);
    }
    let end = chip.cycle() + delay_us * MS / 1_000;
    while chip.cycle() < end {
        chip.run(end);
    }
    chip.cycle_power(operation);
    Ok(true)
}

fn operations(chip: &Chip) -> u64 {
    chip.peripherals().devices.flash.operations()
}

/// The chip then finds the old settings or the new ones.
#[test]
fn settings_survive_a_power_cut_in_every_word_of_a_save() -> Outcome {
    let both = [
        Settings::for_table_1().ok_or("no built-in settings")?,
        other_settings()?,
    ];
    let mut session = started(10)?;
    let chip = session.chip().ok_or("no chip")?;
    identity(chip)?;
    let mut kept = 0;
    let mut counts = [0_u64; 2];
    for operation in 1.. {
        let new = 1 - kept;
        carry_out(chip, &HostRequest::SetSettings(both[new].clone()))?;
        if !cut_at(chip, operation, operation * 37 % WITHIN_WORD_US)? {
            break;
        }
        identity_after(chip)?;
        let found = settings(chip)?;
        let found = both.iter().position(|one| *one == found);
        let found = found.ok_or_else(|| format!("neither, cut in word {operation}"))?;
        counts[usize::from(found == new)] += 1;
        kept = found;
        assert_eq!(findings(chip), [""; 0], "cut in word {operation}");
    }
    let words: u64 = counts.iter().sum();
    println!(
        "{words} cuts: old settings after {}, new ones after {}",
        counts[0], counts[1]
    );
    // The record was cut all through: numbers of varying length make it shorter than the longest, by less than half.
    assert!(words as usize * WORD_SIZE > RECORD_MAX / 2, "{words} words");
    // The last save ended, and what it wrote is kept.
    done(chip)?;
    chip.reset(ResetCause::Pin);
    identity_after(chip)?;
    assert_eq!(settings(chip)?, both[1 - kept]);
    Ok(())
}
