//! What the board layer sets up beside the control law: memory that nothing may write, breaks that the chip makes by itself,
//! and what a leg that was held does after a reset.

use crate::common::chip::{
    MS, Outcome, carry_out, driving, findings, identity, identity_after, image, reply,
    reset_within, send, settings, started, started_with, telemetry, ticked,
};
use crate::common::chip_patches::{GUARD, guard};
use leg_boards::chip::{ChipSession, SETTINGS_PLACE, settings_page};
use leg_boards::image::FirmwareImage;
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::host_link::{HostRefusal, HostReply, HostRequest, ResetCause};
use leg_firmware::settings::Settings;
use leg_firmware::store::PAGE_SIZE;
use leg_firmware::supervisor::{Fault, State};
use std::error::Error;
use std::fs;
use stm32g474_emulator::board::Board;
use stm32g474_emulator::chip::Chip;
use stm32g474_emulator::devices::SystemBreak;
use stm32g474_emulator::image::Image;
use stm32g474_emulator::rcc::ResetFlag;

/// A word of the program.
const PROGRAM: u32 = 0x0800_1000;

fn outputs_on(chip: &Chip) -> bool {
    chip.peripherals().devices.tim1.outputs().on
}

#[test]
fn nothing_can_write_below_the_stack_or_into_the_code_of_the_ccm() -> Outcome {
    let parsed = Image::parse(&fs::read(image(FirmwareImage::Stm32g474)?)?)?;
    let end = parsed.symbol("__sheap").ok_or("no variables")?;
    let stack = parsed.symbol("_stack_start").ok_or("no stack")?;
    let mut session = started(10)?;
    let chip = session.chip().ok_or("no chip")?;
    let guard = guard(&parsed)?;
    let permits = |address| chip.processor().permits_write(address);
    for address in (guard..guard + GUARD).step_by(4) {
        assert!(!permits(address), "{address:#010x}");
    }
    assert!(
        [end - 4, guard - 4, guard + GUARD, stack - 4]
            .into_iter()
            .all(permits)
    );
    for ccm in [0x1000_0000, 0x2001_8000] {
        assert!(
            (ccm..ccm + 0x8000)
                .step_by(4)
                .all(|address| !permits(address)),
            "{ccm:#x}"
        );
    }
    Ok(())
}

/// A word of the flash with two wrong bits, and a locked-up processor, end the pulses without a program.
#[test]
fn what_the_chip_finds_of_itself_ends_the_pulses() -> Outcome {
    let path = image(FirmwareImage::Stm32g474)?;
    for cause in [
        SystemBreak::Lockup,
        SystemBreak::Supply,
        SystemBreak::Ecc,
        SystemBreak::Parity,
    ] {
        let mut session = driving(&path, Board::default())?;
        let chip = session.chip().ok_or("no chip")?;
        chip.peripherals().break_by(cause);
        assert!(!outputs_on(chip), "{cause:?}");
        stays_off(chip, MS);
        assert!(telemetry(chip)?.faults.has(Fault::DriverFault), "{cause:?}");
    }
    Ok(())
}

/// A word of the program that has two wrong bits is the end: nothing of it may be carried out.
#[test]
fn wrong_bits_in_the_program_reset_the_chip_and_are_told() -> Outcome {
    let mut session = driving(&image(FirmwareImage::Stm32g474)?, Board::default())?;
    let chip = session.chip().ok_or("no chip")?;
    chip.peripherals().devices.flash.damage(PROGRAM);
    chip.peripherals().read_flash(PROGRAM, 4);
    assert_eq!(reset_within(chip, MS), Some(ResetFlag::Software));
    let identity = identity_after(chip)?;
    assert_eq!(identity.reset, ResetCause::Software);
    let report = identity.crash_report.as_str();
    assert!(report.starts_with("NMI, flash ECC "), "{report}");
    assert!(!outputs_on(chip));
    Ok(())
}

/// Settings whose word has two wrong bits are read as damaged ones: older ones are used, or the built-in ones, with which nothing is driven.
#[test]
fn wrong_bits_in_the_settings_leave_older_or_the_built_in_ones() -> Outcome {
    let mut session = started(40)?;
    let chip = session.chip().ok_or("no chip")?;
    identity(chip)?;
    let built_in = Settings::table_1().ok_or("no built-in settings")?;
    let mut kept = vec![built_in.clone()];
    for factor in [2.0, 3.0] {
        let mut other = built_in.clone();
        other.limits.command_time_s *= factor;
        carry_out(chip, &HostRequest::SetSettings(other.clone()))?;
        carry_out(chip, &HostRequest::SaveSettings)?;
        kept.push(other);
    }
    // From the newest to the oldest: each record has a page of its own.
    for page in [2, 1] {
        damage_page(chip, page)?;
        chip.reset(ResetFlag::Pin);
        assert_eq!(identity_after(chip)?.crash_report.as_str(), "");
        assert_eq!(settings(chip)?, kept[page - 1]);
        assert!(!telemetry(chip)?.faults.has(Fault::SettingsCorrupt));
    }
    damage_page(chip, 0)?;
    chip.reset(ResetFlag::Pin);
    assert_eq!(identity_after(chip)?.reset, ResetCause::Pin);
    assert_eq!(settings(chip)?, built_in);
    let telemetry = telemetry(chip)?;
    assert!(telemetry.faults.has(Fault::SettingsCorrupt));
    assert_eq!(telemetry.state, State::Off);
    assert!(!outputs_on(chip));
    assert_eq!(findings(chip), [""; 0]);
    Ok(())
}

