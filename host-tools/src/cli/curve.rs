//! `leg curve`.

use super::curve_charts::draw;
use super::curve_report::Report;
use super::print;
use crate::failure::Failure;
use crate::tensile::{self, Fit, TensileError};
use crate::{atomic_file, curve_toml};
use leg_model::{CurvePoint, TendonCurve};
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
    #[arg(long, value_name = "N")]
    taut_n: Option<f64>,
    /// Length of the test piece, mm, where it is not that of the tendon.
    #[arg(long, value_name = "MM", requires_all = ["diameter_mm", "tendon_length_mm", "tendon_diameter_mm"])]
    length_mm: Option<f64>,
    /// Diameter of the test piece, mm.
    #[arg(long, value_name = "MM", requires = "length_mm")]
    diameter_mm: Option<f64>,
    /// Length of the tendon, mm.
    #[arg(long, value_name = "MM", requires = "length_mm")]
    tendon_length_mm: Option<f64>,
    /// Diameter of the tendon, mm.
    #[arg(long, value_name = "MM", requires = "length_mm")]
    tendon_diameter_mm: Option<f64>,
    /// Writes the section for a rig file here instead of printing it.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Draws elongation and stiffness over tension into this folder, as the paper's Fig. 6 does.
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
    let scale = scale(args)?;
    let test = tensile::read(&args.file).map_err(|error| refused(&args.file, &error))?;
    let fit = Fit::new(&test, args.taut_n).map_err(|error| refused(&args.file, &error))?;
    let points: Vec<_> = fit.points.iter().map(|point| scale.apply(point)).collect();
    TendonCurve::new(&points).map_err(no_tendon)?;
    let toml = curve_toml::section(&points);
    if let Some(file) = &args.out {
        save(file, &toml)?;
    }
    let plots = match &args.plots {
        Some(folder) => Some(draw(&fit, folder)?),
        None => None,
    };
    let report = Report {
        fit: &fit,
        points: &points,
        out: args.out.as_deref(),
        plots: plots.as_deref().unwrap_or_default(),
    };
    if args.json {
        return print(&report.json()?);
    }
    let printed = if args.out.is_some() { "" } else { &toml };
    print(&(report.table() + printed))
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

/// From the test piece to the tendon.
struct Scale {
    length_ratio: f64,
    section_ratio: f64,
}

impl Scale {
    fn apply(&self, point: &CurvePoint<f64>) -> CurvePoint<f64> {
        point.scaled(self.length_ratio, self.section_ratio)
    }
}

fn scale(args: &Args) -> Result<Scale, Failure> {
    let sizes = [
        ("--length-mm", args.length_mm),
        ("--diameter-mm", args.diameter_mm),
        ("--tendon-length-mm", args.tendon_length_mm),
        ("--tendon-diameter-mm", args.tendon_diameter_mm),
    ];
    for (name, size) in sizes {
        if size.is_some_and(|size| !(size.is_finite() && size > 0.0)) {
            let sentence = format!("{name} has to be greater than zero");
            return Err(Failure::refused(sentence, "give the size in millimetres"));
        }
    }
    let ratio =
        |tendon: Option<f64>, piece: Option<f64>| tendon.unwrap_or(1.0) / piece.unwrap_or(1.0);
    let diameter_ratio = ratio(args.tendon_diameter_mm, args.diameter_mm);
    Ok(Scale {
        length_ratio: ratio(args.tendon_length_mm, args.length_mm),
        section_ratio: diameter_ratio * diameter_ratio,
    })
}

fn save(file: &Path, text: &str) -> Result<(), Failure> {
    atomic_file::replace(file, |new| std::fs::write(new, text)).map_err(|error: std::io::Error| {
        let sentence = format!("cannot write {}: {error}", file.display());
        Failure::refused(sentence, "name a file in a folder that may be written")
    })
}
