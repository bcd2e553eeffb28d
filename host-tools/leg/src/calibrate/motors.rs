//! `leg calibrate motors`.

use super::manual_steps::manual_step;
use crate::connection::{ConnectionArgs, Purpose};
use crate::options::Options;
use crate::output::load_rig;
use leg_base::failure::Failure;
use leg_host::calibration::require_drivers_off;
use serde::Serialize;
use std::path::PathBuf;

/// How far a turn by hand may be off.
const HAND_PART: f64 = 0.15;

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

/// What one turn of a motor counted.
#[derive(Clone, Copy, Debug, Serialize)]
struct Turn {
    motor: usize,
    counts: i16,
    expected: f64,
    /// The encoder's direction; 0 if it counted nothing.
    sign: i8,
    passed: bool,
    /// The same under its former name, for one release.
    held: bool,
}

impl Turn {
    fn new(motor: usize, counts: i16, expected: f64) -> Self {
        let error = (f64::from(counts) - expected).abs();
        let passed = error <= HAND_PART * expected.abs();
        Self {
            motor: motor + 1,
            counts,
            expected,
            sign: counts.signum() as i8,
            passed,
            held: passed,
        }
    }

    fn row(&self) -> String {
        let verdict = if self.passed {
            "pass".into()
        } else if self.counts == 0 {
            "fail: no count; check the encoder's wiring".into()
        } else if f64::from(self.counts) * self.expected < 0.0 {
            format!(
                "fail: it counts in the other direction; set its counts_sign to {}",
                self.sign
            )
        } else {
            "fail: another number of counts; check counts_per_turn, and the turn itself".into()
        };
        format!(
            "{:5} {:8} {:9.0}  {verdict}\n",
            self.motor, self.counts, self.expected
        )
    }
}

pub(super) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let rig = load_rig(args.rig.as_deref())?;
    let counts_per_turn = rig.actuator.counts_per_turn;
    if counts_per_turn * (1.0 + HAND_PART) > f64::from(i16::MAX) {
        return Err(Failure::refused(
            format!(
                "a turn of {counts_per_turn} counts is too much for the board's counter of 16 bits"
            ),
            "check its direction by homing; a wrong one is a fault by name",
        ));
    }
    let mut connection = args.connection.open(&rig, Purpose::Calibrate, options)?;
    require_drivers_off(&mut connection.operator, "let itself be turned by hand")?;
    let settings = connection.operator.settings()?;
    let mut turns = Vec::new();
    for (motor, axis) in settings.axes.iter().enumerate() {
        let before = connection.operator.sensors()?.encoder_counts[motor];
        let number = motor + 1;
        let step = format!("turn motor {number} by one turn, so that it reels its tendon in");
        manual_step(&mut connection, &step, |plant| plant.turn_motor(motor, 1.0))?;
        let after = connection.operator.sensors()?.encoder_counts[motor];
        // The counter wraps; a turn is less than half of it.
        let counts = after.wrapping_sub(before) as i16;
        let expected = counts_per_turn * f64::from(axis.m_per_count.signum());
        turns.push(Turn::new(motor, counts, expected));
    }
    options.report(&turns, || table(&turns))?;
    require_passed(&turns)
}

fn table(turns: &[Turn]) -> String {
    let rows: String = turns.iter().map(Turn::row).collect();
    let table = format!("motor   counts  expected\n{rows}");
    if turns.iter().any(|turn| turn.sign == 0) {
        return table;
    }
    let signs: Vec<String> = turns.iter().map(|turn| turn.sign.to_string()).collect();
    let signs = signs.join(", ");
    format!("{table}\n[calibration]\ncounts_sign = [{signs}]\n")
}

fn require_passed(turns: &[Turn]) -> Result<(), Failure> {
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
