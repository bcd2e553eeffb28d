//! `leg calibrate motors`.

use super::hand::{Hand, drivers_off};
use crate::cli::line::{Fresh, LineArgs};
use crate::cli::print;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_rig::rig_file::RigFile;
use serde::Serialize;
use std::path::PathBuf;

/// How far a turn by hand may be off.
const HAND_PART: f64 = 0.15;

/// Checks which way each encoder counts, and how far: every motor is turned once by hand, drivers off.
///
/// Whether the motors' own wires are right shows when they are driven first: the fault "motor turns the wrong way".
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The rig file or the name of a ready rig that says what a turn counts; the paper's rig if left out.
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    #[command(flatten)]
    line: LineArgs,
    /// Prints JSON instead of a table.
    #[arg(long)]
    json: bool,
}

/// What one turn of a motor counted.
#[derive(Clone, Copy, Debug, Serialize)]
struct Turned {
    motor: usize,
    counts: i16,
    expected: f64,
    /// Which way the encoder counts; 0 if it counted nothing.
    sign: i8,
    held: bool,
}

impl Turned {
    fn new(motor: usize, counts: i16, expected: f64) -> Self {
        let off = (f64::from(counts) - expected).abs();
        Self {
            motor: motor + 1,
            counts,
            expected,
            sign: counts.signum() as i8,
            held: off <= HAND_PART * expected.abs(),
        }
    }

    fn words(&self) -> String {
        let verdict = if self.held {
            "held".into()
        } else if self.counts == 0 {
            "missed: no count; check the encoder's wiring".into()
        } else if f64::from(self.counts) * self.expected < 0.0 {
            format!(
                "missed: it counts the other way; set its counts_sign to {}",
                self.sign
            )
        } else {
            "missed: another number of counts; check counts_per_turn, and the turn itself".into()
        };
        let Self {
            motor,
            counts,
            expected,
            ..
        } = self;
        format!("{motor:5} {counts:8} {expected:9.0}  {verdict}\n")
    }
}

pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    let rig = RigFile::load(args.rig.as_deref())?;
    let counts_per_turn = rig.actuator.counts_per_turn;
    if counts_per_turn * (1.0 + HAND_PART) > f64::from(i16::MAX) {
        return Err(Failure::refused(
            format!(
                "a turn of {counts_per_turn} counts is too much for the board's counter of 16 bits"
            ),
            "check its direction by homing; a wrong one is a fault by name",
        ));
    }
    let mut line = args.line.open(&rig, Fresh::Slack, verbose)?;
    let operator = &mut line.operator;
    drivers_off(operator, "let itself be turned by hand")?;
    let settings = operator.settings()?;
    let hand = Hand::of(line.emulated.as_ref());
    let mut turns = Vec::new();
    for (motor, axis) in settings.axes.iter().enumerate() {
        let before = operator.sensors()?.encoder_counts[motor];
        hand.turn(operator, motor)?;
        let after = operator.sensors()?.encoder_counts[motor];
        // The counter wraps; a turn is less than half of it.
        let counts = after.wrapping_sub(before) as i16;
        let expected = counts_per_turn * f64::from(axis.m_per_count.signum());
        turns.push(Turned::new(motor, counts, expected));
    }
    print(&if args.json {
        to_line(&turns)?
    } else {
        table(&turns)
    })?;
    judge(&turns)
}

fn table(turns: &[Turned]) -> String {
    let rows: String = turns.iter().map(Turned::words).collect();
    let head = format!("motor   counts  expected\n{rows}");
    if turns.iter().any(|turned| turned.sign == 0) {
        return head;
    }
    let signs: Vec<String> = turns.iter().map(|turned| turned.sign.to_string()).collect();
    format!(
        "{head}\n[calibration]\ncounts_sign = [{}]\n",
        signs.join(", ")
    )
}

fn judge(turns: &[Turned]) -> Result<(), Failure> {
    let missed = turns.iter().filter(|turned| !turned.held);
    let motors: Vec<String> = missed.map(|turned| turned.motor.to_string()).collect();
    if motors.is_empty() {
        return Ok(());
    }
    Err(Failure::missed(
        format!(
            "motor {} does not count as the rig file and the board say",
            motors.join(", ")
        ),
        "correct the rig file, then `leg settings set`",
    ))
}
