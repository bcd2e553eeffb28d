//! What the board's image shows by its LED, and which of the drivers' fault lines it reads, on the emulated chip.

use crate::common::chip::{
    MS, Outcome, driving, findings, identity, image, started, telemetry, vary_cells,
};
use leg_boards::image::FirmwareImage;
use leg_firmware::supervisor::{Fault, State};
use stm32g474_emulator::board::Board;
use stm32g474_emulator::chip::Chip;
use stm32g474_emulator::facts::Pin;
use stm32g474_emulator::gpio::Outside;

const fn pin(port: char, number: u8) -> Pin {
    Pin { port, number }
}

/// The LED, and the lines of BOARD.md's table of pins, low when a driver fails: of each driver, and the one that all share.
const LED: Pin = pin('A', 5);
const SHARED_LINE: Pin = pin('B', 10);
const FAULT_LINES: [Pin; 4] = [pin('B', 2), pin('B', 11), pin('B', 15), SHARED_LINE];

/// What switches the drivers on.
const ENABLE: Pin = pin('C', 9);

/// Cycles of a tick, and those within which the timer ends its pulses by itself: 64 are those of the filter of its input.
const TICK_CYCLES: u64 = MS / 8;
const BREAK_CYCLES: u64 = 80;

/// A step of a pattern, ms, and how often it is looked at in that.
const STEP_MS: u64 = 100;
const LOOKS: u64 = 20;

/// For how long the LED is on and off by turns within some steps of a pattern, in twentieths of a step.
fn led_times(chip: &mut Chip, steps: u64) -> Vec<(bool, u64)> {
    let mut times: Vec<(bool, u64)> = Vec::new();
    for _ in 0..steps * LOOKS {
        pass(chip, STEP_MS / LOOKS);
        let on = chip.peripherals().devices.level(LED) == Some(true);
        match times.last_mut() {
            Some((last, count)) if *last == on => *count += 1,
            _ => times.push((on, 1)),
        }
    }
    times
}

/// Lets some milliseconds pass.
fn pass(chip: &mut Chip, milliseconds: u64) {
    for _ in 0..milliseconds {
        run(chip, MS);
        vary_cells(chip);
    }
}

fn run(chip: &mut Chip, cycles: u64) {
    let end = chip.cycle() + cycles;
    while chip.cycle() < end {
        chip.run(end);
    }
}

/// Whether a time is one of so many steps.
fn lasts(steps: u64, looks: u64) -> bool {
    looks.abs_diff(steps * LOOKS) <= 2
}

/// Disarmed it is on for 0.1 s of 2 s; off after a fault it is on and off by turns, 0.1 s each.
#[test]
fn the_led_shows_the_state() -> Outcome {
    let mut session = started(10)?;
    let chip = session.chip().ok_or("no chip")?;
    identity(chip)?;
    let times = led_times(chip, 45);
    assert_eq!(telemetry(chip)?.state, State::Disarmed);
    let inside = &times[1..times.len() - 1];
    for shown in [true, false] {
        assert!(inside.iter().any(|&(on, _)| on == shown), "{times:?}");
    }
    assert!(
        inside
            .iter()
            .all(|&(on, looks)| lasts(if on { 1 } else { 19 }, looks)),
        "{times:?}"
    );
    chip.peripherals()
        .devices
        .set_outside(FAULT_LINES[0], Outside::Low);
    pass(chip, 5);
    assert_eq!(telemetry(chip)?.state, State::Off);
    let times = led_times(chip, 6);
    let inside = &times[1..times.len() - 1];
    assert!(
        inside.len() >= 4 && inside.iter().all(|&(_, looks)| lasts(1, looks)),
        "{times:?}"
    );
    assert_eq!(findings(chip), [""; 0]);
    Ok(())
}

/// A driver whose own line is broken is told by the line that all share, and the other way round. The shared one needs no program.
#[test]
fn each_fault_line_ends_the_pulses_by_itself() -> Outcome {
    let image = image(FirmwareImage::Stm32g474)?;
    for line in FAULT_LINES {
        let mut session = driving(&image, Board::default())?;
        let chip = session.chip().ok_or("no chip")?;
        chip.peripherals().devices.set_outside(line, Outside::Low);
        let by_itself = line == SHARED_LINE;
        run(
            chip,
            if by_itself {
                BREAK_CYCLES
            } else {
                2 * TICK_CYCLES
            },
        );
        assert!(!chip.peripherals().devices.tim1.outputs().on, "{line:?}");
        run(chip, TICK_CYCLES);
        assert_eq!(chip.peripherals().devices.level(ENABLE), Some(false));
        pass(chip, 5);
        // The line that all share latches: it is read while it lasts.
        let told = telemetry(chip)?;
        assert_eq!(told.state, State::Off, "{line:?}");
        assert!(told.faults.has(Fault::DriverFault), "{line:?}");
    }
    Ok(())
}
