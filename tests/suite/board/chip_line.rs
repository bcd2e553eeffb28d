//! The chip's serial line with more to say than it takes.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::chip::{
    MS, carry_out, findings, identity, image, reset_within, send, started_with,
};
use leg_boards::image::FirmwareImage;
use leg_firmware::host_link::HostRequest;
use stm32g474_emulator::board::Board;

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
