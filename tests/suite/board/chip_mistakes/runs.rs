//! Short runs of an image on the emulated chip, and what they report.

use super::can_bus;
use crate::board::chip_latency;
use crate::common::chip::driving;
use leg_boards::chip::{ChipSession, LATENCY_CYCLES_MAX};
use leg_host::cancel_flag::CancelFlag;
use leg_host::operator::{HostIdentity, Operator};
use leg_host::transport::emulated::EmulatedLine;
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::{EmulatedLeg, InitialState};
use leg_sim::scenario::Scenario;
use leg_sim::simulation::Simulation;
use std::error::Error;
use std::path::Path;
use stm32g474_emulator::board::Board;
use stm32g474_emulator::chip::Chip;

/// The report where nothing is wrong.
pub const NOTHING: &str = "nothing is wrong";

const MOVING: &str = r#"
title = "Homing begins, the emergency stop is pressed, and a driver reports a fault"
steps = [
    { await = { state = "disarmed", timeout_s = 1 } },
    "home",
    { wait_s = 0.1 },
    { emergency_stop = true },
    { reaction = { fault = "emergency_stop", state = "off", within_ms = 2 } },
    { emergency_stop = false },
    "clear",
    "home",
    { wait_s = 0.1 },
    { fault = { driver_fault = 2 } },
    { reaction = { fault = "driver_fault", state = "off", within_ms = 2 } },
    { wait_s = 0.01 },
]

[start.slack]
slack_mm = 3
"#;

/// The motors run, and are stopped by both breaks.
pub fn moving(image: &Path) -> String {
    reported(play(MOVING, image))
}

/// The host lets the board keep its settings.
pub fn saving(image: &Path) -> String {
    reported(save(image, Board::default()))
}

/// The same on a chip whose flash is one bank.
pub fn saving_in_one_bank(image: &Path) -> String {
    let dual_bank = false;
    let board = Board {
        dual_bank,
        ..Board::default()
    };
    reported(save(image, board))
}

/// A host on a CAN bus asks the board what it is.
pub fn answering_on_can(image: &Path) -> String {
    reported(can_bus::asked(image))
}

/// The crystal stops while the motors are driven.
pub fn losing_its_crystal(image: &Path) -> String {
    reported(pulses_end(image, |chip| chip.stop_crystal()))
}

/// The chip's supply falls below what its converters are right at, and not so far that it is reset.
pub fn losing_its_supply(image: &Path) -> String {
    reported(pulses_end(image, |chip| {
        chip.dip_supply(DIP_MV, 1);
    }))
}

/// Between the levels of voltage detector and brown-out reset, mV.
const DIP_MV: u32 = 2_700;

fn pulses_end(image: &Path, failure: impl Fn(&mut Chip)) -> Result<(), Box<dyn Error>> {
    let mut session = driving(image, Board::default())?;
    let chip = session.chip().ok_or("no chip")?;
    failure(chip);
    if chip.peripherals().devices.tim1.outputs().on {
        return Err("TIM1's pulses go on".into());
    }
    Ok(())
}

/// The host talks and lets the board keep its settings: how late the control interrupt may be.
pub fn latest(image: &Path) -> String {
    let latest = chip_latency::latest(image);
    if latest
        .iter()
        .all(|(cycles, _)| *cycles <= LATENCY_CYCLES_MAX)
    {
        return NOTHING.into();
    }
    format!("the control interrupt's handler may begin {latest:?} cycles after its interrupt")
}

fn reported(result: Result<(), Box<dyn Error>>) -> String {
    let Err(error) = result else {
        return NOTHING.into();
    };
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        text = format!("{text}: {error}");
        cause = error.source();
    }
    text
}

fn play(scenario: &str, image: &Path) -> Result<(), Box<dyn Error>> {
    let scenario = Scenario::parse("a scenario", scenario).unwrap();
    let rig = RigFile::load(None).unwrap();
    let mut session = ChipSession::open(image)?;
    let summary = Simulation::new(&scenario, &rig)?.run(&mut session, &mut |_| {})?;
    if summary.passes() {
        return Ok(());
    }
    let measured = &summary.measurements;
    Err(format!(
        "{:?} {:?} {measured:?}",
        summary.stopped, summary.unexpected
    )
    .into())
}

fn save(image: &Path, board: Board) -> Result<(), Box<dyn Error>> {
    let rig = RigFile::load(None).unwrap();
    // A new board: an image that looks for its settings elsewhere finds none there, as it would on the right one.
    let session = ChipSession::open(image)?.with_board(board).with_flash(&[]);
    let session = Box::new(session);
    let leg = EmulatedLeg::new(&rig, InitialState::Slack, session)?;
    let line = Box::new(EmulatedLine::new(leg, "the leg on the chip").connect());
    let mut operator = Operator::open(line, HostIdentity::FIXED, CancelFlag::default())?;
    Ok(operator.save_settings()?)
}
