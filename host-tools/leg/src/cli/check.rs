//! `leg check`.

use super::{board, print, progress};
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_bench::check::{self, Bits, Report, RowReport};
use leg_bench::precision::TABLE;
use leg_firmware_bench::kernels::Kernel;
use serde::Serialize;
use std::fmt::Write;

/// Random states beside those of the grid.
const SAMPLE: usize = 3_000;

/// The same states in every run.
const SEED: u64 = 1;

/// Checks the firmware under QEMU: its f32 against f64, and its bits against f32 on the host.
///
/// A grid and a random sample of the workspace of the paper's rig go through every kernel and the whole evaluation.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Prints JSON instead of a table.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: a missing prerequisite, a link that fails, or what did not hold.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    let mut link = board::qemu(verbose)?;
    let mut states = check::grid();
    states.extend(check::random(SAMPLE, SEED));
    let progress = progress::bar(states.len() as u64, "states");
    let checked = check::run(link.as_mut(), &TABLE, &states, || progress.inc(1));
    progress.finish_and_clear();
    let report = checked.map_err(|error| Failure::from_error(&error))?;
    print(&if args.json {
        json(&report)?
    } else {
        table(&report)
    })?;
    judge(&report)
}

fn table(report: &Report) -> String {
    let mut text = format!(
        "f32 on the emulated Cortex-M4F against f64, at {} states\n\n{:26} {:>9} {:>9} {:8}  {:6}  where it is worst\n",
        report.states, "quantity", "worst", "bound", "", "",
    );
    let mut reasons = String::new();
    for row in &report.rows {
        text.push_str(&line(row));
        if let Some(reason) = row.row.exception {
            // Writing to a string cannot fail.
            let _ = writeln!(reasons, "* {}: {reason}", row.row.name);
        }
    }
    format!("{text}\n{reasons}\n{}", bits(&report.bits))
}

fn line(report: &RowReport) -> String {
    let row = &report.row;
    let star = if row.exception.is_some() { " *" } else { "" };
    let place = report.at.map_or("-".into(), |pose| pose.to_string());
    format!(
        "{:26} {:>9} {:>9} {:8}  {:6}  {place}\n",
        format!("{}{star}", row.name),
        format!("{:.1e}", report.worst),
        format!("{:.1e}", row.bound),
        row.unit,
        if report.held { "held" } else { "MISSED" },
    )
}

fn bits(bits: &Bits) -> String {
    if bits.differences.is_empty() {
        return format!(
            "Bits equal to host f32: {} kernels × {} states, {} evaluations\n",
            Kernel::ALL.len(),
            bits.poses(),
            bits.evaluations,
        );
    }
    let differences = bits.differences.iter().map(|difference| {
        format!(
            "Bits differ from host f32: {} at {} states, first at {}\n",
            difference.what, difference.count, difference.at
        )
    });
    differences.collect()
}

/// The report for machines.
#[derive(Serialize)]
struct JsonReport<'a> {
    #[serde(flatten)]
    report: &'a Report,
    held: bool,
}

fn json(report: &Report) -> Result<String, Failure> {
    let held = report.missed().is_empty();
    to_line(&JsonReport { report, held })
}

fn judge(report: &Report) -> Result<(), Failure> {
    let missed = report.missed();
    if missed.is_empty() {
        return Ok(());
    }
    let sentence = format!("not held: {}", missed.join("; "));
    let help = "look for what changed in the model or the compiler before you move a bound in precision/table.rs";
    Err(Failure::missed(sentence, help))
}

#[cfg(test)]
mod tests {
    use super::{judge, table};
    use leg_base::failure::Failure;
    use leg_bench::check::{Accuracy, Bits, Report, random};
    use leg_bench::precision::TABLE;

    /// A report in which the first row is off by as much as its bound times `part`.
    fn report(part: f64) -> Report {
        let states = random(1, 1);
        let mut accuracy = Accuracy::new(&TABLE[..1]);
        let found = [part * TABLE[0].bound];
        for state in &states {
            accuracy.add(&[(Some(TABLE[0].quantity), 1)], &found, &[0.0], state);
        }
        Report {
            states: states.len(),
            rows: accuracy.into_rows(),
            bits: Bits::default(),
        }
    }

    #[test]
    fn a_missed_row_is_named_and_ends_with_exit_code_1() {
        assert!(judge(&report(0.9)).is_ok());
        let missed = report(1.1);
        assert!(table(&missed).contains("MISSED"));
        let Err(Failure::Missed(message)) = judge(&missed) else {
            panic!("{missed:?} is judged as held");
        };
        assert_eq!(message.sentence, "not held: lengths");
    }
}
