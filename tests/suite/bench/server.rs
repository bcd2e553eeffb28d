//! The server of the test bench: each request has one reply, whatever comes.

use leg_firmware::frame::{Decoder, FrameError, MAX_FRAME, encode};
use leg_firmware::host_link::{BoardKind, Hello};
use leg_firmware::recorder::Recorder;
use leg_firmware::settings::Settings;
use leg_firmware_bench::counter::InstructionCounter;
use leg_firmware_bench::example;
use leg_firmware_bench::exit::Exit;
use leg_firmware_bench::kernels::{self, Kernel, KernelInput};
use leg_firmware_bench::protocol::{
    BENCH_SCHEMA, BoardInfo, EvaluateRequest, KernelRequest, Refusal, Reply, Request,
};
use leg_firmware_bench::query::QueryMessage;
use leg_firmware_bench::server::{BenchBoard, Server};
use leg_model::{Error, Quantity, Reason, RigParameters};

/// Counts every kernel as as many instructions as it is told, or nothing.
struct Bench {
    instructions: Option<u32>,
}

const INFO: BoardInfo = BoardInfo {
    board: BoardKind::InProcess,
    boot: None,
};

impl InstructionCounter for Bench {
    fn count<A, B>(&mut self, kernel: fn(&A, &mut B), input: &A, output: &mut B) -> Option<u32> {
        let instructions = self.instructions?;
        kernel(input, output);
        Some(instructions)
    }
}

impl BenchBoard for Bench {
    fn info(&self) -> BoardInfo {
        INFO
    }

    fn save(&mut self, _settings: &Settings) -> bool {
        true
    }
}

fn server(instructions: Option<u32>) -> Server<Bench, Box<Recorder>> {
    Server::new(Bench { instructions }, Box::default())
}

/// Sends bytes and returns the sequence and the message of the only reply.
fn exchange(server: &mut Server<Bench, Box<Recorder>>, bytes: &[u8]) -> (u16, Reply) {
    let (mut requests, mut replies) = (Decoder::new(), Decoder::new());
    let mut out = [0; MAX_FRAME];
    let mut found = Vec::new();
    for &byte in bytes {
        let Some(request) = requests.push(byte) else {
            continue;
        };
        let Ok(reply) = server.answer(request, &mut out) else {
            panic!("every reply fits")
        };
        for &byte in reply {
            if let Some(Ok(frame)) = replies.push(byte) {
                found.push((frame.sequence, frame.message::<Reply>()));
            }
        }
    }
    match found.as_slice() {
        [(sequence, Some(reply))] => (*sequence, reply.clone()),
        other => panic!("not one reply: {other:?}"),
    }
}

fn framed(request: &Request) -> Vec<u8> {
    let mut out = [0; MAX_FRAME];
    match encode(77, request, &mut out) {
        Ok(frame) => frame.to_vec(),
        Err(error) => panic!("{error}"),
    }
}

fn ask(server: &mut Server<Bench, Box<Recorder>>, request: &Request) -> Reply {
    let (sequence, reply) = exchange(server, &framed(request));
    assert_eq!(sequence, 77);
    reply
}

fn hello(schema: [u8; 8]) -> Request {
    Request::Hello(Hello { schema })
}

fn greeted(instructions: Option<u32>) -> Server<Bench, Box<Recorder>> {
    let mut server = server(instructions);
    assert_eq!(ask(&mut server, &hello(BENCH_SCHEMA)), Reply::Hello(INFO));
    server
}

fn kernel_request(payload_kg: f32) -> KernelRequest {
    KernelRequest {
        kernel: Kernel::FullPass,
        input: KernelInput {
            payload_kg,
            ..example::kernel_input()
        },
    }
}

fn evaluate_request(tilt_rad: f32) -> EvaluateRequest {
    EvaluateRequest {
        rig: RigParameters::<f32, 3>::TABLE_1,
        query: QueryMessage {
            tilt_rad,
            ..example::query()
        },
    }
}

#[test]
fn nothing_is_done_before_hello() {
    for request in [
        Request::Evaluate(evaluate_request(0.1)),
        Request::Run(kernel_request(1.0)),
        Request::Count(kernel_request(1.0)),
    ] {
        assert_eq!(
            ask(&mut server(Some(5)), &request),
            Reply::Refused(Refusal::NoHello)
        );
    }
}

#[test]
fn another_schema_is_refused_and_takes_the_greeting_back() {
    let mut server = greeted(None);
    assert_eq!(
        ask(&mut server, &hello([7; 8])),
        Reply::Refused(Refusal::SchemaMismatch {
            schema: BENCH_SCHEMA
        })
    );
    assert_eq!(
        ask(&mut server, &Request::Run(kernel_request(1.0))),
        Reply::Refused(Refusal::NoHello)
    );
}

#[test]
fn an_evaluation_is_the_models() {
    let request = evaluate_request(0.3);
    let query = request.query.query();
    let model =
        query.and_then(|query| leg_model::evaluate(&RigParameters::<f32, 3>::TABLE_1, &query));
    assert_eq!(
        Ok(ask(&mut greeted(None), &Request::Evaluate(request))),
        model.map(Reply::Evaluation)
    );
}

#[test]
fn the_models_refusal_is_passed_on() {
    assert_eq!(
        ask(
            &mut greeted(None),
            &Request::Evaluate(evaluate_request(f32::NAN))
        ),
        Reply::Refused(Refusal::Model(Error::Refused {
            quantity: Quantity::Tilt,
            reason: Reason::NotFinite
        }))
    );
}

#[test]
fn a_kernel_runs() {
    let request = kernel_request(1.0);
    assert_eq!(
        Ok(ask(&mut greeted(None), &Request::Run(request.clone()))),
        kernels::run(request.kernel, &request.input).map(Reply::Ran)
    );
}

#[test]
fn counting_takes_a_counter_and_a_kernel_that_works() {
    let count = |instructions, payload_kg| {
        let request = Request::Count(kernel_request(payload_kg));
        ask(&mut greeted(instructions), &request)
    };
    assert_eq!(count(Some(340), 1.0), Reply::Counted(340));
    assert_eq!(count(None, 1.0), Reply::Refused(Refusal::NoCounter));
    assert!(matches!(
        count(Some(340), f32::NAN),
        Reply::Refused(Refusal::Model(_))
    ));
}

#[test]
fn a_damaged_frame_is_answered_with_sequence_zero() {
    let mut bytes = framed(&hello(BENCH_SCHEMA));
    bytes[1] ^= 1;
    assert_eq!(
        exchange(&mut server(None), &bytes),
        (0, Reply::Refused(Refusal::BadFrame(FrameError::BadCrc)))
    );
}

#[test]
fn a_whole_frame_without_a_request_is_a_bad_request() {
    let mut out = [0; MAX_FRAME];
    let Ok(frame) = encode(5, &u64::MAX, &mut out) else {
        panic!("eight bytes fit")
    };
    assert_eq!(
        exchange(&mut server(None), frame),
        (5, Reply::Refused(Refusal::BadRequest))
    );
}

#[test]
fn each_code_stands_for_one_end() {
    for exit in Exit::ALL {
        assert_eq!(Exit::from_code(exit.code()), Some(exit));
    }
    assert_eq!(Exit::from_code(1), None, "QEMU's own failures end with 1");
}
