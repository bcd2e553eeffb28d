//! `leg paper`.

use super::print;
use leg_base::atomic_file::Workshop;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_base::paths::from_here;
use leg_bench::paper::{self, Paper, Row, Verdict};
use leg_boards::image;
use std::path::{Path, PathBuf};

/// The file beside the figures.
const REPORT: &str = "report.md";

/// Lays every number that the paper publishes beside ours, draws its figures 6, 9 and 10, and shows its errata.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The directory for report.md and the figures; target/leg-paper in the workspace if left out.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Prints JSON instead of a table.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: files that cannot be written, or a verdict that is not the one that is known.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let default = || image::workspace_root().join("target/leg-paper");
    let directory = args.out.clone().unwrap_or_else(default);
    let computed = Paper::compute().map_err(|error| Failure::from_error(&error))?;
    let report = write(&computed, &directory)?;
    print(&if args.json {
        to_line(&computed)?
    } else {
        table(&computed, &report)
    })?;
    judge(&computed)
}

/// Report and figures together, or nothing.
fn write(computed: &Paper, directory: &Path) -> Result<PathBuf, Failure> {
    let refused = |error: &dyn std::error::Error| {
        let sentence = format!("no report in {}: {error}", directory.display());
        Failure::refused(sentence, "name another directory with --out")
    };
    let workshop = Workshop::beside(directory).map_err(|error| refused(&error))?;
    let figures = paper::draw(workshop.path()).map_err(|error| refused(&error))?;
    let text = paper::markdown(computed, &figures);
    std::fs::write(workshop.path().join(REPORT), text).map_err(|error| refused(&error))?;
    workshop.deliver().map_err(|error| refused(&error))?;
    Ok(directory.join(REPORT))
}

fn table(computed: &Paper, report: &Path) -> String {
    let heading = format!(
        "{:>10} {:>11}  {:<8} {:<14} {}\n",
        "published", "ours", "unit", "verdict", "what"
    );
    let row = |row: &Row| {
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
        "{heading}{rows}\nWhat differs, and why:\n{reasons}\n{} errors of the print are shown by their numbers in the report.\nReport: {}\n",
        computed.errata.len(),
        from_here(report).display()
    )
}

/// Why rows differ; rows that differ for one reason stand together.
fn reasons(computed: &Paper) -> String {
    let differing = computed
        .rows
        .iter()
        .filter(|row| row.verdict() == Verdict::Differs);
    let differing: Vec<&Row> = differing.collect();
    let groups = differing.chunk_by(|a, b| a.why == b.why);
    let line = |group: &[&Row]| {
        let rows: Vec<&str> = group.iter().map(|row| row.what.as_str()).collect();
        let why = group.first().map_or("", |row| row.why);
        format!("* {}:\n  {why}\n", rows.join(";\n  "))
    };
    groups.map(line).collect()
}

fn judge(computed: &Paper) -> Result<(), Failure> {
    let surprises: Vec<&str> = computed.surprises().map(|row| row.what.as_str()).collect();
    if surprises.is_empty() {
        return Ok(());
    }
    let sentence = format!("a verdict is not the known one: {}", surprises.join("; "));
    let help = "look for what changed in the model before you change what is known in paper/";
    Err(Failure::missed(sentence, help))
}
