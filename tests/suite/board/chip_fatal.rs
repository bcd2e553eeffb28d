//! A program that ends: its outputs are off before the chip resets, and its report is there after it.

use crate::common::chip::{MS, Outcome, drive, findings, identity_after, vary_cells};
use crate::common::chip_patches::{
    GUARD, LINK, SETTINGS, driven, guard, place_words, poll_by, replace,
};
use leg_firmware::board::{CheckIns, WatchedTask};
use leg_firmware::host_link::{Identity, ResetCause};
use std::error::Error;
use stm32g474_emulator::chip::{Chip, Stop};
use stm32g474_emulator::facts::Pin;
use stm32g474_emulator::rcc::ResetFlag;

/// From the failure to the end of the pulses, at most.
const CUT_MAX: u64 = MS / 50;

/// From there to the reset, at most: the report is written and logged.
const REPORT_MAX: u64 = MS;

/// The longest from the end of the pulses to the watchdog's reset, as SAFETY.md promises.
const WATCHDOG_MAX: u64 = 100 * MS;

/// An instruction that is none.
const UNDEFINED: u32 = 0xde00;

/// `bx lr`: a task that comes back at once, and waits for nothing.
const RETURNS: u32 = 0x4770;

/// `ldr r0, [pc, #4]`, `ldr r1, [pc, #8]`, `bx r1`: calls the second word behind it with the first.
const CALLS: [u32; 2] = [0x4902_4801, 0xbf00_4708];

/// `ldr r0, [pc, #4]`, `str r0, [r0]`: writes to the word behind it.
const WRITES: [u32; 2] = [0x6000_4801, 0xbf00_bf00];

/// `ldr r0, [pc, #4]`, `mov sp, r0`, `push {r0}`: a stack that ends at the word behind it.
const PUSHES: [u32; 2] = [0x4685_4801, 0xbf00_b401];

/// Whether the pulses or the drivers' enable are on.
fn outputs_on(chip: &Chip) -> bool {
    let peripherals = chip.peripherals();
    let enable = Pin {
        port: 'C',
        number: 9,
    };
    peripherals.devices.tim1.outputs().on || peripherals.devices.level(enable) == Some(true)
}

/// Runs a driven chip until its outputs are off, which has to be before a reset; the time that took.
fn cut_within(chip: &mut Chip, cycles: u64) -> u64 {
    let begun = chip.cycle();
    let end = begun + cycles;
    assert!(outputs_on(chip), "it is not driven");
    while outputs_on(chip) {
        let step = chip.cycle() + 1;
        let stop = chip.run(step);
        assert!(!matches!(stop, Stop::Reset(_)), "{stop:?}: outputs on");
        assert!(chip.cycle() < end, "outputs on");
    }
    chip.cycle() - begun
}

/// Runs until a reset, up to which the outputs stay off; the time to it.
fn reset_with_outputs_off(chip: &mut Chip, cycles: u64) -> Option<(ResetFlag, u64)> {
    let begun = chip.cycle();
    let end = begun + cycles;
    while chip.cycle() < end {
        if let Stop::Reset(cause) = chip.run(end) {
            return Some((cause, chip.cycle() - begun));
        }
        assert!(!outputs_on(chip), "on again");
    }
    None
}

/// A failure is to come now: outputs off, then the reset, then the report.
fn reported(chip: &mut Chip, cut_max: u64) -> Result<Identity, Box<dyn Error>> {
    let cut = cut_within(chip, cut_max);
    let reset = reset_with_outputs_off(chip, REPORT_MAX);
    let Some((ResetFlag::Software, after)) = reset else {
        return Err(format!("{reset:?}").into());
    };
    eprintln!("outputs off after {cut} cycles, reset {after} after that");
    let identity = identity_after(chip)?;
    assert_eq!(identity.reset, ResetCause::Software);
    assert!(!outputs_on(chip));
    assert_eq!(findings(chip), [""; 0]);
    Ok(identity)
}

#[test]
fn a_hard_fault_switches_the_outputs_off_before_the_reset() -> Outcome {
    let (mut session, image) = driven()?;
    let chip = session.chip().ok_or("no chip")?;
    replace(chip, &image, "ADC1_2", &[UNDEFINED])?;
    // The next tick comes within 0.125 ms.
    let identity = reported(chip, MS / 8 + CUT_MAX)?;
    let report = identity.crash_report.as_str();
    assert!(report.starts_with("hard fault at 0x1000"), "{report}");
    Ok(())
}

#[test]
fn a_panic_switches_the_outputs_off_before_the_reset() -> Outcome {
    let (mut session, image) = driven()?;
    let chip = session.chip().ok_or("no chip")?;
    let panic = image.functions_ending("panic_const_div_by_zero");
    let panic = panic.first().ok_or("no such panic")? | 1;
    let calls_at = guard(&image)? + GUARD;
    let (place, file) = (calls_at + 16, calls_at + 32);
    // Where it panics: the file's name and its length, line and column.
    let name = [*b"task", *b".rs\0"].map(u32::from_le_bytes);
    let words = [
        CALLS[0], CALLS[1], place, panic, file, 7, 12, 5, name[0], name[1],
    ];
    let at = place_words(chip, &image, &words)?;
    poll_by(chip, &image, LINK, at)?;
    // The task waits for a byte, or 1 ms.
    let identity = reported(chip, 2 * MS)?;
    let report = identity.crash_report.as_str();
    assert_eq!(report, "task.rs:12: attempt to divide by zero");
    Ok(())
}

