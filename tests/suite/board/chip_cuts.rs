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
use stm32g474_emulator::facts::Facts;
use stm32g474_emulator::rcc::ResetFlag;

/// A part of the time that a double word takes, 82 µs on the emulated chip, less a step: the supply fails within it.
const WITHIN_WORD_US: u64 = 75;

/// Moments in the erase of a page, which takes 22 ms, µs.
const WITHIN_ERASE_US: [u64; 6] = [10, 1_000, 5_000, 10_000, 15_000, 21_000];

/// Saves after which a page has to have been erased: the settings' place takes fewer.
const SAVES_MAX: usize = 40;

/// Steps in which the flash is looked at.
const STEP_CYCLES: u64 = 5 * MS / 1_000;

/// Saves until power fails, so long after something has begun; false if the save ends before.
fn cut_after(
    chip: &mut Chip,
    begun: impl Fn(&Chip) -> bool,
    delay_us: u64,
) -> Result<bool, Box<dyn Error>> {
    send(chip, &HostRequest::SaveSettings)?;
    let end = chip.cycle() + 100 * MS;
    while !begun(chip) {
        if chip.cycle() >= end {
            return Ok(false);
        }
        chip.run(chip.cycle() + STEP_CYCLES);
    }
    let end = chip.cycle() + delay_us * MS / 1_000;
    while chip.cycle() < end {
        chip.run(end);
    }
    assert!(begun(chip));
    chip.cycle_power(delay_us);
    Ok(true)
}

fn operations(chip: &Chip) -> u64 {
    chip.peripherals().devices.flash.operations()
}

/// Whether a page is being erased.
fn erases(chip: &Chip) -> bool {
    let flash = Facts::chip().block("FLASH");
    let control = flash.and_then(|block| Some((block, block.register("CR")?)));
    control.is_some_and(|(block, control)| {
        let value = chip.peripherals().read(block.base + control.offset, 4);
        let erases = control.field("PER");
        erases.is_some_and(|erases| erases.value(value) == 1)
    })
}

fn two_settings() -> Result<[Settings; 2], Box<dyn Error>> {
    let built_in = Settings::table_1().ok_or("no built-in settings")?;
    Ok([built_in, other_settings()?])
}

/// The chip then finds the old settings or the new ones.
#[test]
fn settings_survive_a_power_cut_in_every_word_of_a_save() -> Outcome {
    let both = two_settings()?;
    let mut session = started(10)?;
    let chip = session.chip().ok_or("no chip")?;
    identity(chip)?;
    let mut kept = 0;
    let mut counts = [0_u64; 2];
    for operation in 1.. {
        let new = 1 - kept;
        carry_out(chip, &HostRequest::SetSettings(both[new].clone()))?;
        let before = operations(chip);
        let begun = |chip: &Chip| operations(chip) >= before + operation;
        if !cut_after(chip, begun, operation * 37 % WITHIN_WORD_US)? {
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
    chip.reset(ResetFlag::Pin);
    identity_after(chip)?;
    assert_eq!(settings(chip)?, both[1 - kept]);
    Ok(())
}

/// The chip then finds what was kept before: what is erased is older.
#[test]
fn settings_survive_a_power_cut_in_an_erase() -> Outcome {
    let both = two_settings()?;
    let mut session = started(10)?;
    let chip = session.chip().ok_or("no chip")?;
    identity(chip)?;
    carry_out(chip, &HostRequest::SaveSettings)?;
    let mut kept = settings(chip)?;
    for delay_us in WITHIN_ERASE_US {
        let mut cut = false;
        for save in 0..SAVES_MAX {
            let new = &both[save % 2];
            carry_out(chip, &HostRequest::SetSettings(new.clone()))?;
            cut = cut_after(chip, erases, delay_us)?;
            if cut {
                break;
            }
            done(chip)?;
            kept.clone_from(new);
        }
        assert!(cut, "no page is erased");
        identity_after(chip)?;
        assert_eq!(settings(chip)?, kept, "cut {delay_us} us after its begin");
        assert_eq!(findings(chip), [""; 0], "cut {delay_us} us after its begin");
    }
    Ok(())
}
