//! What `leg` prints of a leg on the emulated chip, to the letter: `TRYCMD=overwrite cargo test --test suite -- chip_transcript`
//! writes it anew.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_boards::image::{FirmwareImage, workspace_root};
use leg_boards::setup;
use std::path::Path;

#[test]
fn a_leg_on_the_chip_is_commanded_as_any_other() {
    setup::ensure_target(&mut |_| {}).unwrap();
    FirmwareImage::Stm32g474.build().unwrap();
    let transcript = workspace_root().join("tests/command_line/chip.trycmd");
    trycmd::TestCases::new()
        .register_bin("leg", Path::new(env!("CARGO_BIN_EXE_leg-under-test")))
        .case(transcript);
}
