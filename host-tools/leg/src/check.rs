//! `leg check`.

use crate::options::Options;
use crate::output::require_none;
use crate::{board, progress};
use leg_base::failure::Failure;
use leg_base::json_object;
use leg_bench::check::{self, BitComparison, CheckReport, RowReport};
use leg_bench::precision::TABLE;
use leg_boards::qemu::QemuClock;
use leg_firmware_bench::kernels::Kernel;
use std::fmt::Write;

/// Random states beside those of the grid.
const SAMPLE: usize = 3_000;

/// The same states in every run.
const SEED: u64 = 1;

pub(crate) fn run(options: Options) -> Result<(), Failure> {
    let mut link = board::qemu(QemuClock::Normal, options)?;
    let mut states = check::grid();
    states.extend(check::random(SAMPLE, SEED));
    let progress = progress::bar(states.len() as u64, "states");
    let checked = check::run(link.as_mut(), &TABLE, &states, || progress.inc(1));
    progress.finish_and_clear();
    let report = checked.map_err(Failure::from_error)?;
    let passed = report.failures().is_empty();
    let json = json_object! {
        #[serde(flatten)]
        report: &report,
        passed: passed,
        // The same under its former name, for one release.
        held: passed,
    };
    options.report(&json, || table(&report))?;
    require_passed(&report)
}

fn table(report: &CheckReport) -> String {
    let mut text = format!(
        "f32 on the emulated Cortex-M4F against f64, at {} states\n\n{:26} {:>9} {:>9} {:8}  {:6}  where it is worst\n",
        report.states, "quantity", "worst", "bound", "", "",
    );
    let mut reasons = String::new();
    for row in &report.rows {
        text.push_str(&row_text(row));
        if let Some(reason) = row.row.exception {
            // Writing to a string cannot fail.
            let _ = writeln!(reasons, "* {}: {reason}", row.row.name);
        }
    }
    format!("{text}\n{reasons}\n{}", bits_text(&report.bits))
}

fn row_text(report: &RowReport) -> String {
    let row = &report.row;
    let star = if row.exception.is_some() { " *" } else { "" };
    let place = report.at.map_or("-".into(), |pose| pose.to_string());
    format!(
        "{:26} {:>9} {:>9} {:8}  {:6}  {place}\n",
        format!("{}{star}", row.name),
        format!("{:.1e}", report.worst),
        format!("{:.1e}", row.bound),
        row.unit,
        if report.passed { "pass" } else { "FAIL" },
    )
}

fn bits_text(bits: &BitComparison) -> String {
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

fn require_passed(report: &CheckReport) -> Result<(), Failure> {
    let help = "look for what changed in the model or the compiler before you move a bound in precision/table.rs";
    require_none("failed", &report.failures(), help)
}

#[cfg(test)]
mod tests {
    use super::{require_passed, table};
    use leg_base::failure::Failure;
    use leg_bench::check::{Accuracy, BitComparison, CheckReport, random};
    use leg_bench::precision::TABLE;

    /// A report in which the first row is off by as much as its bound times `part`.
    fn report(part: f64) -> CheckReport {
        let states = random(1, 1);
        let mut accuracy = Accuracy::new(&TABLE[..1]);
        let found = [part * TABLE[0].bound];
        for state in &states {
            accuracy.add(&[(Some(TABLE[0].quantity), 1)], &found, &[0.0], state);
        }
        CheckReport {
            states: states.len(),
            rows: accuracy.into_rows(),
            bits: BitComparison::default(),
        }
    }

    #[test]
    fn a_failed_row_is_named_and_ends_with_exit_code_1() {
        assert!(require_passed(&report(0.9)).is_ok());
        let failed = report(1.1);
        assert!(table(&failed).contains("FAIL"));
        let Err(Failure::Failed(message)) = require_passed(&failed) else {
            panic!("{failed:?} passes");
        };
        assert_eq!(message.sentence, "failed: lengths");
    }
}
