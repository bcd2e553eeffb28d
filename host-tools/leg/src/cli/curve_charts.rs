//! The charts of `leg curve`, as the paper's Fig. 6 has them.

use leg_base::atomic_file::Workshop;
use leg_base::failure::Failure;
use leg_model::{Elasticity, TendonCurve};
use leg_model_tools::plot::{self, Chart, Line, PlotError};
use leg_model_tools::tensile::{Fit, Row};
use std::error::Error;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Steps of a drawn line.
const STEPS: i32 = 400;

/// More marks than this hide the line.
const MARKS_MAX: usize = 80;

/// A quantity over the tension: its file, its title with the unit, the curve's line and the measured marks.
type Panel = (&'static str, &'static str, Points, Points);

type Points = Vec<(f64, f64)>;

/// Elongation and stiffness of the test piece, each as SVG and PNG, drawn but not yet in their directory.
pub(super) struct Charts<'a> {
    directory: &'a Path,
    workshop: Workshop,
    /// The names of the SVG files.
    names: Vec<OsString>,
}

impl<'a> Charts<'a> {
    /// Draws them.
    pub(super) fn draw(fit: &Fit, directory: &'a Path) -> Result<Self, Failure> {
        let panels = panels(fit).map_err(|error| Failure::from_error(&error))?;
        let workshop = Workshop::beside(directory).map_err(|error| refused(directory, &error))?;
        let mut names = Vec::new();
        for panel in panels {
            let svg = save(panel, workshop.path()).map_err(|error| refused(directory, &error))?;
            names.extend(svg.file_name().map(OsString::from));
        }
        workshop
            .check()
            .map_err(|error| refused(directory, &error))?;
        Ok(Self {
            directory,
            workshop,
            names,
        })
    }

    /// Moves them into their directory, and names the SVG files.
    pub(super) fn deliver(self) -> Result<Vec<PathBuf>, Failure> {
        let delivered = self.workshop.deliver();
        delivered.map_err(|error| refused(self.directory, &error))?;
        let in_folder = |name| self.directory.join(name);
        Ok(self.names.into_iter().map(in_folder).collect())
    }
}

fn refused(directory: &Path, error: &dyn Error) -> Failure {
    let sentence = format!("no plots in {}: {error}", directory.display());
    Failure::refused(sentence, "name another directory with --plots")
}

fn panels(fit: &Fit) -> Result<[Panel; 2], leg_model::Error> {
    let curve = TendonCurve::new(&fit.points)?;
    let marked = thinned(&fit.rows);
    Ok([
        (
            "curve_elongation",
            "elongation (mm)",
            line(&curve, |force| Ok(curve.elongation(force)? * 1e3))?,
            marked
                .iter()
                .map(|row| (row.force_n, row.elongation_m * 1e3))
                .collect(),
        ),
        (
            "curve_stiffness",
            "stiffness (N/mm)",
            line(&curve, |force| Ok(curve.stiffness(force)? * 1e-3))?,
            marked.windows(2).map(average_stiffness).collect(),
        ),
    ])
}

fn line(
    curve: &TendonCurve<f64>,
    of: impl Fn(f64) -> Result<f64, leg_model::Error>,
) -> Result<Points, leg_model::Error> {
    let last = curve.tension_max_n();
    let point = |step| {
        let force = last * (f64::from(step) / f64::from(STEPS));
        Ok((force, of(force)?))
    };
    (0..=STEPS).map(point).collect()
}

/// Every so many rows, evenly.
fn thinned(rows: &[Row]) -> Vec<Row> {
    let every = rows.len().div_ceil(MARKS_MAX).max(1);
    rows.iter().copied().step_by(every).collect()
}

/// Half-way between two rows, N and N/mm.
fn average_stiffness(pair: &[Row]) -> (f64, f64) {
    let [before, .., after] = pair else {
        return (f64::NAN, f64::NAN);
    };
    let rise_n = after.force_n - before.force_n;
    let stretch_mm = (after.elongation_m - before.elongation_m) * 1e3;
    (before.force_n + 0.5 * rise_n, rise_n / stretch_mm)
}

fn save((name, y_title, points, marks): Panel, directory: &Path) -> Result<PathBuf, PlotError> {
    let chart = Chart {
        title: format!("Tensile test: {y_title} over tension"),
        x_title: "tension (N)".into(),
        y_title: y_title.into(),
        lines: vec![Line {
            label: "curve".into(),
            points,
            marks,
        }],
        marks_label: "measured".into(),
    };
    plot::save_both(&chart, &directory.join(name))
}
