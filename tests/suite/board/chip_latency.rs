//! How late the control interrupt may be, while a host talks by either line and settings are kept.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::chip::{
    LatencyMeter, MS, identity, image, other_settings, send, started_with, vary_cells,
};
use crate::common::chip_bus::{ChipBus, ChipBusPort};
use leg_boards::chip::LATENCY_CYCLES_MAX;
use leg_boards::image::FirmwareImage;
use leg_firmware::can::{Identifier, LegAddress, Segmenter};
use leg_firmware::command::Command;
use leg_firmware::frame::{self, Decoder, MAX_FRAME};
use leg_firmware::host_link::{HostRefusal, HostReply, HostRequest};
use leg_firmware::recorder::RecorderRequest;
use leg_firmware::supervisor::State;
use leg_host::cancel_flag::CancelFlag;
use leg_host::operator::{HostIdentity, Operator};
use leg_host::transport::can::CanTransport;
use std::path::Path;
use stm32g474_emulator::board::Board;
use stm32g474_emulator::chip::Chip;
use stm32g474_emulator::image::Image;

/// How often the host saves on the serial line: with one record in a page, a save erases.
const SAVES: usize = 3;

/// The longest that a request on the serial line takes, ms.
const REPLY_MS: u64 = 200;

/// How often the host asks on CAN; it saves every twentieth time.
const ROUNDS: u64 = 60;

/// Commands on CAN one after another: more than the leg's queue holds, faster than its cycles execute them.
const FLOOD: u16 = 24;

/// When something else follows the commands, µs after the first: from the first refusal for want of room on, at places of
/// the cycle that differ.
const FLOOD_US: [u64; 6] = [900, 1_100, 1_300, 1_500, 1_700, 1_900];

/// What follows has been sent and obeyed by then, µs.
const FLOOD_END_US: u64 = 10_000;

fn commanded(command: Command) -> HostRequest {
    let host = HostIdentity::FIXED.id;
    HostRequest::Command { host, command }
}

/// One command of each kind, with zeros in it.
fn every_command() -> impl Iterator<Item = Command> {
    (0..).map_while(|kind| {
        let mut bytes = [0; MAX_FRAME];
        bytes[0] = kind;
        postcard::from_bytes(&bytes).ok()
    })
}

/// Asks a leg at rest for something, and measures until the reply.
fn ask(chip: &mut Chip, meter: &mut LatencyMeter, request: &HostRequest) -> HostReply {
    ask_with_cells(chip, meter, request, vary_cells)
}

/// Asks for something, and measures until the reply; `cells` sets what the load cells show meanwhile.
fn ask_with_cells(
    chip: &mut Chip,
    meter: &mut LatencyMeter,
    request: &HostRequest,
    cells: impl Fn(&Chip),
) -> HostReply {
    send(chip, request).unwrap();
    let mut decoder = Decoder::new();
    let end = chip.cycle() + REPLY_MS * MS;
    while chip.cycle() < end {
        cells(chip);
        meter.run(chip, chip.cycle() + MS / 2);
        while let Some(sent) = chip.peripherals().devices.lpuart.host_receive() {
            // What the leg sends by itself has the number 0.
            if let Some(Ok(frame)) = decoder.push(sent.byte)
                && frame.sequence != 0
            {
                return frame.message().unwrap();
            }
        }
    }
    panic!("no reply to {request:?}")
}

/// The latest on the serial line, cycles.
fn serial_latency(image: &Path) -> (u64, u32) {
    let mut session = started_with(image, Board::default(), 10).unwrap();
    let chip = session.chip().unwrap();
    identity(chip).unwrap();
    let mut meter = LatencyMeter::new().unwrap();
    let save = vec![HostRequest::SaveSettings; SAVES];
    let settings = HostRequest::SetSettings(other_settings().unwrap());
    for request in [HostRequest::Stream(1), settings].into_iter().chain(save) {
        let reply = ask(chip, &mut meter, &request);
        assert_eq!(reply, HostReply::Done, "{request:?}");
    }
    let questions = [
        HostRequest::Sensors,
        HostRequest::JogReport,
        HostRequest::GetSettings,
    ];
    let recorder = [
        RecorderRequest::Report,
        RecorderRequest::Stop,
        RecorderRequest::Read(30),
        RecorderRequest::Restart,
    ];
    let questions = questions
        .into_iter()
        .chain(recorder.map(HostRequest::Recorder));
    for request in every_command().map(commanded).chain(questions) {
        let reply = ask(chip, &mut meter, &request);
        let refused = HostReply::Refused(HostRefusal::NotIdentified);
        assert_ne!(reply, refused, "{request:?}");
        assert_ne!(
            reply,
            HostReply::Refused(HostRefusal::Recording),
            "{request:?}"
        );
    }
    meter.worst
}

