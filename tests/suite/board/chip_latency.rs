//! How late the control interrupt may be, while a host talks by either line and settings are kept.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::chip::{
    LatencyMeter, MS, image, other_settings, send, started_with, vary_cells,
};
use crate::common::chip_bus::{ChipBus, ChipBusPort};
use leg_boards::chip::LATENCY_CYCLES_MAX;
use leg_boards::image::FirmwareImage;
use leg_firmware::can::LegAddress;
use leg_firmware::host_link::HostRequest;
use leg_host::cancel_flag::CancelFlag;
use leg_host::operator::{HostIdentity, Operator};
use leg_host::transport::can::CanTransport;
use std::path::Path;
use stm32g474_emulator::board::Board;
use stm32g474_emulator::image::Image;

/// How often the host asks on the serial line, once in a millisecond.
const TALK_MS: u64 = 120;

/// How often the host asks on CAN; it saves every twentieth time: with two records in a page, some saves erase.
const ROUNDS: u64 = 60;

/// The latest on the serial line, cycles.
fn by_serial(image: &Path) -> (u64, u32) {
    let mut session = started_with(image, Board::default(), 10).unwrap();
    let chip = session.chip().unwrap();
    let mut meter = LatencyMeter::new().unwrap();
    let settings = other_settings().unwrap();
    for ms in 0..TALK_MS {
        send(chip, &HostRequest::Telemetry).unwrap();
        let request = match ms {
            5 => Some(HostRequest::SetSettings(settings.clone())),
            30 | 60 | 90 => Some(HostRequest::SaveSettings),
            _ => None,
        };
        if let Some(request) = request {
            send(chip, &request).unwrap();
        }
        vary_cells(chip);
        meter.run(chip, chip.cycle() + MS);
    }
    meter.worst
}

/// The longest on either line, cycles, and the function in which it ends.
pub fn latest(image: &Path) -> [(u64, String); 2] {
    let parsed = Image::parse(&std::fs::read(image).unwrap()).unwrap();
    [by_serial(image), by_can(image)].map(|(cycles, place)| {
        let function = parsed.function_at(place).unwrap_or("no function");
        (cycles, function.to_owned())
    })
}

/// The latest on CAN.
fn by_can(image: &Path) -> (u64, u32) {
    let leg = LegAddress::ALL[0];
    let bus = ChipBus::new(image, &[leg]).unwrap();
    let line = Box::new(CanTransport::new(ChipBusPort::attach(&bus), leg));
    let mut host = Operator::open(line, HostIdentity::FIXED, CancelFlag::default()).unwrap();
    host.set_settings(&other_settings().unwrap()).unwrap();
    for round in 0..ROUNDS {
        host.telemetry().unwrap();
        bus.borrow_mut().pass(13 * (round % 10));
        if round % 20 == 0 {
            host.save_settings().unwrap();
        }
    }
    bus.borrow().worst_latency()
}

#[test]
fn nothing_delays_the_control_interrupt_for_longer_than_is_allowed() {
    let image = image(FirmwareImage::Stm32g474).unwrap();
    let latest = latest(&image);
    eprintln!("latest control interrupt by serial line and CAN, cycles: {latest:?}");
    assert!(
        latest
            .iter()
            .all(|(cycles, _)| *cycles <= LATENCY_CYCLES_MAX),
        "{latest:?}"
    );
}
