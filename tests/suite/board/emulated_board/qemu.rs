//! The firmware under QEMU behind the pseudo-terminal.

use super::board::{BoardUnderTest, PATIENT, SLOW, errors};
use leg_boards::image::FirmwareImage;
use leg_boards::setup;

#[test]
fn a_leg_under_qemu_homes_moves_and_is_stopped_on_its_way() {
    setup::ensure_target(&mut |_| {}).unwrap();
    setup::ensure_qemu(&mut |_| {}).unwrap();
    FirmwareImage::Qemu.build().unwrap();
    let board =
        BoardUnderTest::with_sections(&[PATIENT, SLOW].concat(), &["--on", "qemu", "--slack"]);
    assert_eq!(board.json(&["home"])["state"], "held");
    let moving = board.begin_move();
    let stopped = board.json(&["stop"]);
    assert_eq!(stopped["state"], "held");
    assert!(stopped["tilt_deg"].as_f64().unwrap() < 28.0, "{stopped}");
    let output = moving.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", errors(&output));
    assert_eq!(board.json(&["disarm"])["state"], "disarmed");
}
