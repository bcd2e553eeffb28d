//! What `leg bode` prints.

use leg_base::paths::relative_path;
use leg_bench::bode::{Feedback, Margin, MarginRow, Swept, WorstMargin};
use std::path::PathBuf;

const HEADING: &str =
    "loop      added   margin       at Hz  place         azimuth  tilt    kg       N\n";

/// A table for people.
pub(super) fn table(rows: &[MarginRow], swept: &[Swept], files: &[PathBuf]) -> String {
    let lines: String = rows.iter().map(line).collect();
    let ended: String = swept.iter().filter_map(failure).collect();
    let files = files
        .iter()
        .map(|file| format!("File: {}\n", relative_path(file).display()));
    format!("{HEADING}{lines}{ended}\n{}", files.collect::<String>())
}

fn line(row: &MarginRow) -> String {
    let added = format!("{:.1} {}", row.amplitude, unit(row.feedback));
    let name = row.feedback.name();
    let unit = row.margin.unit();
    let verdict = verdict(row);
    let Some(worst) = &row.worst else {
        let none = match row.margin {
            Margin::Gain => "phase never ±180°",
            Margin::Phase => "gain never 1",
        };
        return format!("{name:8}  {added:6}  {none:60}  {verdict}\n");
    };
    let WorstMargin {
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

/// Whether a row passes, or how many of its measurements do not and why.
fn verdict(row: &MarginRow) -> String {
    if row.passes() {
        return "pass".into();
    }
    let (bar, unit, all) = (row.margin.bar(), row.margin.unit(), row.measured);
    let low = (row.low > 0).then(|| format!("{} of {all} below {bar} {unit}", row.low));
    let ended = (row.ended > 0).then(|| format!("{} of {all} not measured", row.ended));
    let why: Vec<_> = low.into_iter().chain(ended).collect();
    format!("FAIL: {}", why.join(", "))
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
pub(super) fn failed(rows: &[MarginRow]) -> String {
    let low = rows.iter().filter(|row| row.low > 0).filter_map(|row| {
        let (bar, unit, value) = (
            row.margin.bar(),
            row.margin.unit(),
            row.worst.as_ref()?.value,
        );
        let name = row.feedback.name();
        Some(format!(
            "{name} has {value:.1} {unit}, less than {bar} {unit}"
        ))
    });
    // Both margins lack the same measurements.
    let ended = rows
        .iter()
        .filter(|row| row.ended > 0 && row.margin == Margin::Gain);
    let ended = ended.map(|row| {
        let (name, added, unit) = (row.feedback.name(), row.amplitude, unit(row.feedback));
        format!(
            "{name} is not measured with {added:.1} {unit} in {} of {} places",
            row.ended, row.measured
        )
    });
    low.chain(ended).collect::<Vec<_>>().join("; ")
}
