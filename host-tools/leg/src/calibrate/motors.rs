//! `leg calibrate motors`.

use super::manual_steps::manual_step;
use crate::connection::{ConnectionArgs, Purpose};
use crate::options::Options;
use crate::output::load_rig;
use leg_base::failure::Failure;
use leg_host::calibration::require_drivers_off;
use leg_rig::motor_turn::{self, MotorTurn};
use std::path::PathBuf;

/// Checks direction and counts of each encoder: every motor is turned once by hand, drivers off.
///
/// The wires of a motor are checked when it is first driven: by the fault "motor turns the wrong way".
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The rig file or the name of a ready rig that gives the counts of a turn; the paper's rig if left out.
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    #[command(flatten)]
    connection: ConnectionArgs,
}

pub(super) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let rig = load_rig(args.rig.as_deref())?;
    let counts_per_turn = rig.actuators.map(|actuator| actuator.counts_per_turn);
    counts_per_turn
        .into_iter()
        .try_for_each(motor_turn::require_countable)?;
    let mut connection = args.connection.open(&rig, Purpose::Calibrate, options)?;
    require_drivers_off(&mut connection.operator, "let itself be turned by hand")?;
    let settings = connection.operator.settings()?;
    let mut turns = Vec::new();
    for (motor, axis) in settings.axes.iter().enumerate() {
        let before = connection.operator.sensors()?.codes.encoder_counts[motor];
        let step = motor_turn::step(motor);
        manual_step(&mut connection, &step, |plant| plant.turn_motor(motor, 1.0))?;
        let after = connection.operator.sensors()?.codes.encoder_counts[motor];
        turns.push(MotorTurn::new(
            motor,
            [before, after],
            counts_per_turn[motor],
            axis,
        ));
    }
    options.report(&turns, || table(&turns))?;
    require_passed(&turns)
}

fn table(turns: &[MotorTurn]) -> String {
    let row = |turn: &MotorTurn| {
        let MotorTurn {
            motor,
            counts,
            expected,
            ..
        } = turn;
        format!("{motor:5} {counts:8} {expected:9.0}  {}\n", turn.verdict())
    };
    let rows: String = turns.iter().map(row).collect();
    let table = format!("motor   counts  expected\n{rows}");
    match motor_turn::signs(turns) {
        None => table,
        Some(signs) => format!("{table}\n[calibration]\ncounts_sign = {signs}\n"),
    }
}

fn require_passed(turns: &[MotorTurn]) -> Result<(), Failure> {
    let failed = turns.iter().filter(|turn| !turn.passed);
    let motors: Vec<String> = failed.map(|turn| turn.motor.to_string()).collect();
    if motors.is_empty() {
        return Ok(());
    }
    Err(Failure::failed(
        format!(
            "motor {} does not count as the rig file and the board say",
            motors.join(", ")
        ),
        "correct the rig file, then `leg settings set`",
    ))
}
