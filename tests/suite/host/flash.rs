//! `leg flash` with a program in the place of probe-rs that says what the real one would.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::fs::Permissions;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const LEG: &str = env!("CARGO_BIN_EXE_leg-under-test");

/// What `probe-rs read` prints of the right chip: its number and its option bytes.
const RIGHT_CHIP: &str = "case \"$*\" in *0xE0042000*) echo 'e0042000: 20036469';; \
                          *) echo '40022020: ffeff8aa';; esac";

/// The same with other option bytes.
fn option_bytes(options: &str) -> String {
    RIGHT_CHIP.replace("ffeff8aa", options)
}

/// Makes the program: a line of shell for each of its subcommands. It notes how it was called.
fn probe_rs(directory: &Path, lines: &[(&str, &str)]) -> PathBuf {
    let script = directory.join("probe-rs");
    let cases: String = lines
        .iter()
        .map(|(subcommand, line)| format!("{subcommand}) {line};;\n"))
        .collect();
    let calls = directory.join("calls");
    let text = format!(
        "#!/bin/sh\necho \"$@\" >> '{}'\ncase $1 in\n{cases}esac\n",
        calls.display()
    );
    std::fs::write(&script, text).unwrap();
    std::fs::set_permissions(&script, Permissions::from_mode(0o755)).unwrap();
    script
}

struct Flashed {
    output: Output,
    calls: String,
}

impl Flashed {
    fn told(&self) -> String {
        String::from_utf8_lossy(&self.output.stderr).into_owned()
    }
}

fn flash(lines: &[(&str, &str)], arguments: &[&str]) -> Flashed {
    let directory = tempfile::tempdir().unwrap();
    let image = directory.path().join("leg.elf");
    std::fs::write(&image, "an image").unwrap();
    let output = Command::new(LEG)
        .args(["flash", "--image"])
        .arg(&image)
        .args(arguments)
        .env("LEG_PROBE_RS", probe_rs(directory.path(), lines))
        .output()
        .unwrap();
    let calls = std::fs::read_to_string(directory.path().join("calls")).unwrap_or_default();
    Flashed {
        output,
        calls: calls.replace(&image.display().to_string(), "IMAGE"),
    }
}

#[test]
fn the_chip_is_checked_written_read_back_started_and_listened_to() {
    let log = "echo '0.000 INFO leg up'";
    let flashed = flash(&[("read", RIGHT_CHIP), ("attach", log)], &[]);
    assert!(flashed.output.status.success(), "{}", flashed.told());
    assert_eq!(
        String::from_utf8_lossy(&flashed.output.stdout),
        "flashed, read back and found the same\nstarted\n0.000 INFO leg up\n"
    );
    assert_eq!(
        flashed.calls,
        "read --non-interactive --chip STM32G474RETx b32 0xE0042000 1\n\
         read --non-interactive --chip STM32G474RETx b32 0x40022020 1\n\
         download --non-interactive --chip STM32G474RETx --disable-progressbars --verify IMAGE\n\
         reset --non-interactive --chip STM32G474RETx\n\
         attach --non-interactive --chip STM32G474RETx IMAGE\n"
    );
}

#[test]
fn one_of_several_debuggers_is_named() {
    let arguments = ["--no-log", "--probe", "0483:374e:0001"];
    let flashed = flash(&[("read", RIGHT_CHIP)], &arguments);
    assert!(flashed.output.status.success());
    assert!(
        flashed
            .calls
            .lines()
            .all(|call| call.contains("--probe 0483:374e:0001"))
    );
    assert!(!flashed.calls.contains("attach"));
}

#[test]
fn what_goes_wrong_is_named_with_its_cure() {
    let fails = |text: &str| format!("echo 'Error: {text}' >&2; exit 1");
    let cases = [
        (
            "No connected probes were found.",
            2,
            "finds no debugger",
            "plug the board in",
        ),
        ("2 probes were found:", 2, "several debuggers", "--probe"),
        (
            "Failed to open the debug probe.",
            2,
            "cannot be opened",
            "probe-setup",
        ),
        (
            "Connecting to the chip was unsuccessful.",
            2,
            "reaches no chip",
            "jumpers",
        ),
        (
            "The chip 'STM32G474RETx' was not found in the database.",
            2,
            "does not know",
            "newer",
        ),
        (
            "The core entered an unexpected status: LockedUp.",
            2,
            "processor is locked up",
            "reset the board",
        ),
        ("Something else.", 2, "Something else", "probe-rs info"),
    ];
    for (says, code, wrong, remedy) in cases {
        let flashed = flash(&[("read", &fails(&says.replace('\'', "")))], &[]);
        let told = flashed.told();
        assert_eq!(flashed.output.status.code(), Some(code), "{told}");
        assert!(told.contains(wrong) && told.contains(remedy), "{told}");
    }
}

#[test]
fn another_chip_is_not_written_to() {
    let flashed = flash(&[("read", "echo 'e0042000: 20016413'")], &[]);
    assert_eq!(flashed.output.status.code(), Some(2));
    assert!(
        flashed
            .told()
            .contains("its device number is 0x413, not 0x469"),
        "{}",
        flashed.told()
    );
    assert!(!flashed.calls.contains("download"));
}

#[test]
fn a_chip_with_other_option_bytes_is_not_written_to() {
    for (options, wrong, remedy) in [
        ("ffeff8bb", "protected against reading", "RDP level 0"),
        ("ffaff8aa", "set to a single bank", "DBANK"),
    ] {
        let flashed = flash(&[("read", &option_bytes(options))], &[]);
        assert_eq!(flashed.output.status.code(), Some(2));
        let told = flashed.told();
        assert!(told.contains(wrong) && told.contains(remedy), "{told}");
        assert!(!flashed.calls.contains("download"));
    }
}

#[test]
fn ctrl_c_is_the_way_to_end_the_log_and_a_crash_is_not() {
    for (attach, code) in [
        ("kill -INT $PPID; sleep 0.3; kill -INT $$", Some(0)),
        ("kill -INT $PPID; sleep 0.3; exit 130", Some(0)),
        ("kill -SEGV $$", Some(2)),
        ("exit 1", Some(2)),
    ] {
        let flashed = flash(&[("read", RIGHT_CHIP), ("attach", attach)], &[]);
        assert_eq!(flashed.output.status.code(), code, "{attach}");
    }
}

#[test]
fn flash_that_does_not_hold_is_a_miss() {
    let fails = "echo 'Error: Flash content verification failed.' >&2; exit 1";
    let flashed = flash(&[("read", RIGHT_CHIP), ("download", fails)], &[]);
    assert_eq!(flashed.output.status.code(), Some(1));
    assert!(
        flashed.told().contains("does not hold what was written"),
        "{}",
        flashed.told()
    );
    assert!(!flashed.calls.contains("reset"));
}

#[test]
fn a_missing_program_is_told_with_how_to_install_it() {
    let output = Command::new(LEG)
        .arg("flash")
        .env("LEG_PROBE_RS", "no-such-probe-rs")
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(told.contains("no program `no-such-probe-rs`"), "{told}");
    assert!(
        told.contains("cargo install probe-rs-tools --locked"),
        "{told}"
    );
}
