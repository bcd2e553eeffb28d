//! Steps 2 to 7 of BOARD.md, typed as they stand there: an emulated chip with an empty flash in the place of the board.

use super::board::BoardUnderTest;
use super::page::{PageStep, board_page, one_line, typed};
use crate::common::stalls::wait_for;
use leg_boards::chip::ChipSession;
use leg_boards::image::FirmwareImage;
use leg_boards::setup;
use leg_firmware::settings::Settings;
use leg_firmware_bench::protocol::Request;
use leg_sim::link::Link;
use serde_json::Value;
use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

const LEG: &str = env!("CARGO_BIN_EXE_leg-under-test");

/// Ticks after which a new board has logged what step 2 quotes.
const LOG_TICKS: usize = 160;

/// The longest tick that step 2 allows, cycles.
const LONGEST_TICK: u32 = 6_000;

/// In the place of probe-rs: keeps the file that is to be flashed, and shows the log that its image has on the chip.
fn probe_rs(directory: &Path) {
    let text = format!(
        "#!/bin/sh\ncd '{}'\nfor last; do :; done\ncase $1 in\n\
         read) case \"$*\" in *0xE0042000*) echo 'e0042000: 20036469';; *) echo '40022020: ffeff8aa';; esac;;\n\
         download) cp \"$last\" flashed.elf;;\n\
         attach) cat log;;\nesac\n",
        directory.display()
    );
    let script = directory.join("probe-rs");
    fs::write(&script, text).unwrap();
    fs::set_permissions(&script, Permissions::from_mode(0o755)).unwrap();
}

/// What an image logs on a new board.
fn log(image: &Path) -> Vec<String> {
    let mut session = ChipSession::open(image).unwrap().with_flash(&[]);
    let settings = Settings::table_1().unwrap();
    session.ask(&Request::Start(settings)).unwrap();
    for _ in 0..LOG_TICKS {
        let at_rest = crate::common::chip::resting_tick();
        session.ask(&Request::Tick(at_rest)).unwrap();
    }
    session.log_lines()
}

/// Step 2.
fn flash(step: &PageStep<'_>, directory: &Path) {
    let image = FirmwareImage::Stm32g474.build().unwrap();
    probe_rs(directory);
    fs::write(directory.join("log"), log(&image).join("\n")).unwrap();
    assert_eq!(step.commands(), ["leg flash"]);
    let output = Command::new(LEG)
        .arg("flash")
        .env("LEG_PROBE_RS", directory.join("probe-rs"))
        .output()
        .unwrap();
    let told = one_line(&String::from_utf8(output.stdout).unwrap());
    assert!(output.status.success(), "{told}");
    for words in step.seen() {
        let mut parts = words.split('…');
        assert!(parts.all(|part| told.contains(part)), "{words}\n{told}");
    }
    let longest = told.split("longest tick: ").nth(1).unwrap();
    let cycles: u32 = longest.split(' ').next().unwrap().parse().unwrap();
    assert!(cycles <= LONGEST_TICK, "{cycles}");
    let flashed = fs::read(directory.join("flashed.elf")).unwrap();
    assert!(
        flashed == fs::read(image).unwrap(),
        "another image is flashed than runs"
    );
}

/// Waits until a state shows.
fn wait_for_state(board: &BoardUnderTest, what: impl Fn(&Value) -> bool) -> Value {
    wait_for("a state", || Some(board.state()).filter(&what))
}

fn has(state: &Value, fault: &str) -> bool {
    let faults = state["faults"].as_array().unwrap();
    faults.iter().any(|seen| seen == fault)
}

/// Something is done by hand and undone: the fault shows, switches off, and can be cleared afterwards.
fn tried(board: &mut BoardUnderTest, [done, undone]: [&str; 2], fault: &str) {
    board.act(done);
    let state = wait_for_state(board, |state| has(state, fault));
    assert_eq!(state["state"], "off");
    board.act(undone);
    let cleared = || board.run(&["clear"]).status.success().then_some(());
    wait_for("a clear", cleared);
    assert!(!has(&board.state(), fault));
}

#[test]
fn a_new_board_is_flashed_set_cleared_stopped_and_faulted_as_the_page_says() {
    setup::ensure_target(&mut |_| {}).unwrap();
    let page = board_page();
    let step = |number| PageStep::numbered(&page, number);
    let directory = tempfile::tempdir().unwrap();
    let directory = directory.path();
    flash(&step(2), directory);

    let arguments = ["--on", "chip", "--slack", "--new-board"];
    let mut board = BoardUnderTest::new(&arguments);
    // Nothing is wired yet.
    board.act(r#"{"emergency_stop":true}"#);
    assert_eq!(step(3).commands(), ["leg monitor"]);
    let state = wait_for_state(&board, |state| has(state, "emergency stop"));
    assert_eq!(state["state"], "off");
    assert!(has(&state, "settings corrupt"), "{state}");

    // The settings are kept in the chip's flash.
    let settings = step(4);
    let told: String = settings
        .commands()
        .into_iter()
        .map(|line| typed(&mut board, directory, line, &[]))
        .collect();
    let told = one_line(&told);
    for words in settings.seen_on_a_board() {
        assert!(told.contains(&words), "step 4: {words}\n{told}");
    }

    board.act(r#"{"emergency_stop":false}"#);
    let clear = step(5);
    assert_eq!(clear.commands(), ["leg clear"]);
    let told = one_line(&typed(&mut board, directory, "leg clear", &[]));
    for words in clear.seen() {
        assert!(told.contains(&one_line(&words)), "step 5: {words}\n{told}");
    }

    assert!(
        step(6)
            .text()
            .contains("Press it; release it; `leg clear`.")
    );
    let stop = [r#"{"emergency_stop":true}"#, r#"{"emergency_stop":false}"#];
    tried(&mut board, stop, "emergency stop");
    tried(&mut board, stop, "emergency stop");

    assert!(step(7).seen().contains(&"driver fault (gate off)".into()));
    for driver in 1..=3 {
        let [fault, repair] = ["fault", "repair"]
            .map(|action| format!(r#"{{"{action}":{{"driver_fault":{driver}}}}}"#));
        tried(&mut board, [&fault, &repair], "driver fault");
    }
    assert_eq!(board.state()["state"], "disarmed");
}
