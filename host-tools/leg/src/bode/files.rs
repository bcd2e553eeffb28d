//! The plots of `leg bode`, and its points as CSV.

use super::report::unit;
use crate::output::save_all;
use leg_base::failure::Failure;
use leg_bench::bode::{Feedback, Margin, MarginRow, ResponsePoint, Swept};
use leg_bench::plot::bode::{self, BodeLine, BodeMargin, BodePlot, BodePoint};
use leg_boards::image;
use std::error::Error;
use std::path::{Path, PathBuf};

const CSV: &str = "bode.csv";

/// Saves a plot for each loop and one table; names the SVG files and the table.
pub(super) fn save(
    directory: Option<&Path>,
    swept: &[Swept],
    rows: &[MarginRow],
) -> Result<Vec<PathBuf>, Failure> {
    let default = || image::workspace_root().join("target/leg-bode");
    let directory = directory.map_or_else(default, Path::to_path_buf);
    let names = save_all(
        "plot",
        &directory,
        "--out",
        |staging| draw(staging, swept, rows),
        || Ok(()),
    )?;
    Ok(names.into_iter().map(|name| directory.join(name)).collect())
}

fn draw(
    staging: &Path,
    swept: &[Swept],
    rows: &[MarginRow],
) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut names = Vec::new();
    for feedback in Feedback::ALL {
        let measured = || swept.iter().filter(|one| one.feedback == feedback);
        let others: Vec<_> = measured().map(|one| points(&one.points)).collect();
        if others.iter().any(|points| !points.is_empty()) {
            let plot = BodePlot {
                title: format!("{}: {} measurements", title(feedback), others.len()),
                others_label: "all measurements".into(),
                others,
                named: named(feedback, swept, rows),
            };
            let picture = bode::save(&plot, &staging.join(feedback.name()))?;
            names.extend(picture.file_name().map(PathBuf::from));
        }
    }
    write_points(&staging.join(CSV), swept)?;
    names.push(CSV.into());
    Ok(names)
}

const fn title(feedback: Feedback) -> &'static str {
    match feedback {
        Feedback::Servo => "Servo of a motor, broken at its voltage",
        Feedback::Damping => "Damping of the swing, broken at the tendons' lengths",
        Feedback::Tension => "Tensions, broken at the moments of the load cells",
        Feedback::Trim => "Trim of the pretension, broken at the load cells",
    }
}

fn points(points: &[ResponsePoint]) -> Vec<BodePoint> {
    let point = |point: &ResponsePoint| BodePoint {
        hz: point.hz,
        gain_db: point.gain_db,
        phase_deg: point.phase_deg,
    };
    points.iter().map(point).collect()
}

/// The worst of each amplitude and margin.
fn named(feedback: Feedback, swept: &[Swept], rows: &[MarginRow]) -> Vec<BodeLine> {
    let rows = rows.iter().filter(|row| row.feedback == feedback);
    let line = |row: &MarginRow| {
        let worst = row.worst.as_ref()?;
        let (value, hz, bar, unit_of) =
            (worst.value, worst.hz, row.margin.bar(), row.margin.unit());
        let (name, margin) = match row.margin {
            Margin::Gain => ("gain", BodeMargin::Gain(hz, value)),
            Margin::Phase => ("phase", BodeMargin::Phase(hz, value)),
        };
        let verdict = if value < bar { "FAIL" } else { "pass" };
        Some(BodeLine {
            label: vec![
                format!("worst {name} margin"),
                format!("{value:.1} {unit_of} at {hz:.1} Hz"),
                format!("with {:.1} {}: {verdict}", row.amplitude, unit(feedback)),
            ],
            points: points(&swept[worst.index].points),
            margin: Some(margin),
        })
    };
    rows.filter_map(line).collect()
}

const COLUMNS: [&str; 12] = [
    "loop",
    "place",
    "amplitude",
    "state",
    "rig",
    "azimuth_deg",
    "tilt_deg",
    "payload_kg",
    "pretension_n",
    "hz",
    "gain_db",
    "phase_deg",
];

fn write_points(file: &Path, swept: &[Swept]) -> Result<(), Box<dyn Error>> {
    let mut writer = csv::Writer::from_path(file)?;
    writer.write_record(COLUMNS)?;
    for one in swept {
        let state = &one.state;
        let [azimuth, tilt] = state.pose_deg;
        for point in &one.points {
            let numbers = [azimuth, tilt, state.payload_kg, state.pretension_n];
            let numbers = numbers
                .into_iter()
                .chain([point.hz, point.gain_db, point.phase_deg]);
            let what = [
                one.feedback.name().into(),
                one.place.into(),
                (one.amplitude * point.part).to_string(),
                state.number.to_string(),
                state.rig.clone(),
            ];
            writer.write_record(what.into_iter().chain(numbers.map(|n| n.to_string())))?;
        }
    }
    Ok(writer.flush()?)
}