/// The latest on the serial line of a leg that is driven, while a host reads its telemetry and commands it.
pub fn driven_latency(chip: &mut Chip) -> (u64, u32) {
    identity(chip).unwrap();
    let mut meter = LatencyMeter::new().unwrap();
    // The sensors' codes stay what they were: the leg has not noticed yet.
    let mut ask = |request: &HostRequest| ask_with_cells(chip, &mut meter, request, |_| ());
    for _ in 0..2 {
        let HostReply::Telemetry(report) = ask(&HostRequest::Telemetry) else {
            panic!("no telemetry")
        };
        assert_eq!(report.telemetry.state, State::Active);
        assert_eq!(
            ask(&HostRequest::SaveSettings),
            HostReply::Refused(HostRefusal::Driven)
        );
        assert_eq!(ask(&commanded(Command::KeepAlive)), HostReply::Done);
    }
    meter.worst
}

/// The longest on the serial line, on CAN, and where commands wait, cycles, and the function in which it ends.
pub fn latest(image: &Path) -> [(u64, String); 3] {
    let parsed = Image::parse(&std::fs::read(image).unwrap()).unwrap();
    [
        serial_latency(image),
        can_latency(image),
        flood_latency(image),
    ]
    .map(|(cycles, place)| {
        let function = parsed.function_at(place).unwrap_or("no function");
        (cycles, function.to_owned())
    })
}

/// The latest on CAN.
fn can_latency(image: &Path) -> (u64, u32) {
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

/// The latest where so many commands wait that one of them finds no room, and a stop or new settings end them all.
fn flood_latency(image: &Path) -> (u64, u32) {
    let leg = LegAddress::ALL[0];
    let bus = ChipBus::new(image, &[leg]).unwrap();
    let line = Box::new(CanTransport::new(ChipBusPort::attach(&bus), leg));
    Operator::open(line, HostIdentity::FIXED, CancelFlag::default()).unwrap();
    let mut ordinary = Segmenter::new(Identifier::ToLeg(leg));
    let mut urgent = Segmenter::new(Identifier::Urgent(leg));
    let send = |segmenter: &mut Segmenter, number, request: &HostRequest| {
        let mut out = [0; MAX_FRAME];
        let link_frame = frame::encode(number, request, &mut out).unwrap();
        for segment in segmenter.segments(link_frame).unwrap() {
            bus.borrow_mut().send(segment);
        }
    };
    let settings = HostRequest::SetSettings(other_settings().unwrap());
    for after_us in FLOOD_US {
        for (ending, is_urgent) in [(&commanded(Command::Stop), true), (&settings, false)] {
            for number in 0..FLOOD {
                send(&mut ordinary, number + 1, &commanded(Command::KeepAlive));
            }
            bus.borrow_mut().pass(after_us);
            let segmenter = if is_urgent {
                &mut urgent
            } else {
                &mut ordinary
            };
            send(segmenter, FLOOD + 1, ending);
            bus.borrow_mut().pass(FLOOD_END_US);
        }
    }
    bus.borrow().worst_latency()
}

#[test]
fn nothing_delays_the_control_interrupt_for_longer_than_is_allowed() {
    let image = image(FirmwareImage::Stm32g474).unwrap();
    let latest = latest(&image);
    eprintln!(
        "latest control interrupt by serial line, by CAN and where commands wait, cycles: {latest:?}"
    );
    assert!(
        latest
            .iter()
            .all(|(cycles, _)| *cycles <= LATENCY_CYCLES_MAX),
        "{latest:?}"
    );
}
