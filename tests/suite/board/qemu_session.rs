//! The firmware under QEMU, driven as the command `leg` drives it.

use leg_boards::image::FirmwareImage;
use leg_boards::qemu::{QemuClock, QemuConfig, QemuSession, describe_exit};
use leg_boards::setup;
use leg_firmware::host_link::{BoardKind, Hello};
use leg_firmware_bench::example;
use leg_firmware_bench::kernels::{self, Kernel};
use leg_firmware_bench::protocol::{
    BENCH_SCHEMA, EvaluateRequest, KernelRequest, Refusal, Reply, Request,
};
use leg_firmware_bench::query::QueryMessage;
use leg_model::RigParameters;
use leg_sim::link::{InProcess, Link, LinkError};
use rustix::process::{Pid, Signal, kill_process, test_kill_process};
use std::error::Error;
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::ExitStatus;
use std::thread;
use std::time::{Duration, Instant};

type Outcome = Result<(), Box<dyn Error>>;

fn config(clock: QemuClock) -> Result<QemuConfig, Box<dyn Error>> {
    let mut report = |what: &str| eprintln!("{what}");
    setup::ensure_target(&mut report)?;
    let qemu = setup::ensure_qemu(&mut report)?;
    Ok(QemuConfig {
        clock,
        ..QemuConfig::new(qemu, FirmwareImage::Qemu.build()?)
    })
}

fn kernel_request(kernel: Kernel) -> KernelRequest {
    KernelRequest {
        kernel,
        input: example::kernel_input(),
    }
}

fn evaluate_request(tilt_rad: f32) -> Request {
    Request::Evaluate(EvaluateRequest {
        rig: RigParameters::<f32, 3>::TABLE_1,
        query: QueryMessage {
            tilt_rad,
            ..example::query()
        },
    })
}

fn process(session: &QemuSession) -> Result<Pid, Box<dyn Error>> {
    let id = i32::try_from(session.process_id())?;
    Pid::from_raw(id).ok_or_else(|| "no process".into())
}

/// The directory of the session's pipes: QEMU's working directory.
fn directory(session: &QemuSession) -> Result<PathBuf, Box<dyn Error>> {
    Ok(fs::read_link(format!(
        "/proc/{}/cwd",
        session.process_id()
    ))?)
}

/// Neither the process nor the directory of a session is there any more.
fn assert_gone(id: Pid, directory: &Path) {
    assert!(test_kill_process(id).is_err(), "QEMU is still there");
    let left = directory.display();
    assert!(!directory.exists(), "{left} is still there");
}

#[test]
fn the_firmware_boots_and_ends_with_its_link() -> Outcome {
    let session = QemuSession::open(&config(QemuClock::Normal)?)?;
    let info = *session.info().ok_or("it has introduced itself")?;
    assert_eq!(info.board, BoardKind::Qemu);
    let boot = info.boot.ok_or("a board checks itself")?;
    assert!((1_000..1_100).contains(&boot.alarm_us), "{boot:?}");
    // On a busy machine the log comes after the introduction.
    let logged = || {
        session
            .log()
            .iter()
            .any(|line| line.contains("alarm of 1000 us took"))
    };
    let deadline = Instant::now() + Duration::from_secs(10);
    while !logged() && Instant::now() < deadline {
        thread::sleep(Duration::from_millis(10));
    }
    assert!(logged(), "{:?}", session.log());
    let (id, directory) = (process(&session)?, directory(&session)?);
    session.close()?;
    assert_gone(id, &directory);
    Ok(())
}

#[test]
fn a_dropped_session_leaves_nothing_behind() -> Outcome {
    let session = QemuSession::open(&config(QemuClock::Normal)?)?;
    let (id, directory) = (process(&session)?, directory(&session)?);
    drop(session);
    assert_gone(id, &directory);
    Ok(())
}

#[test]
fn the_core_computes_what_the_host_computes() -> Outcome {
    let mut qemu = QemuSession::open(&config(QemuClock::Normal)?)?;
    let mut host = InProcess::new();
    for step in -10_i8..=10 {
        let request = evaluate_request(f32::from(step) / 20.0);
        let reply = qemu.ask(&request)?;
        assert!(matches!(reply, Reply::Evaluation(_)), "{reply:?}");
        assert_eq!(reply, host.ask(&request)?);
    }
    for kernel in Kernel::ALL {
        let request = kernel_request(kernel);
        let output = kernels::run(kernel, &request.input)?;
        assert_eq!(
            qemu.ask(&Request::Run(request))?,
            Reply::Ran(output),
            "{kernel:?}"
        );
    }
    Ok(qemu.close()?)
}

