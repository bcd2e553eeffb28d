//! Figures 6, 9 and 10.

use super::PaperError;
use super::deviation::{AZIMUTH_DEG, Deviations, MAXIMA, deviations, tilts_deg};
use super::tendon::PUBLISHED;
use super::workspace::{PAYLOAD_KG, SPREAD_PERCENT, spread_at};
use crate::plot::{Chart, ChartLine, PlotError, field};
use leg_model::{Elasticity, Error, Query, Tendon};
use leg_model_tools::workspace_map::{Grid, MapQuantity, WorkspaceMap};
use leg_rig::rig_file::RigFile;
use std::path::{Path, PathBuf};

/// Why a figure was not drawn.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// There are no numbers for it.
    #[error(transparent)]
    Paper(#[from] PaperError),
    /// It could not be drawn.
    #[error(transparent)]
    Plot(#[from] PlotError),
}

impl From<Error> for FigureError {
    fn from(error: Error) -> Self {
        Self::Paper(error.into())
    }
}

/// Draws every figure into a directory, as SVG, PNG and PDF, and names the SVG files with their captions.
///
/// # Errors
/// A [`FigureError`].
pub fn draw(directory: &Path) -> Result<Vec<(PathBuf, &'static str)>, FigureError> {
    let rig = RigFile::load(None).map_err(PaperError::from)?;
    let mut figures = Vec::new();
    for (name, chart, caption) in charts(&rig)? {
        figures.push((crate::plot::save(&chart, &directory.join(name))?, caption));
    }
    let mut map = workspace_field(&rig)?;
    let maps = [
        (
            "fig10a",
            field::Layout::Polar,
            "Fig. 10 a: deviation of the tip with 1 kg",
            "Fig. 10 a: deviation over the workspace with 1 kg, from above",
        ),
        (
            "fig10b",
            field::Layout::Flat,
            "Fig. 10 b: deviation of the tip with 1 kg",
            "Fig. 10 b: the same over azimuth and tilt",
        ),
    ];
    for (name, layout, title, caption) in maps {
        map.title = title.into();
        let drawn = field::save(&map, layout, &directory.join(name))?;
        figures.push((drawn, caption));
    }
    Ok(figures)
}

/// The charts, each with the name of its file and its caption.
fn charts(rig: &RigFile) -> Result<[(&'static str, Chart, &'static str); 6], Error> {
    let elongation = tendon_points(rig, |tendon, tension| Ok(tendon.elongation(tension)? * 1e3))?;
    let stiffness = tendon_points(rig, |tendon, tension| Ok(tendon.stiffness(tension)? * 1e-3))?;
    let published = PUBLISHED.map(|(tension, stiffness)| (tension, stiffness * 1e-3));
    Ok([
        (
            "fig6_elongation",
            tendon_chart("elongation (mm)", elongation, &[]),
            "Fig. 6: elongation of the default tendon over its tension",
        ),
        (
            "fig6_stiffness",
            tendon_chart("stiffness (N/mm)", stiffness, &published),
            "Fig. 6: its stiffness, with the published points",
        ),
        (
            "fig9a",
            deviation_chart(
                ["Fig. 9 a: deviation of the tip", "deviation (mm)"],
                deviation_lines(rig, |d| d.linear, |d, _| Some(d.nonlinear))?,
                "nonlinear",
            ),
            "Fig. 9 a: linear deviation (lines) and nonlinear equilibrium (crosses)",
        ),
        (
            "fig9a_published",
            deviation_chart(
                ["Fig. 9 a: ours and the published maxima", "deviation (mm)"],
                deviation_lines(rig, |d| d.linear, |_, maximum_mm| maximum_mm)?,
                "published maximum",
            ),
            "Fig. 9 a: linear deviation (lines) and the maxima that the paper's text gives (crosses, at both ends)",
        ),
        (
            "fig9b",
            deviation_chart(
                ["Fig. 9 b: linear less nonlinear", "difference (mm)"],
                deviation_lines(rig, |d| d.linear - d.nonlinear, |_, _| None)?,
                "",
            ),
            "Fig. 9 b: linear deviation less nonlinear equilibrium",
        ),
        (
            "fig10_published",
            spread_chart(rig)?,
            "Fig. 10: how far the deviation differs over the azimuth, beside the most that the paper's text gives",
        ),
    ])
}

/// A quantity of the first tendon over its tension.
fn tendon_points(
    rig: &RigFile,
    quantity: impl Fn(&Tendon<f64>, f64) -> Result<f64, Error>,
) -> Result<Vec<(f64, f64)>, Error> {
    let [tendon, ..] = &rig.tendons;
    (0..=300)
        .map(|step| 0.5 * f64::from(step))
        .map(|tension| Ok((tension, quantity(tendon, tension)?)))
        .collect()
}

fn tendon_chart(y_title: &str, points: Vec<(f64, f64)>, marks: &[(f64, f64)]) -> Chart {
    Chart {
        title: format!("Fig. 6: {y_title} of the tendon"),
        x_title: "tension (N)".into(),
        y_title: y_title.into(),
        lines: vec![ChartLine {
            label: "default curve".into(),
            points,
            marks: marks.into(),
        }],
        marks_label: "published".into(),
        ..Chart::default()
    }
}

/// A line for each payload. `mark` takes the maximum that the paper gives, at the ends of the tilts.
fn deviation_lines(
    rig: &RigFile,
    value: fn(&Deviations) -> f64,
    mark: fn(&Deviations, Option<f64>) -> Option<f64>,
) -> Result<Vec<ChartLine>, Error> {
    let tilt_max_deg = tilts_deg().fold(0.0, f64::max);
    let line = |(payload_kg, maximum_mm)| {
        let (mut points, mut marks) = (Vec::new(), Vec::new());
        for tilt_deg in tilts_deg() {
            let d = deviations(rig, tilt_deg, payload_kg)?;
            points.push((tilt_deg, value(&d)));
            let published = (tilt_deg.abs() == tilt_max_deg).then_some(maximum_mm);
            marks.extend(mark(&d, published).map(|value| (tilt_deg, value)));
        }
        Ok(ChartLine {
            label: format!("payload {payload_kg} kg"),
            points,
            marks,
        })
    };
    MAXIMA.into_iter().map(line).collect()
}

fn deviation_chart([title, y_title]: [&str; 2], lines: Vec<ChartLine>, marks_label: &str) -> Chart {
    Chart {
        title: title.into(),
        x_title: format!("tilt (°) along azimuth {AZIMUTH_DEG}°"),
        y_title: y_title.into(),
        lines,
        marks_label: marks_label.into(),
        ..Chart::default()
    }
}

/// Over the tilts of Fig. 10, all that its text gives in numbers.
fn spread_chart(rig: &RigFile) -> Result<Chart, Error> {
    let ours = (1..=30)
        .map(f64::from)
        .map(|tilt_deg| Ok((tilt_deg, spread_at(rig, tilt_deg)?)))
        .collect::<Result<Vec<_>, Error>>()?;
    let published = [0.0, 30.0].map(|tilt_deg| (tilt_deg, SPREAD_PERCENT));
    let line = |label: &str, points| ChartLine {
        label: label.into(),
        points,
        marks: Vec::new(),
    };
    Ok(Chart {
        title: "Fig. 10: deviation over the azimuth, ours and published".into(),
        x_title: "tilt (°)".into(),
        y_title: format!("largest less smallest with {PAYLOAD_KG} kg (% of the mean)"),
        lines: vec![
            line("ours", ours),
            line("published, at most", published.into()),
        ],
        ..Chart::default()
    })
}

fn workspace_field(rig: &RigFile) -> Result<field::PlotField, Error> {
    let grid = Grid {
        azimuths: 360,
        tilts: 31,
    };
    let Query { tendons, .. } = super::deviation::constant(rig, 0.0, 0.0, PAYLOAD_KG)?;
    let rig = RigFile { tendons, ..*rig };
    let map = WorkspaceMap::compute(&rig, PAYLOAD_KG, grid, false, || ());
    Ok(field::PlotField::workspace(
        &map,
        MapQuantity::Deviation,
        String::new(),
    ))
}
