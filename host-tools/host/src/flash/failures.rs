//! Why a board was not flashed, by the texts of probe-rs.

use super::CHIP;
use leg_base::failure::Failure;
use std::io;
use std::process::Output;

/// The meaning of the output of a run that failed: probe-rs has no exit codes or JSON for it.
pub(super) fn output_failure(output: &Output) -> Failure {
    let text = output_text(output);
    let lower_case = text.to_lowercase();
    let has = |parts: &[&str]| parts.iter().any(|part| lower_case.contains(part));
    if has(&["no connected probes", "probe not found"]) {
        Failure::refused(
            "probe-rs finds no debugger",
            "plug the board in at its ST-LINK connector with a cable that carries data; on Linux allow its use: \
             https://probe.rs/docs/getting-started/probe-setup/",
        )
    } else if has(&["probes were found"]) {
        Failure::refused(
            "several debuggers are plugged in",
            "name one with --probe; `probe-rs list` shows them",
        )
    } else if has(&["verification failed"]) {
        Failure::failed(
            "the flash does not hold what was written",
            "flash again; if it stays, the chip's flash is worn out",
        )
    } else if has(&["failed to open", "probe could not be created"]) {
        Failure::refused(
            format!("the debugger cannot be opened: {text}"),
            "end other programs that use the debugger; on Linux allow its use: \
             https://probe.rs/docs/getting-started/probe-setup/",
        )
    } else if has(&["lockedup", "locked up"]) {
        Failure::refused(
            format!("the chip's processor is locked up: {text}"),
            "reset the board, then flash again",
        )
    } else if has(&["not found in the database", "unable to load specification"]) {
        Failure::refused(
            format!("this probe-rs does not know the {CHIP}"),
            "install a newer one: `cargo install probe-rs-tools --locked`",
        )
    } else if has(&["connecting to the chip"]) {
        Failure::refused(
            format!("the debugger reaches no chip: {text}"),
            "see that the board is powered and its ST-LINK jumpers are set",
        )
    } else {
        failed(&text)
    }
}

/// Anything else that probe-rs says.
pub(super) fn failed(text: &str) -> Failure {
    Failure::refused(
        format!("probe-rs failed: {text}"),
        "run `probe-rs info` to see what it reaches",
    )
}

pub(super) fn not_started(error: io::Error) -> Failure {
    Failure::refused(
        format!("cannot start probe-rs: {error}"),
        "see that the program may be run",
    )
}

/// The lines of both outputs that are not empty; errors come last.
pub(super) fn output_text(output: &Output) -> String {
    let text = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes));
    let lines = text.iter().flat_map(|text| text.lines());
    let lines: Vec<&str> = lines
        .map(str::trim)
        .filter(|line| !line.is_empty())
        .collect();
    lines.join("; ")
}
