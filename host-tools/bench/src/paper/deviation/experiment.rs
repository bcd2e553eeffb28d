//! The paper's experiment, which cannot be repeated here: its errors beside those of the linear model against the
//! nonlinear equilibrium.

use super::{MAXIMA, deviations, tilts_deg};
use crate::paper::row::{PaperRow, Topic};
use leg_model::Error;
use leg_rig::rig_file::RigFile;

/// Average error of theory against experiment for each payload, percent.
const AVERAGES: [f64; 4] = [3.1, 3.8, 2.5, 4.2];

/// The same over all payloads, percent.
const AVERAGE: f64 = 3.4;

/// Smallest and largest error over the workspace, percent.
const WORKSPACE: [f64; 2] = [0.9, 4.7];

/// The limit of the error in Fig. 9 (b), mm.
const LIMIT_MM: f64 = 0.6;

const WHY: &str = "the paper's is theory against its experiment, which is not at hand; ours is the linear model against the nonlinear equilibrium";

/// Percent and mm by which the linear deviation is off the equilibrium at every tilt but zero.
fn errors(rig: &RigFile, payload_kg: f64) -> Result<Vec<(f64, f64)>, Error> {
    let error = |tilt_deg| {
        let d = deviations(rig, tilt_deg, payload_kg)?;
        let off_mm = (d.linear - d.nonlinear).abs();
        Ok((100.0 * off_mm / d.nonlinear, off_mm))
    };
    tilts_deg().filter(|tilt| *tilt != 0.0).map(error).collect()
}

fn average(errors: &[(f64, f64)]) -> f64 {
    errors.iter().map(|(percent, _)| percent).sum::<f64>() / errors.len() as f64
}

pub(super) fn rows(rig: &RigFile) -> Result<Vec<PaperRow>, Error> {
    let row = |what: &str, published, ours, unit| {
        PaperRow::new(Topic::Deviation, what, (published, ours), (unit, 2), WHY).unrepeatable()
    };
    let (mut rows, mut all) = (Vec::new(), Vec::new());
    for ((payload_kg, _), published) in MAXIMA.into_iter().zip(AVERAGES) {
        let errors = errors(rig, payload_kg)?;
        let what = format!("average error against the experiment with {payload_kg} kg");
        rows.push(row(&what, published, average(&errors), "%"));
        all.extend(errors);
    }
    let percents = || all.iter().map(|(percent, _)| *percent);
    let smallest = percents().fold(f64::INFINITY, f64::min);
    let largest = percents().fold(0.0, f64::max);
    let largest_mm = all.iter().map(|(_, off_mm)| *off_mm).fold(0.0, f64::max);
    let [min, max] = WORKSPACE;
    let overall = "average error against the experiment, all payloads";
    let over = "error against the experiment over the workspace; ours along azimuth 30°";
    rows.extend([
        row(overall, AVERAGE, average(&all), "%"),
        row(&format!("smallest {over}"), min, smallest, "%"),
        row(&format!("largest {over}"), max, largest, "%"),
        row(
            "limit of the error in Fig. 9 (b), ±",
            LIMIT_MM,
            largest_mm,
            "mm",
        ),
    ]);
    Ok(rows)
}