/// Lets two bits be wrong in the middle of what was written in a page of the settings.
fn damage_page(chip: &mut Chip, page: usize) -> Outcome {
    let start = SETTINGS_PLACE.start + (page * PAGE_SIZE) as u32;
    let flash = &mut chip.peripherals().devices.flash;
    let bytes = flash
        .bytes(start..start + PAGE_SIZE as u32)
        .ok_or("no page")?;
    let written = bytes.iter().rposition(|byte| *byte != 0xff);
    let at = written.ok_or("nothing is written")? / 2;
    let wrong = [bytes[at] ^ 0b11];
    let address = start + at as u32;
    flash.load(address, &wrong);
    flash.damage(address);
    Ok(())
}

/// The register of ECC errors keeps the place of the first one, a corrected one, too: where a wrong bit was corrected before, what is wrong among the settings is not taken
/// for the program, nor what is wrong in the program for the settings.
#[test]
fn a_corrected_bit_hides_no_place() -> Outcome {
    let mut session = started(40)?;
    let chip = session.chip().ok_or("no chip")?;
    identity(chip)?;
    carry_out(chip, &HostRequest::SaveSettings)?;
    for page in 0..2 {
        damage_page(chip, page)?;
    }
    chip.reset(ResetFlag::Pin);
    chip.peripherals().devices.flash.weaken(PROGRAM);
    chip.peripherals().read_flash(PROGRAM, 4);
    let identity = identity_after(chip)?;
    assert_eq!(
        (identity.reset, identity.crash_report.as_str()),
        (ResetCause::Pin, "")
    );
    assert!(telemetry(chip)?.faults.has(Fault::SettingsCorrupt));

    let mut session = started(40)?;
    let chip = session.chip().ok_or("no chip")?;
    identity_after(chip)?;
    carry_out(chip, &HostRequest::SaveSettings)?;
    chip.peripherals()
        .devices
        .flash
        .weaken(SETTINGS_PLACE.start + 16);
    chip.reset(ResetFlag::Pin);
    identity_after(chip)?;
    chip.peripherals().devices.flash.damage(PROGRAM);
    chip.peripherals().read_flash(PROGRAM, 4);
    assert_eq!(reset_within(chip, MS), Some(ResetFlag::Software));
    let report = identity_after(chip)?.crash_report;
    assert!(report.starts_with("NMI, flash ECC "), "{report}");
    Ok(())
}

/// A break of the chip itself while nothing is driven, as by a damaged word among the settings, is no fault of the drivers.
#[test]
fn a_system_break_of_a_leg_that_is_off_raises_no_fault() -> Outcome {
    let mut session = started(40)?;
    let chip = session.chip().ok_or("no chip")?;
    identity(chip)?;
    chip.peripherals().break_by(SystemBreak::Ecc);
    stays_off(chip, MS);
    assert!(!telemetry(chip)?.faults.has(Fault::DriverFault));
    Ok(())
}

/// The converters' reference is the supply of the chip: if it leaves its range, no code is what it seems.
#[test]
fn a_reference_out_of_its_range_holds_the_leg() -> Outcome {
    let path = image(FirmwareImage::Stm32g474)?;
    for (reference_mv, fault) in [
        (2_850, Some(Fault::SupplyLow)),
        (3_150, None),
        (3_450, None),
        (3_750, Some(Fault::SupplyHigh)),
    ] {
        let mut session = driving(&path, Board::default())?;
        let chip = session.chip().ok_or("no chip")?;
        chip.peripherals().devices.reference = u16::try_from(1_212 * 16 * 4_095 / reference_mv)?;
        let begun = chip.cycle();
        let end = begun + 2 * MS;
        while chip.cycle() < end {
            chip.run(end);
        }
        let telemetry = telemetry(chip)?;
        let supply = [Fault::SupplyLow, Fault::SupplyHigh];
        let raised: Vec<_> = supply
            .into_iter()
            .filter(|one| telemetry.faults.has(*one))
            .collect();
        assert_eq!(raised, Vec::from_iter(fault), "{reference_mv} mV");
        let expected = if fault.is_some() {
            State::Held
        } else {
            State::Homing
        };
        assert_eq!(telemetry.state, expected, "{reference_mv} mV");
    }
    Ok(())
}

