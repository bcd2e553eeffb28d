//! Requests of every kind that the firmware answers, for a fuzz target to damage.

use crate::framed;
use crate::host_requests::{self, commanded, identify, tick, ticks};
use leg_firmware::command::Command;
use leg_firmware::control::CYCLE_TICKS;
use leg_firmware::drive::Drive;
use leg_firmware::frame::MAX_PAYLOAD;
use leg_firmware::host_link::Hello;
use leg_firmware::host_link::HostRequest;
use leg_firmware::sensors::Sensors;
use leg_firmware::settings::Settings;
use leg_firmware_bench::example;
use leg_firmware_bench::kernels::Kernel;
use leg_firmware_bench::protocol::{
    BENCH_SCHEMA, BoardStep, EvaluateRequest, KernelRequest, Request, TickRequest,
};
use leg_model::RigParameters;
use serde::Serialize;

/// Ticks from the start until the leg can be armed, and some more.
const BOOT_TICKS: usize = 20;

/// The payloads that make a leg and arm it.
pub fn armed() -> Vec<Vec<u8>> {
    let mut requests = vec![
        Request::Hello(Hello {
            schema: BENCH_SCHEMA,
        }),
        Request::Start(settings()),
    ];
    let quiet = |ticks: usize| std::iter::repeat_with(|| tick(&[])).take(ticks);
    let ticks = hears(&identify())
        .into_iter()
        .chain(quiet(BOOT_TICKS))
        .chain(hears(&commanded(Command::Arm)))
        .chain(quiet(usize::from(CYCLE_TICKS)));
    requests.extend(ticks.map(Request::Tick));
    requests.iter().map(payload).collect()
}

/// The payload of each request.
pub fn requests() -> Vec<Vec<u8>> {
    let mut requests = vec![
        Request::Hello(Hello {
            schema: BENCH_SCHEMA,
        }),
        Request::Evaluate(evaluate()),
        Request::Start(settings()),
    ];
    requests.extend(Kernel::ALL.map(|kernel| Request::Run(run(kernel))));
    requests.push(Request::Count(run(Kernel::ModelTick)));
    for request in host_requests::every() {
        requests.extend(hears(&request).into_iter().map(Request::Tick));
    }
    let drive = Drive {
        duty: [0.5, -1.0, f32::NAN],
        enabled: true,
    };
    let sensors = Sensors {
        driver_fault: [false, true, false],
        ..Sensors::default()
    };
    let steps = [
        BoardStep::Read(sensors),
        BoardStep::Drive(drive),
        BoardStep::Cut,
    ];
    requests.extend(steps.map(Request::Board));
    let counted = hears(&commanded(Command::Hold));
    requests.extend(counted.into_iter().map(Request::CountTick));
    requests.iter().map(payload).collect()
}

pub(crate) fn payload<T: Serialize>(request: &T) -> Vec<u8> {
    let mut buffer = [0; MAX_PAYLOAD];
    let payload = postcard::to_slice(request, &mut buffer);
    payload.expect("the request fits").to_vec()
}

/// The ticks in which a leg hears a request.
fn hears(request: &HostRequest) -> Vec<TickRequest> {
    ticks(&framed(1, &payload(request)))
}

fn evaluate() -> EvaluateRequest {
    EvaluateRequest {
        rig: RigParameters::<f32, 3>::TABLE_1,
        query: example::query(),
    }
}

fn run(kernel: Kernel) -> KernelRequest {
    KernelRequest {
        kernel,
        input: example::kernel_input(),
    }
}

/// The paper's leg, its zero known, so that it can be armed.
pub(crate) fn settings() -> Settings {
    let mut settings = Settings::table_1().expect("they are built in");
    for axis in &mut settings.axes {
        axis.unstretched_at_zero_m = Some(0.0343);
    }
    settings
}

#[cfg(test)]
mod tests {
    use super::{armed, hears, payload, requests, settings};
    use crate::host_requests::{identify, ticks};
    use crate::{NoBoard, brought, feed, framed, host_requests};
    use leg_firmware::frame::{Decoder, MAX_FRAME};
    use leg_firmware::host_link::Hello;
    use leg_firmware::host_link::{HostRefusal, HostReply};
    use leg_firmware::recorder::Recorder;
    use leg_firmware::supervisor::State;
    use leg_firmware_bench::protocol::{BENCH_SCHEMA, Reply, Request};
    use leg_firmware_bench::server::Server;

    fn ask(server: &mut Server<NoBoard, Box<Recorder>>, payload: &[u8]) -> Reply {
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
        let mut server = Server::new(NoBoard, Box::default());
        for (number, payload) in requests().iter().enumerate() {
            let reply = ask(&mut server, payload);
            assert!(!matches!(reply, Reply::Refused(_)), "{number}: {reply:?}");
        }
    }

    /// What a leg says to its host in this tick.
    fn said(
        server: &mut Server<NoBoard, Box<Recorder>>,
        host: &mut Decoder,
        tick: &[u8],
    ) -> Vec<(u16, HostReply)> {
        let Reply::Ticked(ticked) = ask(server, tick) else {
            panic!("no tick")
        };
        let found = feed(host, &ticked.link).into_iter().map(|found| {
            let (number, payload) = found.expect("a good frame");
            (number, postcard::from_bytes(&payload).expect("a reply"))
        });
        found.collect()
    }

    /// The longest reply takes ten ticks, and there is telemetry in between.
    const REPLY_TICKS: usize = 60;

    /// One that the leg cannot read, or that it refuses for what is in it, would be a poor one to start from.
    #[test]
    fn every_request_of_a_host_is_read_by_the_leg() {
        let (mut server, mut host) = (Server::new(NoBoard, Box::default()), Decoder::new());
        let hello = Request::Hello(Hello {
            schema: BENCH_SCHEMA,
        });
        ask(&mut server, &payload(&hello));
        ask(&mut server, &payload(&Request::Start(settings())));
        let [quiet] = ticks(&[0]).try_into().expect("one tick");
        let quiet = vec![payload(&Request::Tick(quiet)); REPLY_TICKS];
        for tick in hears(&identify()) {
            said(&mut server, &mut host, &payload(&Request::Tick(tick)));
        }
        for (number, request) in (100..).zip(host_requests()) {
            let ticks = [brought(number, &request), quiet.clone()].concat();
            let mut replies = ticks
                .iter()
                .flat_map(|tick| said(&mut server, &mut host, tick));
            let (_, reply) = replies
                .find(|(told, _)| *told == number)
                .expect("it is answered");
            let obeyed_or_not = match reply {
                HostReply::Refused(refusal) => matches!(refusal, HostRefusal::Command(_)),
                _ => true,
            };
            assert!(obeyed_or_not, "{request:?}: {reply:?}");
        }
    }

    #[test]
    fn an_armed_leg_follows_commands() {
        let mut server = Server::new(NoBoard, Box::default());
        let replies: Vec<Reply> = armed().iter().map(|p| ask(&mut server, p)).collect();
        let Some(Reply::Ticked(tick)) = replies.last() else {
            panic!("{replies:?}")
        };
        assert_eq!(tick.telemetry.state, State::Active, "{tick:?}");
    }
}
