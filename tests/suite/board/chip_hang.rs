//! A control tick, a task or the processor that hangs: a watchdog resets the chip, and the next start tells why.

use crate::common::chip::{
    MS, Outcome, carry_out, driving, findings, identity, identity_after, image, other_settings,
    reset_within, started,
};
use crate::common::chip_patches::{LINK, driven, place_words, poll_by, replace};
use leg_boards::image::FirmwareImage;
use leg_firmware::host_link::{HostRequest, ResetCause};
use stm32g474_emulator::board::Board;
use stm32g474_emulator::chip::Stop;
use stm32g474_emulator::rcc::ResetFlag;

/// From the last duty that was written to the end of the pulses, at most: 1.6 ms, as SAFETY.md promises.
const CUT_MAX: u64 = MS * 8 / 5;

/// `b .`, an instruction that is its own successor.
const ENDLESS: u32 = 0xe7fe;

/// The longest that all tasks may hang: the time of the watchdog.
const TASK_MAX: u64 = 100 * MS;

/// `movs r0, #0`, `mov sp, r0`, and what is no instruction: the handler of that fault has no stack.
const LOCKS_UP: [u32; 3] = [0x2000, 0x4685, 0xde00];

#[test]
fn a_tick_that_hangs_ends_the_pulses_within_two_milliseconds_and_is_told() -> Outcome {
    let (mut session, parsed) = driven()?;
    let chip = session.chip().ok_or("no chip")?;
    let begun = chip.cycle();
    replace(chip, &parsed, "ADC1_2", &[ENDLESS])?;
    assert_eq!(reset_within(chip, CUT_MAX), Some(ResetFlag::WindowWatchdog));
    eprintln!(
        "a tick that hangs: pulses end after {} µs",
        (chip.cycle() - begun) * 1_000 / MS
    );
    assert!(!chip.peripherals().devices.tim1.outputs().on);
    // The debugger's instruction is copied over when the program starts.
    let identity = identity_after(chip)?;
    assert_eq!(
        (identity.reset, identity.crash_report.as_str()),
        (ResetCause::HungTick, "")
    );
    assert!(!chip.peripherals().devices.tim1.outputs().on);
    assert_eq!(findings(chip), [""; 0]);
    // The independent watchdog is told apart.
    chip.reset(ResetFlag::IndependentWatchdog);
    assert_eq!(identity_after(chip)?.reset, ResetCause::Watchdog);
    Ok(())
}

/// All tasks share one executor: where one does not come back none checks in, while the control ticks go on.
#[test]
fn a_task_that_hangs_is_reset_by_the_watchdog_and_is_told() -> Outcome {
    let (mut session, parsed) = driven()?;
    let chip = session.chip().ok_or("no chip")?;
    let at = place_words(chip, &parsed, &[ENDLESS])?;
    poll_by(chip, &parsed, LINK, at)?;
    let begun = chip.cycle();
    assert_eq!(
        reset_within(chip, TASK_MAX),
        Some(ResetFlag::IndependentWatchdog)
    );
    eprintln!(
        "a task that hangs: reset after {} ms",
        (chip.cycle() - begun) / MS
    );
    assert_eq!(identity_after(chip)?.reset, ResetCause::Watchdog);
    assert!(!chip.peripherals().devices.tim1.outputs().on);
    Ok(())
}

/// A fault in the handler of a fault: nothing runs any more. The break ends the pulses at once, and then the control tick is missed.
#[test]
fn a_locked_up_processor_is_reset_by_the_window_watchdog() -> Outcome {
    let (mut session, parsed) = driven()?;
    let chip = session.chip().ok_or("no chip")?;
    replace(chip, &parsed, "ADC1_2", &LOCKS_UP)?;
    let end = chip.cycle() + CUT_MAX;
    let mut stop = chip.run(end);
    while stop != Stop::LockedUp && chip.cycle() < end {
        stop = chip.run(end);
    }
    assert_eq!(stop, Stop::LockedUp);
    assert!(!chip.peripherals().devices.tim1.outputs().on);
    assert_eq!(reset_within(chip, CUT_MAX), Some(ResetFlag::WindowWatchdog));
    assert_eq!(identity_after(chip)?.reset, ResetCause::HungTick);
    assert!(!chip.peripherals().devices.tim1.outputs().on);
    Ok(())
}

/// In the second bank a page is erased while ticks go on.
#[test]
fn ticks_go_on_while_settings_are_saved() -> Outcome {
    let mut session = started(10)?;
    let chip = session.chip().ok_or("no chip")?;
    identity(chip)?;
    carry_out(chip, &HostRequest::SetSettings(other_settings()?))?;
    // The first tick comes later than the others.
    chip.peripherals().devices.wwdg.take_longest_steps();
    // A record fills a page, and the first save after a start may erase.
    for _ in 0..4 {
        carry_out(chip, &HostRequest::SaveSettings)?;
    }
    let steps = chip.peripherals().devices.wwdg.take_longest_steps();
    eprintln!("the longest between two ticks' ends: {steps} of 64 steps of the window watchdog");
    assert!(steps <= 8, "{steps}");
    assert_eq!(identity(chip)?.reset, ResetCause::Power);
    assert_eq!(findings(chip), [""; 0]);
    Ok(())
}

#[test]
fn a_debugger_that_halts_a_driven_leg_resets_the_chip() -> Outcome {
    let mut session = driving(&image(FirmwareImage::Stm32g474)?, Board::default())?;
    let chip = session.chip().ok_or("no chip")?;
    let reset = Stop::Reset(ResetFlag::WindowWatchdog);
    assert_eq!(chip.halt_by_debugger(CUT_MAX), Some(reset));
    assert_eq!(identity_after(chip)?.reset, ResetCause::HungTick);
    // Nothing is driven: it may be halted for as long as somebody likes, and goes on.
    assert_eq!(chip.halt_by_debugger(500 * MS), None);
    assert_eq!(reset_within(chip, 20 * MS), None);
    Ok(())
}

/// OpenOCD has both watchdogs rest in a halt as it attaches, whatever the leg does: the next tick that drives takes that back.
#[test]
fn a_debugger_that_has_the_watchdogs_rest_resets_a_driven_leg_too() -> Outcome {
    let mut session = driving(&image(FirmwareImage::Stm32g474)?, Board::default())?;
    let chip = session.chip().ok_or("no chip")?;
    chip.peripherals().devices.rest_watchdogs_in_halt();
    // Four ticks.
    assert_eq!(reset_within(chip, MS / 2), None);
    let reset = Stop::Reset(ResetFlag::WindowWatchdog);
    assert_eq!(chip.halt_by_debugger(CUT_MAX), Some(reset));
    // One that is not driven may be halted for as long as somebody likes.
    assert_eq!(identity_after(chip)?.reset, ResetCause::HungTick);
    chip.peripherals().devices.rest_watchdogs_in_halt();
    assert_eq!(chip.halt_by_debugger(500 * MS), None);
    Ok(())
}
