//! What a user's host asks the leg, for a fuzz target to damage, and the ticks that bring it there.

use crate::framed;
use crate::requests::{payload, settings};
use leg_firmware::command::{Command, Compensation};
use leg_firmware::frame::MAX_PAYLOAD;
use leg_firmware::host_link::HostRequest;
use leg_firmware::host_link::{HOST_SCHEMA, Hello};
use leg_firmware::jog::{JogDemand, JogDrive};
use leg_firmware::linked_leg::LINK_BYTES_MAX;
use leg_firmware::recorder::RecorderRequest;
use leg_firmware::sensors::{CODE_MAX, Sensors};
use leg_firmware::set_point::{SetPoint, StreamPart, StreamTension};
use leg_firmware_bench::protocol::{Request, TickRequest};
use std::mem::discriminant;

/// Every request of a user's host; those that have no example here with zeros in them.
pub(crate) fn every() -> Vec<HostRequest> {
    let mut requests = vec![
        identify(),
        HostRequest::Telemetry,
        HostRequest::Stream(1),
        HostRequest::Sensors,
        HostRequest::GetSettings,
        HostRequest::SaveSettings,
        HostRequest::SetSettings(settings()),
    ];
    requests.extend(RECORDER.map(HostRequest::Recorder));
    requests.extend(COMMANDS.map(commanded));
    let known: Vec<_> = requests.iter().map(discriminant).collect();
    requests.extend(zeros().filter(|request| !known.contains(&discriminant(request))));
    requests
}

/// One request of every kind with nothing but zeros in it.
fn zeros() -> impl Iterator<Item = HostRequest> {
    let request = |kind| {
        let mut bytes = [0; MAX_PAYLOAD];
        bytes[0] = kind;
        postcard::from_bytes(&bytes).ok()
    };
    (0..).map_while(request)
}

const RECORDER: [RecorderRequest; 5] = [
    RecorderRequest::Report,
    RecorderRequest::Stop,
    RecorderRequest::Read(0),
    RecorderRequest::Read(1000),
    RecorderRequest::Restart,
];

const COMMANDS: [Command; 17] = [
    Command::KeepAlive,
    Command::Arm,
    Command::Home,
    Command::Move { x: 0.2, y: -0.1 },
    Command::Follow(SetPoint {
        part: StreamPart::First,
        tick: 4000,
        direction: [0.01, 0.0],
        rate: [0.1, 0.0],
        acceleration: Some([0.0, 0.5]),
        tension: Some(StreamTension::Stiffness(50.0)),
    }),
    Command::Follow(SetPoint {
        part: StreamPart::Next,
        tick: 4080,
        direction: [0.011, 0.0],
        rate: [0.1, 0.0],
        acceleration: None,
        tension: None,
    }),
    Command::Jog(JogDemand {
        motor: 1,
        travel_m: 1e-3,
        drive: JogDrive::Voltage(2.0),
    }),
    Command::Jog(JogDemand {
        motor: 1,
        travel_m: 1e-3,
        drive: JogDrive::ServoSine {
            speed_m_per_s: 2e-3,
            amplitude_v: 0.3,
            period_ticks: 100,
        },
    }),
    Command::Hold,
    Command::Pretension(60.0),
    Command::Stiffness {
        demand_nm_per_rad: 60.0,
        towards: Some([1.0, 0.0]),
    },
    Command::Compensation(Compensation::Off),
    Command::Compensation(Compensation::Frozen),
    Command::Stop,
    Command::Disarm,
    Command::Clear,
    Command::KeepStation,
];

pub(crate) fn identify() -> HostRequest {
    HostRequest::Identify(Hello {
        schema: HOST_SCHEMA,
    })
}

pub(crate) fn commanded(command: Command) -> HostRequest {
    HostRequest::Command { host: 1, command }
}

/// The payload of each request of a user's host.
pub fn host_requests() -> Vec<Vec<u8>> {
    every().iter().map(payload).collect()
}

/// The payloads of the ticks that bring the leg a good frame with this payload.
pub fn brought(sequence: u16, host_payload: &[u8]) -> Vec<Vec<u8>> {
    let ticks = ticks(&framed(sequence, host_payload)).into_iter();
    ticks.map(|tick| payload(&Request::Tick(tick))).collect()
}

/// A quiet leg at 70 N, 24 V and 25 °C, which hears these bytes in as many ticks as they take.
pub(crate) fn ticks(bytes: &[u8]) -> Vec<TickRequest> {
    bytes.chunks(LINK_BYTES_MAX).map(tick).collect()
}

/// One tick of that leg, in which it hears these bytes.
pub(crate) fn tick(bytes: &[u8]) -> TickRequest {
    TickRequest {
        sensors: Sensors {
            cell_codes: [23_590; 3],
            current_codes: [CODE_MAX / 2; 3],
            supply_code: 43_680,
            temperature_code: 21_294,
            cell_fresh: [true; 3],
            ..Sensors::default()
        },
        link: bytes.iter().copied().collect(),
    }
}