#[test]
fn errors_of_an_encoders_signals_are_told() -> Outcome {
    let mut session = started(40)?;
    session.log_lines();
    let chip = session.chip().ok_or("no chip")?;
    chip.peripherals().devices.encoders[1].break_sequence();
    let end = chip.cycle() + 110 * MS;
    while chip.cycle() < end {
        chip.run(end);
    }
    let log = session.log_lines();
    let told = log
        .iter()
        .filter(|line| line.contains("encoder 2: both tracks changed at once"));
    assert_eq!(told.count(), 1, "{log:?}");
    Ok(())
}

#[test]
fn a_low_brown_out_level_is_told_once_the_board_starts() -> Outcome {
    let path = image(FirmwareImage::Stm32g474)?;
    for (brown_out_level, expected) in [(0, 1), (4, 0)] {
        let board = Board {
            brown_out_level,
            ..Board::default()
        };
        let mut session = started_with(&path, board, 10)?;
        let log = session.log_lines();
        let told = log.iter().filter(|line| line.contains("BOR_LEV"));
        assert_eq!(told.count(), expected, "{log:?}");
    }
    Ok(())
}

/// A leg was held; the host clears, and the board is reset: nothing moves, whatever that host goes on to ask.
#[test]
fn a_held_leg_is_not_driven_after_a_clear_and_a_reset() -> Outcome {
    let mut session = driving(&image(FirmwareImage::Stm32g474)?, Board::default())?;
    let chip = session.chip().ok_or("no chip")?;
    let ask = |command| HostRequest::Command { host: 1, command };
    carry_out(chip, &ask(Command::Stop))?;
    assert_eq!(telemetry(chip)?.state, State::Held);
    carry_out(chip, &ask(Command::Clear))?;
    chip.reset(ResetFlag::Pin);
    // The host goes on as if nothing had happened.
    for command in [Command::Clear, Command::Arm, Command::KeepAlive] {
        stays_off(chip, 60 * MS);
        assert_eq!(refusal(chip, &ask(command))?, HostRefusal::NotIdentified);
    }
    assert!(!outputs_on(chip));
    assert_eq!(identity_after(chip)?.reset, ResetCause::Pin);
    // One that knows of the reset has to home it first.
    let not_homed = HostRefusal::Command(CommandRefusal::NotHomed);
    assert_eq!(refusal(chip, &ask(Command::Arm))?, not_homed);
    stays_off(chip, 20 * MS);
    assert_eq!(telemetry(chip)?.state, State::Disarmed);
    assert_eq!(findings(chip), [""; 0]);
    Ok(())
}

/// A zero among the settings that are kept, as no host of this version writes, holds for no start: the leg has to be homed.
#[test]
fn a_zero_that_is_kept_is_forgotten_at_each_start() -> Outcome {
    let mut homed = Settings::table_1().ok_or("no built-in settings")?;
    for axis in &mut homed.axes {
        axis.unstretched_at_zero_m = Some(0.0343);
    }
    homed.limits.command_time_s *= 2.0;
    let page = settings_page(&homed).ok_or("no page")?;
    let session = ChipSession::open(&image(FirmwareImage::Stm32g474)?)?;
    let mut session = ticked(session.with_flash(&page.bytes), 10)?;
    let chip = session.chip().ok_or("no chip")?;
    for flag in [
        ResetFlag::Pin,
        ResetFlag::BrownOut,
        ResetFlag::IndependentWatchdog,
    ] {
        chip.reset(flag);
        identity_after(chip)?;
        let command = Command::Arm;
        let arm = HostRequest::Command { host: 1, command };
        let not_homed = HostRefusal::Command(CommandRefusal::NotHomed);
        assert_eq!(refusal(chip, &arm)?, not_homed, "{flag:?}");
        assert!(!telemetry(chip)?.homed, "{flag:?}");
        // They were read.
        assert_eq!(settings(chip)?, homed.unhomed());
    }
    Ok(())
}

/// Runs a chip for some cycles, in which its outputs must never be on.
fn stays_off(chip: &mut Chip, cycles: u64) {
    let end = chip.cycle() + cycles;
    while chip.cycle() < end {
        chip.run(end);
        assert!(!outputs_on(chip), "cycle {}", chip.cycle());
    }
}

/// Asks for what has to be refused.
fn refusal(chip: &mut Chip, request: &HostRequest) -> Result<HostRefusal, Box<dyn Error>> {
    send(chip, request)?;
    reply(chip, |reply| match reply {
        HostReply::Refused(refusal) => Some(refusal),
        _ => None,
    })
}
