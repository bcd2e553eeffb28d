//! An older image has kept settings; the image as it is finds them, and power is cut meanwhile.

use super::{Mistake, mistakes};
use crate::common::chip::{
    MS, carry_out, findings, identity, identity_after, image, other_settings, send, settings,
    telemetry,
};
use leg_boards::chip::{ChipSession, SETTINGS_PLACE};
use leg_boards::image::FirmwareImage;
use leg_firmware::host_link::HostRequest;
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::Fault;
use std::error::Error;
use std::path::Path;
use stm32g474_emulator::chip::Chip;

/// Moments of a power cut after the request to save, µs. A record fills a page: its words take 12 ms, and the page 22 ms before that, to be
/// erased, where it was in use.
const CUTS_US: [u64; 6] = [0, 900, 6_000, 12_000, 25_000, 50_000];

/// What the chip uses, and whether it says that they are not those that were kept.
type Used = (Settings, bool);

/// What the image as it is makes of what an older image has kept.
fn updated(older: &Path) -> String {
    update(older).unwrap_or_else(|error| error.to_string())
}

fn update(older: &Path) -> Result<String, Box<dyn Error>> {
    let newer = image(FirmwareImage::Stm32g474)?;
    let kept = kept_by(older, None)?;
    let mut session = started(&newer, &kept)?;
    let log = session.log_lines();
    let chip = session.chip().ok_or("no chip")?;
    let first = used(chip)?;
    let taken_over = first == (other_settings()?, false);
    let refused = first == (built_in()?, true);
    // What is saved now is found after a reset, and ends what was wrong.
    let newest = newest()?;
    set_and_save(chip, &newest)?;
    reply_to_save(chip)?;
    chip.cycle_power(1);
    identity_after(chip)?;
    let replaced = used(chip)? == (newest.clone(), false);
    let found = findings(chip);
    let mut ends = [0, 0];
    for cut_us in CUTS_US {
        let mut session = started(&newer, &kept)?;
        let chip = session.chip().ok_or("no chip")?;
        let end = settings_after_cut(chip, &newest, cut_us)
            .map_err(|error| format!("newer image, cut after {cut_us} us: {error}"))?;
        ends[usize::from(end == (newest.clone(), false))] += 1;
        if end != first && end != (newest.clone(), false) {
            return Ok(format!("cut after {cut_us} us: {end:?}"));
        }
        // The older image loses power, and the image as it is comes after it.
        let kept = kept_by(older, Some(cut_us))
            .map_err(|error| format!("older image, cut after {cut_us} us: {error}"))?;
        let mut session = started(&newer, &kept)?;
        let end = used(session.chip().ok_or("no chip")?)
            .map_err(|error| format!("update, cut after {cut_us} us: {error}"))?;
        if end != first && end != (built_in()?, true) {
            return Ok(format!("older image cut after {cut_us} us: {end:?}"));
        }
    }
    let refusals = log.iter().find(|line| line.contains("settings: "));
    let words = refusals.map(|line| line.split_once("settings: ").map_or("", |(_, words)| words));
    let words = words.unwrap_or("no word");
    Ok(format!(
        "taken over: {taken_over}, refused: {refused} ({words}), replaced: {replaced}, both ends of a cut: {}, findings: {found:?}",
        ends.iter().all(|count| *count > 0)
    ))
}

fn built_in() -> Result<Settings, Box<dyn Error>> {
    Ok(Settings::table_1().ok_or("no built-in settings")?)
}

fn newest() -> Result<Settings, Box<dyn Error>> {
    let mut settings = other_settings()?;
    settings.limits.command_time_s *= 1.5;
    Ok(settings)
}

fn started(image: &Path, flash: &[u8]) -> Result<ChipSession, Box<dyn Error>> {
    crate::common::chip::ticked(ChipSession::open(image)?.with_flash(flash), 10)
}

/// What an image leaves in the flash of a new board that is told to keep other settings; its power may fail meanwhile.
fn kept_by(image: &Path, cut_us: Option<u64>) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut session = started(image, &[])?;
    let chip = session.chip().ok_or("no chip")?;
    let other = other_settings()?;
    match cut_us {
        None => {
            set_and_save(chip, &other)?;
            reply_to_save(chip)?;
        }
        Some(cut_us) => {
            settings_after_cut(chip, &other, cut_us)?;
        }
    }
    let peripherals = chip.peripherals();
    let bytes = peripherals.devices.flash.bytes(SETTINGS_PLACE);
    Ok(bytes.ok_or("no settings' place")?.to_vec())
}

fn set_and_save(chip: &mut Chip, settings: &Settings) -> Result<(), Box<dyn Error>> {
    identity(chip)?;
    carry_out(chip, &HostRequest::SetSettings(settings.clone()))?;
    send(chip, &HostRequest::SaveSettings)
}

fn reply_to_save(chip: &mut Chip) -> Result<(), Box<dyn Error>> {
    crate::common::chip::done(chip)
}

/// Settings are saved, and the power fails after a time: what the chip then uses.
fn settings_after_cut(
    chip: &mut Chip,
    settings: &Settings,
    cut_us: u64,
) -> Result<Used, Box<dyn Error>> {
    set_and_save(chip, settings)?;
    let end = chip.cycle() + cut_us * MS / 1_000;
    while chip.cycle() < end {
        chip.run(end);
    }
    chip.cycle_power(cut_us);
    identity_after(chip)?;
    used(chip)
}

fn used(chip: &mut Chip) -> Result<Used, Box<dyn Error>> {
    identity(chip)?;
    let corrupt = telemetry(chip)?.faults.has(Fault::SettingsCorrupt);
    Ok((settings(chip)?, corrupt))
}

mistakes! {
    settings_of_the_same_layout: Mistake {
        file: "firmware/stm32g474/src/housekeeping.rs",
        right: "const LOG_STEPS: u32 = 50;",
        wrong: "const LOG_STEPS: u32 = 40;",
        run: updated,
        report: "taken over: true, refused: false (no word), replaced: true, both ends of a cut: true, findings: []",
    };
    settings_of_another_shape: Mistake {
        file: "firmware/library/src/store/record.rs",
        right: "(\"settings\")",
        wrong: "(\"settings of before\")",
        run: updated,
        report: "taken over: false, refused: true (another firmware's settings are stored), replaced: true, both ends of a cut: true, findings: []",
    };
}
