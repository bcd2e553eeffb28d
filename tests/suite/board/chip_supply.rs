//! The chip's supply dips, as its brown-out level sees it.

use crate::common::chip::{
    MS, Outcome, carry_out, driving, findings, identity, identity_after, image, other_settings,
    send, settings, started, telemetry,
};
use leg_boards::image::FirmwareImage;
use leg_firmware::host_link::{HostRequest, ResetCause};
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::Fault;
use stm32g474_emulator::board::Board;

/// The brown-out level, the lowest supply of a dip in mV, whether it resets the chip, and what that tells afterwards: one that
/// goes on tells what it told before.
const DIPS: [(u8, u32, bool, ResetCause); 6] = [
    (0, 2_850, false, ResetCause::Power),
    (0, 2_000, false, ResetCause::Power),
    (0, 1_500, true, ResetCause::BrownOut),
    (0, 500, true, ResetCause::Power),
    (4, 2_700, true, ResetCause::BrownOut),
    (4, 2_900, false, ResetCause::Power),
];

/// Below it the pulses end, whatever the option bytes say.
const DETECTOR_MV: u32 = 2_900;

#[test]
fn a_dip_resets_the_chip_below_its_brown_out_level_and_is_told() -> Outcome {
    let image = image(FirmwareImage::Stm32g474)?;
    for (brown_out_level, lowest_mv, resets, told) in DIPS {
        let board = Board {
            brown_out_level,
            ..Board::default()
        };
        let mut session = driving(&image, board)?;
        let chip = session.chip().ok_or("no chip")?;
        let reset = chip.dip_supply(lowest_mv, 3);
        let case = format!("level {brown_out_level}, {lowest_mv} mV");
        assert_eq!(reset, resets, "{case}");
        let on = chip.peripherals().devices.tim1.outputs().on;
        assert_eq!(on, lowest_mv >= DETECTOR_MV, "{case}");
        if !on && !resets {
            chip.run(chip.cycle() + MS);
            assert!(telemetry(chip)?.faults.has(Fault::DriverFault), "{case}");
        }
        assert_eq!(identity_after(chip)?.reset, told, "{case}");
        assert_eq!(findings(chip), [""; 0], "{case}");
    }
    Ok(())
}

/// The factory's level lets the chip run below its range.
#[test]
fn a_supply_between_the_brown_out_level_and_the_range_is_a_finding() -> Outcome {
    let mut session = started(10)?;
    let chip = session.chip().ok_or("no chip")?;
    assert!(!chip.dip_supply(1_680, 1));
    let found = findings(chip);
    assert!(
        found.len() == 1 && found[0].contains("1680 mV, below its 1710 mV"),
        "{found:?}"
    );
    Ok(())
}

#[test]
fn a_dip_during_a_save_leaves_the_old_settings_or_the_new_ones() -> Outcome {
    let built_in = Settings::table_1().ok_or("no built-in settings")?;
    let other = other_settings()?;
    for dip_us in [0, 700, 3_000, 9_000] {
        let mut session = started(10)?;
        let chip = session.chip().ok_or("no chip")?;
        identity(chip)?;
        carry_out(chip, &HostRequest::SetSettings(other.clone()))?;
        send(chip, &HostRequest::SaveSettings)?;
        let end = chip.cycle() + dip_us * MS / 1_000;
        while chip.cycle() < end {
            chip.run(end);
        }
        assert!(chip.dip_supply(1_500, dip_us));
        assert_eq!(identity_after(chip)?.reset, ResetCause::BrownOut);
        let settings = settings(chip)?;
        assert!(settings == built_in || settings == other, "{dip_us} µs");
        assert_eq!(findings(chip), [""; 0], "{dip_us} µs");
    }
    Ok(())
}
