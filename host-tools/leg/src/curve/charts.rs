//! The charts of `leg curve`, as the paper's Fig. 6 has them.

use leg_bench::plot::{Chart, ChartLine, PlotError};
use leg_model::{Elasticity, TendonCurve};
use leg_model_tools::tensile::{Fit, TestRow};
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

/// Draws elongation and stiffness of the test piece, each as SVG, PNG and PDF, and names the SVG files.
pub(super) fn draw(fit: &Fit, directory: &Path) -> Result<Vec<OsString>, Box<dyn Error>> {
    let mut names = Vec::new();
    for panel in panels(fit)? {
        names.extend(save(panel, directory)?.file_name().map(OsString::from));
    }
    Ok(names)
}

fn panels(fit: &Fit) -> Result<[Panel; 2], leg_model::Error> {
    let curve = TendonCurve::new(&fit.points)?;
    let marked = thinned(&fit.rows);
    Ok([
        (
            "curve_elongation",
            "elongation (mm)",
            line(&curve, |force_n| Ok(curve.elongation(force_n)? * 1e3))?,
            marked
                .iter()
                .map(|row| (row.force_n, row.elongation_m * 1e3))
                .collect(),
        ),
        (
            "curve_stiffness",
            "stiffness (N/mm)",
            line(&curve, |force_n| Ok(curve.stiffness(force_n)? * 1e-3))?,
            marked.windows(2).map(average_stiffness).collect(),
        ),
    ])
}

fn line(
    curve: &TendonCurve<f64>,
    value: impl Fn(f64) -> Result<f64, leg_model::Error>,
) -> Result<Points, leg_model::Error> {
    let last = curve.tension_max_n();
    let point = |step| {
        let force = last * (f64::from(step) / f64::from(STEPS));
        Ok((force, value(force)?))
    };
    (0..=STEPS).map(point).collect()
}

/// Every so many rows, evenly.
fn thinned(rows: &[TestRow]) -> Vec<TestRow> {
    let every = rows.len().div_ceil(MARKS_MAX).max(1);
    rows.iter().copied().step_by(every).collect()
}

/// Half-way between two rows, N and N/mm.
fn average_stiffness(pair: &[TestRow]) -> (f64, f64) {
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
        lines: vec![ChartLine {
            label: "curve".into(),
            points,
            marks,
        }],
        marks_label: "measured".into(),
        ..Chart::default()
    };
    leg_bench::plot::save(&chart, &directory.join(name))
}
