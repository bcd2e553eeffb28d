//! Requests of every kind that the firmware answers, for a fuzz target to damage.

use leg_firmware::command::Command;
use leg_firmware::frame::{MAX_FRAME, MAX_PAYLOAD, encode};
use leg_firmware::host_link::HostRequest;
use leg_firmware::kernels::{Kernel, KernelInput};
use leg_firmware::messages::{QueryMessage, SupportMessage, TendonMessage, TendonsMessage};
use leg_firmware::protocol::{EvaluateRequest, Hello, KernelRequest, Request, SCHEMA, TickRequest};
use leg_firmware::sensors::{CODE_MAX, Sensors};
use leg_firmware::settings::Settings;
use leg_model::{JointStiffness, RigParameters, StiffnessAt, SupportKind};

const TENSION_FLOOR_N: f32 = 8.0;
const TENSION_CEILING_N: f32 = 150.0;
const LEVEL_N: f32 = 70.0;
const TENDONS: TendonsMessage = TendonsMessage::Alike(TendonMessage::Constant(1e5));

/// Ticks from the start until the leg can be armed, and some more.
const BOOT_TICKS: usize = 20;

/// The payloads that make a leg and arm it.
pub fn armed() -> Vec<Vec<u8>> {
    let mut requests = vec![
        Request::Hello(Hello { schema: SCHEMA }),
        Request::Start(settings()),
        Request::Tick(identify()),
    ];
    let ticks = std::iter::repeat_n(Request::Tick(tick(&Command::KeepAlive)), BOOT_TICKS);
    requests.extend(ticks);
    requests.push(Request::Tick(tick(&Command::Arm)));
    requests.iter().map(payload).collect()
}

/// The payload of each request.
pub fn requests() -> Vec<Vec<u8>> {
    let commands = [
        Command::KeepAlive,
        Command::Arm,
        Command::Home,
        Command::Move { x: 0.2, y: -0.1 },
        Command::Stiffness {
            demand_nm_per_rad: 60.0,
            towards: Some([1.0, 0.0]),
        },
        Command::Stop,
        Command::Clear,
    ];
    let mut requests = vec![
        Request::Hello(Hello { schema: SCHEMA }),
        Request::Evaluate(evaluate()),
        Request::Start(settings()),
        Request::Tick(identify()),
        Request::Tick(hears(&HostRequest::Telemetry)),
        Request::Tick(hears(&HostRequest::Stream(1))),
        Request::Tick(hears(&HostRequest::Sensors)),
        Request::Tick(hears(&HostRequest::GetSettings)),
        Request::Tick(hears(&HostRequest::SaveSettings)),
    ];
    requests.extend(Kernel::ALL.map(|kernel| Request::Run(run(kernel))));
    requests.push(Request::Count(run(Kernel::ModelTick)));
    requests.extend(commands.map(|command| Request::Tick(tick(&command))));
    requests.push(Request::CountTick(tick(&Command::Hold)));
    requests.iter().map(payload).collect()
}

fn payload(request: &Request) -> Vec<u8> {
    let mut buffer = [0; MAX_PAYLOAD];
    let payload = postcard::to_slice(request, &mut buffer);
    payload.expect("the request fits").to_vec()
}

fn support() -> SupportMessage {
    SupportMessage {
        kind: SupportKind::TorsionFree,
        joint: JointStiffness::none(),
    }
}

fn evaluate() -> EvaluateRequest {
    EvaluateRequest {
        rig: RigParameters::<f32, 3>::TABLE_1.into(),
        query: QueryMessage {
            azimuth_rad: 0.5,
            tilt_rad: 0.3,
            payload_kg: 1.0,
            level_n: LEVEL_N,
            tension_floor_n: TENSION_FLOOR_N,
            tension_ceiling_n: TENSION_CEILING_N,
            tendons: TENDONS,
            stiffness_at: StiffnessAt::Pretension,
            support: support(),
            demand: None,
        },
    }
}

fn run(kernel: Kernel) -> KernelRequest {
    KernelRequest {
        kernel,
        input: KernelInput {
            rig: RigParameters::<f32, 3>::TABLE_1.into(),
            azimuth_rad: 0.5,
            tilt_rad: 0.3,
            start_azimuth_rad: 0.5,
            start_tilt_rad: 0.3,
            length_errors_m: [0.0; 3],
            payload_kg: 1.0,
            level_n: LEVEL_N,
            tension_floor_n: TENSION_FLOOR_N,
            tension_ceiling_n: TENSION_CEILING_N,
            stiffness_n_per_m: 1e5,
            demand_nm_per_rad: 100.0,
        },
    }
}

/// The paper's leg, its zero known, so that it can be armed.
fn settings() -> Settings {
    let mut settings = Settings::for_table_1().expect("they are built in");
    for axis in &mut settings.axes {
        axis.unstretched_at_zero_m = Some(0.0343);
    }
    settings
}

fn identify() -> TickRequest {
    hears(&HostRequest::Identify(Hello { schema: SCHEMA }))
}

/// A quiet leg at 70 N, 24 V and 25 °C, which gets a command.
fn tick(command: &Command) -> TickRequest {
    hears(&HostRequest::Command {
        host: 1,
        command: *command,
    })
}

/// The same, which hears anything of its host.
fn hears(request: &HostRequest) -> TickRequest {
    let mut out = [0; MAX_FRAME];
    let frame = encode(1, request, &mut out).expect("it fits");
    TickRequest {
        sensors: Sensors {
            cell_codes: [23_590; 3],
            current_codes: [CODE_MAX / 2; 3],
            supply_code: 43_680,
            temperature_code: 21_294,
            cell_fresh: [true; 3],
            ..Sensors::default()
        },
        link: heapless::Vec::from_slice(frame).expect("it takes less than a tick's bytes"),
    }
}

#[cfg(test)]
mod tests {
    use super::{armed, requests};
    use crate::{NoBoard, feed, framed};
    use leg_firmware::frame::{Decoder, MAX_FRAME};
    use leg_firmware::protocol::Reply;
    use leg_firmware::server::Server;
    use leg_firmware::supervisor::State;

    fn ask(server: &mut Server<NoBoard>, payload: &[u8]) -> Reply {
        let mut decoder = Decoder::new();
        let mut out = [0; MAX_FRAME];
        for byte in framed(1, payload) {
            let Some(request) = decoder.push(byte) else {
                continue;
            };
            let answer = server.answer(request, &mut out).expect("the reply fits");
            let found = feed(&mut Decoder::new(), answer);
            let [Ok((_, payload))] = found.as_slice() else {
                panic!("{found:?}")
            };
            return postcard::from_bytes(payload).expect("a reply");
        }
        panic!("no reply")
    }

    /// A request that is refused would be a poor one to start from.
    #[test]
    fn every_request_is_done() {
        let mut server = Server::new(NoBoard);
        for (number, payload) in requests().iter().enumerate() {
            let reply = ask(&mut server, payload);
            assert!(!matches!(reply, Reply::Refused(_)), "{number}: {reply:?}");
        }
    }

    #[test]
    fn an_armed_leg_follows_commands() {
        let mut server = Server::new(NoBoard);
        let replies: Vec<Reply> = armed().iter().map(|p| ask(&mut server, p)).collect();
        let Some(Reply::Ticked(tick)) = replies.last() else {
            panic!("{replies:?}")
        };
        assert_eq!(tick.telemetry.state, State::Active, "{tick:?}");
    }
}
