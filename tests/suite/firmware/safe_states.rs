//! States in which nothing moves, and what leads out of them.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::control_law::Bench;
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::leg::Leg;
use leg_firmware::sensors::Sensors;
use leg_firmware::supervisor::State;
use leg_rig::control_settings;
use leg_rig::rig_file::RigFile;
use std::fs;

/// Sixteen ticks, whatever the sensors read and the host asks for.
#[test]
fn a_leg_that_starts_only_reads_its_sensors() {
    const TICKS: u32 = 16;
    let rig = RigFile::load(None).unwrap();
    let settings = control_settings::settings(&rig, &rig.gains, Some([0.2; 3]));
    for code in [0, 1, 30_000, u16::MAX] {
        let mut leg = Leg::<f32>::new(&settings).unwrap();
        let sensors = Sensors {
            cell_codes: [code; 3],
            current_codes: [code; 3],
            encoder_counts: [code; 3],
            supply_code: code,
            temperature_code: code,
            cell_fresh: [true; 3],
            ..Sensors::default()
        };
        for tick in 1..=TICKS {
            leg.command(1, Command::Arm);
            let drive = leg.tick(&sensors);
            assert!(
                !drive.enabled && drive.duty == [0.0; 3],
                "{code}: tick {tick}"
            );
            assert_eq!(
                leg.state() == State::Boot,
                tick < TICKS,
                "{code}: tick {tick}"
            );
        }
        assert!(
            matches!(leg.state(), State::Disarmed | State::Off),
            "{code}"
        );
    }
    let page = fs::read_to_string(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../firmware/SAFETY.md"
    ));
    let words = format!(
        "the first {TICKS} ticks ({} ms) only read the sensors",
        TICKS / 8
    );
    assert!(page.unwrap().contains(&words), "{words}");
}

/// A fault that switches the drivers off has a leg start off: the emergency stop is pressed, or its wire is torn.
#[test]
fn a_leg_that_starts_with_its_emergency_stop_pressed_is_off() {
    let rig = RigFile::load(None).unwrap();
    let settings = control_settings::settings(&rig, &rig.gains, None);
    for emergency_stop in [false, true] {
        let mut leg = Leg::<f64>::new(&settings).unwrap();
        let sensors = Sensors {
            emergency_stop,
            ..Bench::new(None).sensors
        };
        for _ in 0..20 {
            let drive = leg.tick(&sensors);
            assert!(!drive.enabled && drive.duty == [0.0; 3]);
        }
        let expected = if emergency_stop {
            State::Off
        } else {
            State::Disarmed
        };
        assert_eq!(leg.state(), expected);
    }
}

/// A stop leaves a leg that is disarmed or off as it is, and one that ramps down goes on.
#[test]
fn a_stop_wakes_no_leg_and_ends_no_ramp() {
    let mut bench = Bench::new(Some([0.2; 3]));
    assert_eq!(bench.obey(Command::Stop), Ok(()));
    assert_eq!(bench.leg.state(), State::Disarmed);
    assert_eq!(bench.obey(Command::Arm), Ok(()));
    bench.run(400);
    assert_eq!(bench.obey(Command::Disarm), Ok(()));
    assert_eq!(bench.leg.state(), State::RampingDown);
    let refused = Err(CommandRefusal::State(State::RampingDown));
    assert_eq!(bench.obey(Command::Stop), refused);
    while bench.leg.state() == State::RampingDown {
        bench.run(1);
    }
    assert_eq!(bench.leg.state(), State::Disarmed);
    bench.sensors.emergency_stop = true;
    bench.run(1);
    assert_eq!(bench.obey(Command::Stop), Ok(()));
    assert_eq!(bench.leg.state(), State::Off);
}

/// Its zero is not known: it may not be armed where it is.
#[test]
fn a_leg_held_while_it_homed_is_relaxed_by_a_clear() {
    let mut bench = Bench::new(None);
    assert_eq!(bench.obey(Command::Home), Ok(()));
    bench.run(100);
    assert_eq!(bench.leg.state(), State::Homing);
    assert_eq!(bench.obey(Command::Stop), Ok(()));
    bench.run(1300);
    assert_eq!(bench.leg.state(), State::Held);
    assert_eq!(bench.obey(Command::Clear), Ok(()));
    assert_eq!(bench.leg.state(), State::RampingDown);
    while bench.leg.state() == State::RampingDown {
        bench.run(1);
    }
    assert_eq!(bench.leg.state(), State::Disarmed);
    assert_eq!(bench.obey(Command::Arm), Err(CommandRefusal::NotHomed));
}
