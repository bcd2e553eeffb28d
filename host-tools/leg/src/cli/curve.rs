//! `leg curve`.

mod scale;

use super::curve_charts::Charts;
use super::curve_report::Report;
use super::print;
use leg_base::atomic_file;
use leg_base::failure::Failure;
use leg_model::TendonCurve;
use leg_model_tools::tensile::{self, Fit, TensileError};
use leg_rig::curve_toml;
use std::path::{Path, PathBuf};

/// Turns a tensile test of a tendon into the curve of a rig file.
///
/// The file is CSV. Its header names one column for the force (force_n or force_kn) and one for the elongation
/// (elongation_mm, elongation_um or elongation_m); lines that begin with # are comments. The branch up to the largest
/// force is the curve; rows after it tell the hysteresis.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The tensile test.
    file: PathBuf,
    /// Rows below this force are slack that is taken up, N; a thousandth of the largest force if left out.
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    taut_n: Option<f64>,
    /// Length of the test piece, mm, where it is not that of the tendon.
    #[arg(long, value_name = "MM", allow_negative_numbers = true, requires_all = ["diameter_mm", "tendon_length_mm", "tendon_diameter_mm"])]
    length_mm: Option<f64>,
    /// Diameter of the test piece, mm.
    #[arg(
        long,
        value_name = "MM",
        allow_negative_numbers = true,
        requires = "length_mm"
    )]
    diameter_mm: Option<f64>,
    /// Length of the tendon, mm.
    #[arg(
        long,
        value_name = "MM",
        allow_negative_numbers = true,
        requires = "length_mm"
    )]
    tendon_length_mm: Option<f64>,
    /// Diameter of the tendon, mm.
    #[arg(
        long,
        value_name = "MM",
        allow_negative_numbers = true,
        requires = "length_mm"
    )]
    tendon_diameter_mm: Option<f64>,
    /// Writes the section for a rig file here instead of printing it.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Draws elongation and stiffness over tension into this directory, as the paper's Fig. 6 does.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    /// Prints JSON instead of a table.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: a test that gives no curve, by line and column; files that cannot be written.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    check_taut(args.taut_n)?;
    let scale = scale::of(args)?;
    let test = tensile::read(&args.file).map_err(|error| refused(&args.file, &error))?;
    let fit = Fit::new(&test, args.taut_n).map_err(|error| refused(&args.file, &error))?;
    let points: Vec<_> = fit.points.iter().map(|point| scale.apply(point)).collect();
    TendonCurve::new(&points).map_err(no_tendon)?;
    let toml = curve_toml::section(&points);
    let plots = save_all(args, &fit, &toml)?;
    let report = Report {
        fit: &fit,
        points: &points,
        strain: args.length_mm.map(|length_mm| strain(&fit, length_mm)),
        out: args.out.as_deref(),
        plots: &plots,
    };
    if args.json {
        return print(&report.json()?);
    }
    let printed = if args.out.is_some() { "" } else { &toml };
    print(&(report.table() + printed))
}

/// Everything that is asked for, or nothing: the charts are drawn beside their places before the section is written.
fn save_all(args: &Args, fit: &Fit, toml: &str) -> Result<Vec<PathBuf>, Failure> {
    let charts = match &args.plots {
        Some(directory) => Some(Charts::draw(fit, directory)?),
        None => None,
    };
    if let Some(file) = &args.out {
        save(file, toml)?;
    }
    charts.map_or_else(|| Ok(Vec::new()), Charts::deliver)
}

/// The largest strain of the test piece.
fn strain(fit: &Fit, length_mm: f64) -> f64 {
    let elongations_mm = fit.rows.iter().map(|row| row.elongation_m * 1e3);
    elongations_mm.fold(0.0, f64::max) / length_mm
}

fn refused(file: &Path, error: &TensileError) -> Failure {
    let help = "`leg curve --help` tells what the file has to be";
    Failure::refused(format!("{}: {error}", file.display()), help)
}

fn no_tendon(error: leg_model::Error) -> Failure {
    let help = "the sizes of the test piece and of the tendon are in millimetres";
    Failure::refused(format!("scaled to the tendon: {error}"), help)
}

fn check_taut(taut_n: Option<f64>) -> Result<(), Failure> {
    match taut_n {
        Some(force) if !(force.is_finite() && force >= 0.0) => {
            let sentence = format!("--taut-n {force} is no force");
            Err(Failure::refused(sentence, "give a force from 0 N up"))
        }
        _ => Ok(()),
    }
}

fn save(file: &Path, text: &str) -> Result<(), Failure> {
    atomic_file::replace(file, |new| std::fs::write(new, text)).map_err(|error: std::io::Error| {
        let sentence = format!("cannot write {}: {error}", file.display());
        Failure::refused(sentence, "name a file in a directory that may be written")
    })
}
