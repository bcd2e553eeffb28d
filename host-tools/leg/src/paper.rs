//! `leg paper`.

use crate::options::Options;
use crate::output::{require_none, save_all};
use leg_base::failure::Failure;
use leg_base::paths::relative_path;
use leg_bench::paper::{self, Paper, PaperRow, Verdict};
use leg_boards::image;
use std::path::{Path, PathBuf};

/// The file beside the figures.
const REPORT: &str = "report.md";

/// Compares every number that the paper publishes with the model's, draws its figures 6, 9 and 10, and lists its errata.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The directory for report.md and the figures; target/leg-paper in the workspace if left out.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let default = || image::workspace_root().join("target/leg-paper");
    let directory = args.out.clone().unwrap_or_else(default);
    let computed = Paper::compute().map_err(Failure::from_error)?;
    let report = write(&computed, &directory)?;
    options.report(&computed, || table(&computed, &report))?;
    let surprises: Vec<String> = computed.surprises().map(|row| row.what.clone()).collect();
    let help = "look for what changed in the model before you change what is known in paper/";
    require_none("a verdict is not the known one", &surprises, help)
}

/// Report and figures together, or nothing.
fn write(computed: &Paper, directory: &Path) -> Result<PathBuf, Failure> {
    save_all(
        "report",
        directory,
        "--out",
        |path| {
            let figures = paper::draw(path)?;
            let text = paper::markdown(computed, &figures);
            let written = std::fs::write(path.join(REPORT), text);
            Ok(written.map_err(|error| format!("{REPORT} cannot be written ({error})"))?)
        },
        || Ok(()),
    )?;
    Ok(directory.join(REPORT))
}

fn table(computed: &Paper, report: &Path) -> String {
    let heading = format!(
        "{:>10} {:>11}  {:<8} {:<14} {}\n",
        "published", "ours", "unit", "verdict", "what"
    );
    let row = |row: &PaperRow| {
        format!(
            "{:>10.*} {:>11.*}  {:<8} {:<14} {}\n",
            row.decimals,
            row.published,
            row.decimals,
            row.ours,
            row.unit,
            row.verdict().word(),
            row.what
        )
    };
    let rows: String = computed.rows.iter().map(row).collect();
    let reasons = reasons(computed);
    format!(
        "{heading}{rows}\nWhat differs, and why:\n{reasons}\n{} errata are shown by their numbers in the report.\nReport: {}\n",
        computed.errata.len(),
        relative_path(report).display()
    )
}

/// Why rows differ; rows that differ for one reason stand together.
fn reasons(computed: &Paper) -> String {
    let differing = computed
        .rows
        .iter()
        .filter(|row| row.verdict() == Verdict::Differs);
    let differing: Vec<&PaperRow> = differing.collect();
    let groups = differing.chunk_by(|a, b| a.why == b.why);
    let line = |group: &[&PaperRow]| {
        let rows: Vec<&str> = group.iter().map(|row| row.what.as_str()).collect();
        let why = group.first().map_or("", |row| row.why);
        format!("* {}:\n  {why}\n", rows.join(";\n  "))
    };
    groups.map(line).collect()
}
