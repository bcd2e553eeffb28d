//! What `leg` prints, to the letter: the transcripts in `command_line/`, README.md and the pages of the host's tools.
//!
//! `TRYCMD=overwrite cargo test --test command_line` writes them anew. That of a leg on the emulated chip takes a minute of one
//! core: `suite` runs it beside its other tests.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_boards::image::FirmwareImage;
use leg_boards::{image, setup};
use std::fs::Permissions;
use std::io::Write;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const LEG: &str = env!("CARGO_BIN_EXE_leg-under-test");

#[test]
fn transcripts() {
    // What a bare machine installs first is reported on standard error, and not part of any transcript.
    setup::ensure_target(&mut |_| {}).unwrap();
    setup::ensure_qemu(&mut |_| {}).unwrap();
    // The commands of README.md and of the pages run in the root of the workspace.
    std::env::set_current_dir(image::workspace_root()).unwrap();
    trycmd::TestCases::new()
        .register_bin("leg", Path::new(LEG))
        .case("tests/command_line/*.trycmd")
        .skip("tests/command_line/chip.trycmd")
        .case("README.md")
        .case("host-tools/docs/*.md");
}

/// Runs `leg` with a text on its standard input.
fn leg_reads(arguments: &[&str], input: &[u8]) -> Output {
    let mut leg = Command::new(LEG)
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    leg.stdin.take().unwrap().write_all(input).unwrap();
    leg.wait_with_output().unwrap()
}

#[test]
fn a_missing_emulator_is_refused_with_the_fix() {
    let output = Command::new(LEG)
        .args(["run"])
        .env("LEG_QEMU", "no-such-emulator")
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let error = String::from_utf8(output.stderr).unwrap();
    assert!(
        error.contains("LEG_QEMU names `no-such-emulator`"),
        "{error}"
    );
    assert!(output.stdout.is_empty());
}

/// A program in the emulator's place: it runs the emulator and kills it when there is something in a file.
fn dying_emulator(directory: &Path, answers: &Path) -> PathBuf {
    let emulator = setup::ensure_qemu(&mut |_| {}).unwrap();
    let script = directory.join("dying-emulator");
    let text = format!(
        "#!/bin/sh\n'{}' \"$@\" &\nwhile kill -0 $! && ! [ -s '{}' ]; do sleep 0.1; done\nkill -9 $!\nwait $!\n",
        emulator.display(),
        answers.display()
    );
    std::fs::write(&script, text).unwrap();
    std::fs::set_permissions(&script, Permissions::from_mode(0o755)).unwrap();
    script
}

#[test]
fn an_emulator_that_dies_during_a_run_is_reported() {
    let directory = tempfile::tempdir().unwrap();
    FirmwareImage::Qemu.build().unwrap();
    // Enough poses that there are many left after the first answers.
    let line = br#"{"azimuth_deg":30,"tilt_deg":20,"payload_kg":1}
"#;
    let poses = directory.path().join("poses.jsonl");
    std::fs::write(&poses, line.repeat(200_000)).unwrap();
    let answers = directory.path().join("answers.jsonl");
    let output = Command::new(LEG)
        .args(["eval", "--on", "qemu"])
        .arg(&poses)
        .env("LEG_QEMU", dying_emulator(directory.path(), &answers))
        .stdout(std::fs::File::create(&answers).unwrap())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let error = String::from_utf8(output.stderr).unwrap();
    assert!(
        error.contains("QEMU") && error.contains("start again"),
        "{error}"
    );
    let answers = std::fs::read_to_string(answers).unwrap();
    let count = answers.lines().count();
    assert!((1..200_000).contains(&count), "{count} answers");
    assert!(answers.ends_with("}\n"), "the last answer is whole");
}

#[test]
fn run_reports_as_json() {
    let directory = tempfile::tempdir().unwrap();
    let output = Command::new(LEG)
        .args(["run", "--on", "sim", "--json", "--plots"])
        .arg(directory.path())
        .output()
        .unwrap();
    assert!(output.status.success());
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["passed"], true);
    assert_eq!(report["divergence"]["other_state"], 0);
    let findings = report["findings"].as_array().unwrap();
    assert!(findings.iter().all(|finding| finding["value"].is_f64()));
    for chart in ["tip", "tensions", "stiffness"] {
        assert!(directory.path().join(chart).with_extension("png").is_file());
    }
}

#[test]
fn eval_reads_standard_input_when_no_file_is_named() {
    let line = br#"{"azimuth_deg":30,"tilt_deg":20,"payload_kg":1}"#;
    let output = leg_reads(&["eval"], line);
    assert!(output.status.success());
    assert_eq!(output.stdout, leg_reads(&["eval", "-"], line).stdout);
    assert!(output.stdout.starts_with(br#"{"lengths_m":["#));
}

#[test]
fn eval_refuses_empty_standard_input() {
    let output = leg_reads(&["eval"], b"");
    assert_eq!(output.status.code(), Some(2));
    assert!(
        String::from_utf8(output.stderr)
            .unwrap()
            .contains("standard input holds no pose")
    );
}

#[test]
fn eval_answers_a_line_that_is_not_utf8_in_its_place() {
    let output = leg_reads(&["eval"], b"{\"\xff\":1}\n");
    assert_eq!(output.status.code(), Some(1));
    let answer = String::from_utf8(output.stdout).unwrap();
    assert!(
        answer.starts_with(r#"{"error":"not a JSON object: invalid unicode"#),
        "{answer}"
    );
}

#[test]
fn every_shell_has_completions_and_every_command_a_manual_page() {
    let directory = tempfile::tempdir().unwrap();
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = leg_reads(&["completions", shell], b"");
        assert!(script.status.success(), "{shell}");
        let script = String::from_utf8(script.stdout).unwrap();
        assert!(script.contains("calibrate") && script.contains("payload-kg"));
    }
    let pages = directory.path().to_str().unwrap();
    assert!(leg_reads(&["man", "--out", pages], b"").status.success());
    for command in leg_cli::command().get_subcommands() {
        let page = directory
            .path()
            .join(format!("leg-{}.1", command.get_name()));
        let about = command.get_about().unwrap().to_string();
        let text = std::fs::read_to_string(page).unwrap();
        // How a manual page writes an apostrophe and a hyphen.
        let text = text.replace("\\*(Aq", "'").replace('\\', "");
        assert!(text.contains(&about), "{about}");
    }
}

#[test]
fn every_error_of_a_command_with_json_is_one_line_of_json() {
    let cases: [(&[&str], i32); 5] = [
        (&["run", "--scenario", "nowhere"], 2),
        (
            &["rig", "validate", "tests/command_line/run.in/typo.toml"],
            2,
        ),
        (&["fly"], 2),
        (&["home", "--port", "/dev/no-such-port"], 2),
        (&["eval", "tests/command_line/eval.in/bad.jsonl"], 1),
    ];
    for (arguments, exit_code) in cases {
        let output = Command::new(LEG)
            .args(arguments)
            .arg("--json")
            .current_dir(image::workspace_root())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(exit_code));
        let error: serde_json::Value = serde_json::from_slice(&output.stderr).unwrap();
        assert_eq!(error["exit_code"], exit_code);
        assert!(!error["error"].as_str().unwrap().is_empty());
    }
}