#[test]
fn the_counting_clock_counts_and_repeats() -> Outcome {
    let config = config(QemuClock::Counting)?;
    let count = || -> Result<Vec<Reply>, LinkError> {
        let mut session = QemuSession::open(&config)?;
        let boot = session.info().and_then(|info| info.boot);
        assert_eq!(boot.map(|boot| boot.nops_counted), Some(100));
        let replies = Kernel::ALL
            .into_iter()
            .map(|kernel| session.ask(&Request::Count(kernel_request(kernel))))
            .collect();
        session.close()?;
        replies
    };
    let first = count()?;
    for (kernel, reply) in Kernel::ALL.into_iter().zip(&first) {
        assert!(
            matches!(reply, Reply::Counted(4..)),
            "{kernel:?}: {reply:?}"
        );
    }
    assert_eq!(count()?, first, "a second run counts the same");
    Ok(())
}

#[test]
fn the_normal_clock_and_the_host_do_not_count() -> Outcome {
    let request = Request::Count(kernel_request(Kernel::FullPass));
    let mut session = QemuSession::open(&config(QemuClock::Normal)?)?;
    assert_eq!(session.ask(&request)?, Reply::Refused(Refusal::NoCounter));
    assert_eq!(
        InProcess::new().ask(&request)?,
        Reply::Refused(Refusal::NoCounter)
    );
    Ok(())
}

#[test]
fn another_schema_is_refused_by_the_firmware() -> Outcome {
    let mut session = QemuSession::open(&config(QemuClock::Normal)?)?;
    let hello = Request::Hello(Hello { schema: [7; 8] });
    assert_eq!(
        session.ask(&hello)?,
        Reply::Refused(Refusal::SchemaMismatch {
            schema: BENCH_SCHEMA
        })
    );
    assert_eq!(
        session.ask(&evaluate_request(0.1))?,
        Reply::Refused(Refusal::NoHello)
    );
    Ok(())
}

#[test]
fn a_killed_emulator_is_described() -> Outcome {
    let mut session = QemuSession::open(&config(QemuClock::Normal)?)?;
    kill_process(process(&session)?, Signal::KILL)?;
    let Err(error) = session.ask(&evaluate_request(0.1)) else {
        return Err("a dead firmware does not answer".into());
    };
    assert!(matches!(error, LinkError::Died { .. }), "{error:?}");
    let text = error.to_string();
    assert!(
        text.starts_with("QEMU was ended by signal 9; start again, and with -v to see all of its log; its last lines were:\n  "),
        "{text}"
    );
    Ok(())
}

#[test]
fn a_stopped_emulator_times_out() -> Outcome {
    let mut session = QemuSession::open(&config(QemuClock::Normal)?)?;
    kill_process(process(&session)?, Signal::STOP)?;
    session.set_timeout(Duration::from_millis(500));
    let start = Instant::now();
    let Err(error) = session.ask(&evaluate_request(0.1)) else {
        return Err("a stopped firmware does not answer".into());
    };
    // Not the time-out that a boot has, 20 s.
    let waited = Duration::from_millis(500)..Duration::from_secs(15);
    assert!(waited.contains(&start.elapsed()));
    let text = error.to_string();
    assert!(
        text.starts_with("the firmware did not answer within 0.5 s; is the machine overloaded?"),
        "{text}"
    );
    Ok(())
}

#[test]
fn what_cannot_start_is_named() -> Outcome {
    let config = config(QemuClock::Normal)?;
    let no_image = QemuConfig {
        image: "/nowhere/leg-qemu".into(),
        ..config.clone()
    };
    assert_eq!(
        opening_error(&no_image),
        "there is no firmware image at /nowhere/leg-qemu; build it with `cargo image-qemu`"
    );
    let foreign_image = QemuConfig {
        image: config.qemu.clone(),
        ..config.clone()
    };
    let text = opening_error(&foreign_image);
    assert!(text.contains("is no image of this firmware"), "{text}");
    let no_qemu = QemuConfig {
        qemu: "/nowhere/qemu".into(),
        ..config.clone()
    };
    let text = opening_error(&no_qemu);
    assert!(
        text.starts_with("cannot start QEMU as `/nowhere/qemu`: "),
        "{text}"
    );
    let other_program = QemuConfig {
        qemu: "/bin/false".into(),
        ..config
    };
    assert_eq!(
        opening_error(&other_program),
        "QEMU failed (exit code 1); start again, and with -v to see all of its log"
    );
    Ok(())
}

fn opening_error(config: &QemuConfig) -> String {
    match QemuSession::open(config) {
        Ok(_) => "(it started)".to_owned(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn an_end_is_described() {
    let exited = |code: i32| describe_exit(ExitStatus::from_raw(code << 8));
    assert_eq!(
        exited(71),
        "the firmware took a hard fault; the log names the address (exit code 71)"
    );
    assert_eq!(exited(1), "QEMU failed (exit code 1)");
    assert_eq!(
        describe_exit(ExitStatus::from_raw(9)),
        "QEMU was ended by signal 9"
    );
}
