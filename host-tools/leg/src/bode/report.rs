//! What `leg bode` prints.

use leg_base::paths::relative_path;
use leg_bench::bode::{Feedback, Margin, Row, Swept, Worst};
use std::path::PathBuf;

const HEADING: &str =
    "loop      added   margin       at Hz  place         azimuth  tilt    kg       N\n";

/// A table for people.
pub(super) fn table(rows: &[Row], swept: &[Swept], files: &[PathBuf]) -> String {
    let lines: String = rows.iter().map(line).collect();
    let ended: String = swept.iter().filter_map(failure).collect();
    let files = files
        .iter()
        .map(|file| format!("File: {}\n", relative_path(file).display()));
    format!("{HEADING}{lines}{ended}\n{}", files.collect::<String>())
}

fn line(row: &Row) -> String {
    let added = format!("{:.1} {}", row.amplitude, unit(row.feedback));
    let name = row.feedback.name();
    let (bar, unit) = (row.margin.bar(), row.margin.unit());
    let verdict = if row.failed == 0 {
        "pass".to_string()
    } else {
        format!(
            "FAIL: {} of {} below {bar} {unit}",
            row.failed, row.measured
        )
    };
    let Some(worst) = &row.worst else {
        let none = match row.margin {
            Margin::Gain => "phase never ±180°",
            Margin::Phase => "gain never 1",
        };
        return format!("{name:8}  {added:6}  {none:60}  {verdict}\n");
    };
    let Worst {
        value,
        hz,
        place,
        state,
        ..
    } = worst;
    let [azimuth, tilt] = state.pose_deg;
    format!(
        "{name:8}  {added:6}  {value:6.1} {unit:3}  {hz:7.2}  {place:12}  {azimuth:7.1}  {tilt:4.1}  {:4.2}  {:6.1}  {verdict}\n",
        state.payload_kg, state.pretension_n,
    )
}

/// What ended a measurement.
fn failure(swept: &Swept) -> Option<String> {
    let why = swept.failure.as_ref()?;
    let (name, number) = (swept.feedback.name(), swept.state.number);
    Some(format!(
        "{name} at {} in state {number}: {why}\n",
        swept.place
    ))
}

/// The unit of what is added.
pub(super) const fn unit(feedback: Feedback) -> &'static str {
    match feedback {
        Feedback::Servo => "V",
        Feedback::Damping | Feedback::Tension | Feedback::Trim => "N",
    }
}

/// Which loops failed, as a sentence.
pub(super) fn failed(rows: &[Row]) -> String {
    let failed = rows.iter().filter(|row| row.failed > 0);
    let words: Vec<_> = failed
        .map(|row| {
            let name = row.feedback.name();
            let (bar, unit) = (row.margin.bar(), row.margin.unit());
            match &row.worst {
                Some(worst) if worst.value < bar => {
                    let value = worst.value;
                    format!("{name} has {value:.1} {unit}, less than {bar} {unit}")
                }
                _ => format!("{name} could not be measured"),
            }
        })
        .collect();
    words.join("; ")
}