/// What the MPU refuses is a hard fault: a write into the code, and a stack that has come down to its guard.
#[test]
fn a_write_into_the_code_and_a_stack_that_overflows_are_hard_faults() -> Outcome {
    for in_code in [true, false] {
        let (mut session, image) = driven()?;
        let chip = session.chip().ok_or("no chip")?;
        let words = if in_code {
            let code = image.symbol("ADC1_2").ok_or("no handler")? & !3;
            [WRITES[0], WRITES[1], code]
        } else {
            [PUSHES[0], PUSHES[1], guard(&image)? + GUARD]
        };
        let at = place_words(chip, &image, &words)?;
        poll_by(chip, &image, LINK, at)?;
        let identity = reported(chip, 2 * MS)?;
        let report = identity.crash_report.as_str();
        // What an overflow would have put on the stack is not there: it does not say where it was.
        let place = if in_code {
            format!("hard fault at {:#010x}", at + 2)
        } else {
            "hard fault at 0x".into()
        };
        assert!(report.starts_with(&place), "{report}, not {place}");
    }
    Ok(())
}

/// A debugger has time to attach where a program fails as soon as it drives; its outputs are off meanwhile.
#[test]
fn after_three_failures_in_a_row_the_next_start_waits_with_outputs_off() -> Outcome {
    const REST: [u64; 2] = [1_000 * MS, 2_010 * MS];
    let (mut session, image) = driven()?;
    let chip = session.chip().ok_or("no chip")?;
    for failure in 1..=3 {
        replace(chip, &image, "ADC1_2", &[UNDEFINED])?;
        if failure < 3 {
            reported(chip, MS / 8 + CUT_MAX)?;
            drive_anew(chip)?;
        }
    }
    cut_within(chip, MS / 8 + CUT_MAX);
    let reset = reset_with_outputs_off(chip, REST[1]);
    let Some((ResetFlag::Software, after)) = reset else {
        return Err(format!("{reset:?}").into());
    };
    eprintln!("the third: reset after {} ms", after / MS);
    assert!(after >= REST[0], "{} ms", after / MS);
    let report = identity_after(chip)?.crash_report;
    assert!(report.as_str().starts_with("hard fault at "), "{report}");
    assert!(!outputs_on(chip));
    Ok(())
}

/// A failure long after the start begins a row of its own.
#[test]
fn a_second_without_a_failure_ends_the_row() -> Outcome {
    let (mut session, image) = driven()?;
    let chip = session.chip().ok_or("no chip")?;
    for failure in 1..=3 {
        replace(chip, &image, "ADC1_2", &[UNDEFINED])?;
        // The third resets at once, as the two before.
        reported(chip, MS / 8 + CUT_MAX)?;
        match failure {
            1 => drive_anew(chip)?,
            2 => drive_later(chip, 1_100)?,
            _ => {}
        }
    }
    Ok(())
}

/// Starts the chip anew and drives.
fn drive_anew(chip: &mut Chip) -> Outcome {
    drive_later(chip, 60)
}

/// Starts the chip anew and drives after a time: load cells that read the same for long are stuck.
fn drive_later(chip: &mut Chip, after_ms: u64) -> Outcome {
    chip.reset(ResetFlag::Pin);
    for _ in 0..after_ms {
        vary_cells(chip);
        let end = chip.cycle() + MS;
        while chip.cycle() < end {
            chip.run(end);
        }
    }
    drive(chip)
}

/// A task that never checks in while the others do, and the control ticks go on. The watchdog is fed no more from then on.
#[test]
fn a_task_that_is_missed_has_the_outputs_off_before_the_reset() -> Outcome {
    for (task, watched, within_ms) in [
        (LINK, WatchedTask::Link, 60),
        (SETTINGS, WatchedTask::Settings, 510),
    ] {
        let (mut session, image) = driven()?;
        let chip = session.chip().ok_or("no chip")?;
        let at = place_words(chip, &image, &[RETURNS])?;
        poll_by(chip, &image, task, at)?;
        let cut = cut_within(chip, within_ms * MS);
        eprintln!("{watched:?}: outputs off after {} ms", cut / MS);
        assert!(cut > (within_ms - 2 * CheckIns::PERIOD_MS) * MS);
        let reset = reset_with_outputs_off(chip, WATCHDOG_MAX);
        let Some((ResetFlag::IndependentWatchdog, after)) = reset else {
            return Err(format!("{reset:?}").into());
        };
        eprintln!("reset {} ms after that", after / MS);
        let identity = identity_after(chip)?;
        assert_eq!(identity.reset, ResetCause::Watchdog);
        let words = format!("{} did not check in", watched.name());
        assert_eq!(identity.crash_report.as_str(), words);
        assert!(!outputs_on(chip));
    }
    Ok(())
}
