//! `leg run --errors`.

use crate::options::Options;
use crate::output::{chart_line, not_saved};
use crate::progress;
use leg_base::failure::Failure;
use leg_bench::sensitivity::{self, CELLS_PERCENT, CURVES_PERCENT, Sensitivity};
use leg_rig::rig_file::RigFile;
use leg_sim::scenario::Scenario;
use std::path::Path;

pub(super) fn run(
    scenario: &Scenario,
    rig: &RigFile,
    directory: &Path,
    options: Options,
) -> Result<(), Failure> {
    let runs = CELLS_PERCENT.len() * CURVES_PERCENT.len();
    let bar = progress::bar(runs as u64, "runs");
    let measured = sensitivity::measure(scenario, rig, || bar.inc(1));
    bar.finish_and_clear();
    let all = measured.map_err(Failure::from_error)?;
    let empty = |one: &Sensitivity| one.tip_mm.is_none() && one.stopped.is_none();
    if all.iter().all(empty) {
        return Err(Failure::refused(
            "the scenario measures no tip_error_mm while the load is compensated",
            "choose another, such as --scenario tour",
        ));
    }
    let chart = sensitivity::chart(&scenario.title, &all);
    // What was found is told, whether it can be drawn or not.
    let saved = leg_bench::plot::save(&chart, &directory.join("errors"))
        .map_err(|error| not_saved("chart", directory, "--plots", &error));
    options.report(&all, || {
        let chart = saved.as_deref().map(chart_line).unwrap_or_default();
        format!(
            "{}\nLargest distance of the compensated tip from its target, mm\n\n{}{}\n{chart}",
            scenario.title,
            table(&all),
            stops(&all),
        )
    })?;
    saved.map(|_| ())
}

/// What stopped the runs without a value.
fn stops(all: &[Sensitivity]) -> String {
    let mut reasons: Vec<&str> = all
        .iter()
        .filter_map(|one| one.stopped.as_deref())
        .collect();
    reasons.sort_unstable();
    reasons.dedup();
    if reasons.is_empty() {
        String::new()
    } else {
        format!("-: the leg was stopped: {}\n", reasons.join("; "))
    }
}

/// A row for each error of the load cells, a column for each of the tendons.
fn table(all: &[Sensitivity]) -> String {
    let columns: String = CURVES_PERCENT
        .iter()
        .map(|percent| format!("{percent:>8} %"))
        .collect();
    let row = |cell: &f64| {
        let values: String = all
            .iter()
            .filter(|one| one.cell_percent == *cell)
            .map(|one| {
                one.tip_mm
                    .map_or("         -".into(), |tip_mm| format!("{tip_mm:>10.3}"))
            })
            .collect();
        format!("{cell:>5} %          {values}\n")
    };
    let rows: String = CELLS_PERCENT.iter().map(row).collect();
    format!("load cells  tendons{columns}\n{rows}")
}
