//! `leg curve`.

mod charts;
mod report;

use crate::numbers::{not_negative, positive};
use crate::options::Options;
use crate::output;
use leg_base::failure::Failure;
use leg_model::{CurvePoint, TendonCurve};
use leg_model_tools::tensile::{self, Fit, TensileError};
use leg_rig::curve_toml;
use report::CurveReport;
use std::path::{Path, PathBuf};

/// Turns a tensile test of a tendon into the curve of a rig file.
///
/// The file is CSV. Its header names one column for the force (force_n or force_kn) and one for the elongation
/// (elongation_mm, elongation_um or elongation_m); lines that begin with # are comments. The branch up to the largest
/// force is the curve; rows after it give the hysteresis.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The tensile test.
    file: PathBuf,
    /// Rows below this force count as slack, N; a thousandth of the largest force if left out.
    #[arg(long, value_name = "N", value_parser = not_negative)]
    taut_n: Option<f64>,
    /// Length of the test piece, mm, where it is not that of the tendon.
    #[arg(long, value_name = "MM", value_parser = positive, requires_all = ["diameter_mm", "tendon_length_mm", "tendon_diameter_mm"])]
    length_mm: Option<f64>,
    /// Diameter of the test piece, mm.
    #[arg(long, value_name = "MM", value_parser = positive, requires = "length_mm")]
    diameter_mm: Option<f64>,
    /// Length of the tendon, mm.
    #[arg(long, value_name = "MM", value_parser = positive, requires = "length_mm")]
    tendon_length_mm: Option<f64>,
    /// Diameter of the tendon, mm.
    #[arg(long, value_name = "MM", value_parser = positive, requires = "length_mm")]
    tendon_diameter_mm: Option<f64>,
    /// Writes the section for a rig file here instead of printing it.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Draws elongation and stiffness over tension into this directory, as the paper's Fig. 6 does.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let test = tensile::read(&args.file).map_err(|error| refused(&args.file, &error))?;
    let fit = Fit::new(&test, args.taut_n).map_err(|error| refused(&args.file, &error))?;
    let points: Vec<_> = fit.points.iter().map(|point| args.scaled(point)).collect();
    TendonCurve::new(&points).map_err(no_tendon)?;
    let section = curve_toml::section(&points);
    let plots = save(args, &fit, &section)?;
    let report = CurveReport {
        fit: &fit,
        points: &points,
        length_mm: args.length_mm,
        out: args.out.as_deref(),
        plots: &plots,
    };
    options.report(&report.json(), || {
        let printed = if args.out.is_some() { "" } else { &section };
        report.table() + printed
    })
}

/// Everything that is asked for, or nothing: the charts are drawn beside their places before the section is written.
fn save(args: &Args, fit: &Fit, section: &str) -> Result<Vec<PathBuf>, Failure> {
    let write_section = || match &args.out {
        Some(file) => output::write(Some(file), section),
        None => Ok(()),
    };
    let Some(directory) = &args.plots else {
        return write_section().map(|()| Vec::new());
    };
    let draw = |path: &Path| charts::draw(fit, path);
    let names = output::save_all("plots", directory, "--plots", draw, write_section)?;
    Ok(names.iter().map(|name| directory.join(name)).collect())
}

fn refused(file: &Path, error: &TensileError) -> Failure {
    let help = "`leg curve --help` describes the file";
    Failure::refused(format!("{}: {error}", file.display()), help)
}

fn no_tendon(error: leg_model::Error) -> Failure {
    let help = "the sizes of the test piece and of the tendon are in millimetres";
    Failure::refused(format!("scaled to the tendon: {error}"), help)
}

impl Args {
    /// A point of the test piece's curve on the curve of the tendon; the same where no sizes are given.
    fn scaled(&self, point: &CurvePoint<f64>) -> CurvePoint<f64> {
        let ratio =
            |tendon: Option<f64>, piece: Option<f64>| tendon.unwrap_or(1.0) / piece.unwrap_or(1.0);
        let diameter_ratio = ratio(self.tendon_diameter_mm, self.diameter_mm);
        let length_ratio = ratio(self.tendon_length_mm, self.length_mm);
        point.scaled(length_ratio, diameter_ratio * diameter_ratio)
    }
}
