//! What the chip says on its serial line: of one tick, and where that is more than the line takes.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::chip::{
    MS, carry_out, findings, identity, image, reply, reset_within, send, started_with,
};
use leg_boards::image::FirmwareImage;
use leg_firmware::host_link::{HOST_SCHEMA, Hello, HostReply, HostRequest};
use std::fs;
use stm32g474_emulator::board::Board;
use stm32g474_emulator::chip::{Chip, Stop};
use stm32g474_emulator::image::Image;

/// Telemetry in every tick is some ten times what the line takes.
const EVERY_TICK: HostRequest = HostRequest::Stream(1);

/// By then a task that waits for ever would have cost a reset by the watchdog.
const FULL_MS: u64 = 300;

#[test]
fn a_host_that_asks_for_more_than_the_line_takes_is_answered() {
    let image = image(FirmwareImage::Stm32g474).unwrap();
    let mut session = started_with(&image, Board::default(), 10).unwrap();
    let chip = session.chip().unwrap();
    identity(chip).unwrap();
    send(chip, &EVERY_TICK).unwrap();
    assert_eq!(reset_within(chip, FULL_MS * MS), None);
    carry_out(chip, &HostRequest::Stream(0)).unwrap();
    assert_eq!(findings(chip), Vec::<String>::new());
}

/// Telemetry is read in two halves, between which the control interrupt comes where it had to wait for the first.
#[test]
fn telemetry_is_of_one_tick_where_the_next_one_comes_between_its_halves() {
    let path = image(FirmwareImage::Stm32g474).unwrap();
    let parsed = Image::parse(&fs::read(&path).unwrap()).unwrap();
    let mut session = started_with(&path, Board::default(), 10).unwrap();
    let chip = session.chip().unwrap();
    let handler = parsed.symbol("ADC1_2").unwrap() & !1;
    let first_half = parsed.functions_ending("::course");
    chip.watch([first_half, vec![handler]].concat());
    chip.set_watching(true);
    let mut ticks = 10;
    let mut until_read = |chip: &mut Chip, ms: u64| {
        let end = chip.cycle() + ms * MS;
        while chip.cycle() < end {
            match chip.run(end) {
                Stop::Watched if chip.processor().pc() == handler => ticks += 1,
                Stop::Watched => return Some(ticks),
                _ => {}
            }
        }
        None
    };
    let schema = HOST_SCHEMA;
    send(chip, &HostRequest::Identify(Hello { schema })).unwrap();
    assert_eq!(until_read(chip, 10), None);
    send(chip, &HostRequest::Telemetry).unwrap();
    let ticks = until_read(chip, 10).unwrap();
    assert!(chip.processor().is_in_critical_section());
    chip.set_watching(false);
    while chip.hold_processor(MS) != Some(Stop::Converted) {}
    let tick = reply(chip, |reply| match reply {
        HostReply::Telemetry(report) => Some(report.telemetry.tick),
        _ => None,
    });
    assert_eq!(tick.unwrap(), ticks + 1);
}
