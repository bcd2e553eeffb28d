//! Promise 1 and 2: the precision table over the whole workspace, equal bits under QEMU, and a check that notices.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_bench::check::{self, CheckReport, CheckedState};
use leg_bench::precision::{PrecisionRow, TABLE};
use leg_firmware_bench::kernels::Kernel;
use leg_firmware_bench::protocol::{Reply, Request};
use leg_sim::link::{InProcess, Link, LinkError};
use std::process::Command;

/// The firmware's code with one fault.
struct Disturbed<F> {
    link: InProcess,
    fault: F,
}

impl<F: FnMut(&Request, &mut Reply)> Link for Disturbed<F> {
    fn ask(&mut self, request: &Request) -> Result<Reply, LinkError> {
        let mut reply = self.link.ask(request)?;
        (self.fault)(request, &mut reply);
        Ok(reply)
    }
}

fn check(link: &mut dyn Link, table: &[PrecisionRow], states: &[CheckedState]) -> CheckReport {
    check::run(link, table, states, || {}).unwrap()
}

/// The failures that a check of a faulty firmware names.
fn failures(fault: impl FnMut(&Request, &mut Reply)) -> Vec<String> {
    let link = InProcess::new();
    check(
        &mut Disturbed { link, fault },
        &TABLE,
        &check::random(300, 3),
    )
    .failures()
}

fn is_run_of(request: &Request, kernel: Kernel) -> bool {
    matches!(request, Request::Run(run) if run.kernel == kernel)
}

#[test]
fn the_table_passes_over_the_workspace_and_no_row_is_ten_times_too_wide() {
    let grid = check(&mut InProcess::new(), &TABLE, &check::grid());
    assert_eq!(grid.failures(), [""; 0], "{:#?}", grid.rows);
    let random = check::random(100_000, 2);
    let report = check(&mut InProcess::new(), &TABLE, &random);
    assert_eq!(report.failures(), [""; 0], "{:#?}", report.rows);
    for row in &report.rows {
        let tight = row.row.bound / 10.0;
        assert!(row.worst > tight, "{} is too wide", row.row.name);
    }
}

#[test]
fn a_row_that_nothing_was_compared_with_fails() {
    let report = check(&mut InProcess::new(), &TABLE, &[]);
    assert_eq!(report.failures().len(), TABLE.len());
}

#[test]
fn wrong_lengths_are_named() {
    let stretch = |_: &Request, reply: &mut Reply| {
        if let Reply::Evaluation(evaluation) = reply {
            evaluation.lengths_m = evaluation.lengths_m.map(|length| length * (1.0 + 1e-5));
        }
    };
    assert_eq!(failures(stretch), ["lengths", "bits of whole evaluation"]);
}

#[test]
fn the_printed_k2_in_place_of_the_exact_is_named() {
    let swap = |_: &Request, reply: &mut Reply| {
        if let Reply::Evaluation(evaluation) = reply {
            evaluation.stiffness_k2_exact_nm_per_rad = evaluation.stiffness_k2_printed_nm_per_rad;
        }
    };
    assert_eq!(failures(swap), ["K2, exact", "bits of whole evaluation"]);
}

#[test]
fn one_flipped_bit_of_any_kernel_is_named() {
    for kernel in Kernel::ALL {
        let flip = |request: &Request, reply: &mut Reply| {
            if let (true, Reply::Ran(numbers)) = (is_run_of(request, kernel), reply) {
                numbers[0] = f32::from_bits(numbers[0].to_bits() ^ 1);
            }
        };
        let bits = format!("bits of {}", kernel.name());
        assert!(failures(flip).contains(&bits), "{}", kernel.name());
    }
}

#[test]
fn the_sign_of_a_zero_is_a_bit() {
    let negate_zero = |_: &Request, reply: &mut Reply| {
        if let Reply::Evaluation(evaluation) = reply
            && evaluation.torsion_rad == 0.0
        {
            evaluation.torsion_rad = -evaluation.torsion_rad;
        }
    };
    assert_eq!(failures(negate_zero), ["bits of whole evaluation"]);
}

#[test]
fn a_firmware_that_refuses_a_pose_fails() {
    let refuse = |request: &Request, reply: &mut Reply| {
        if is_run_of(request, Kernel::SinCos) {
            *reply = Reply::Refused(leg_firmware_bench::protocol::Refusal::Model(
                leg_model::Error::NotConverged,
            ));
        }
    };
    assert_eq!(
        failures(refuse),
        ["sine and cosine", "bits of sine and cosine"]
    );
}

#[test]
fn a_number_that_is_none_fails() {
    let spoil = |request: &Request, reply: &mut Reply| {
        if let (true, Reply::Ran(numbers)) = (is_run_of(request, Kernel::SquareRoot), reply) {
            numbers[0] = f32::NAN;
        }
    };
    assert_eq!(failures(spoil), ["square root", "bits of square root"]);
}

#[test]
fn leg_check_passes_under_qemu() {
    let output = Command::new(env!("CARGO_BIN_EXE_leg-under-test"))
        .args(["check", "--json"])
        .output()
        .unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{message}");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["passed"], true);
    assert_eq!(report["rows"].as_array().unwrap().len(), TABLE.len());
    let runs = report["bits"]["runs"].as_u64().unwrap();
    assert!(runs >= 2_000 * Kernel::ALL.len() as u64, "{runs}");
}
