//! What `leg run` prints.

use crate::output::chart_line;
use leg_base::json_object;
use leg_base::tick_time::tick_s;
use leg_firmware::supervisor::Fault;
use leg_sim::shadow::Divergence;
use leg_sim::simulation::{RefusedCommand, ScenarioMeasurement, Summary};
use serde::Serialize;
use std::path::PathBuf;

const HEADING: &str = "   time       value  unit          lowest   highest            what\n";

/// What a run was, and what it found.
pub(super) struct RunReport<'a> {
    pub(super) title: &'a str,
    /// Where the firmware ran.
    pub(super) firmware: &'a str,
    pub(super) summary: &'a Summary,
    pub(super) ticks_per_s: f64,
    /// In a second of the processor's time; none where the system does not say it.
    pub(super) ticks_per_processor_s: Option<f64>,
    /// The most memory that was in use.
    pub(super) memory_mib: Option<f64>,
    /// Whether the table shows them.
    pub(super) shows_resources: bool,
    /// The SVG files; the PNG and PDF files are beside them.
    pub(super) plots: &'a [PathBuf],
}

impl RunReport<'_> {
    pub(super) fn json(&self) -> impl Serialize {
        let summary = self.summary;
        let fault = |seen: &(Fault, f64)| {
            json_object! {
                code: seen.0.code(),
                name: seen.0.entry().name,
                at_s: seen.1,
                expected: !summary.unexpected.contains(&seen.0),
            }
        };
        json_object! {
            title: self.title,
            firmware: self.firmware,
            ticks: summary.ticks,
            ticks_per_s: self.ticks_per_s,
            ticks_per_processor_s: self.ticks_per_processor_s,
            memory_mib: self.memory_mib,
            tension_range_n: summary.tension_range_n,
            findings: &summary.measurements,
            faults: summary.faults.iter().map(fault).collect::<Vec<_>>(),
            refused: &summary.refused,
            divergence: &summary.divergence,
            stopped: &summary.stopped,
            passed: summary.passes(),
            // The same under its former name, for one release.
            held: summary.passes(),
            plots: self.plots,
        }
    }

    /// A table for people.
    pub(super) fn table(&self) -> String {
        let (summary, [lowest, highest]) = (self.summary, self.summary.tension_range_n);
        let rows: String = summary.measurements.iter().map(row).collect();
        let plots: String = self.plots.iter().map(|svg| chart_line(svg)).collect();
        format!(
            "{}\nFirmware {}, {:.1} s of the leg's time\n\n{HEADING}{rows}\n\
             Tensions: {lowest:.1} to {highest:.1} N\nFaults: {}\n{}{}Speed: {:.0} ticks a second\n{}{plots}",
            self.title,
            self.firmware,
            summary.ticks as f64 * tick_s(),
            faults_text(summary),
            refused_text(&summary.refused),
            divergence_text(&summary.divergence),
            self.ticks_per_s,
            self.resources_text(),
        )
    }

    fn resources_text(&self) -> String {
        match (self.ticks_per_processor_s, self.memory_mib) {
            (Some(ticks), Some(mib)) if self.shows_resources => {
                format!(
                    "Processor: {ticks:.0} ticks in a second of its time; memory: {mib:.0} MiB\n"
                )
            }
            _ => String::new(),
        }
    }
}

fn faults_text(summary: &Summary) -> String {
    let text = |seen: &(Fault, f64)| {
        let expected = !summary.unexpected.contains(&seen.0);
        let remark = if expected { "" } else { ", not expected" };
        format!("{} ({:.3} s{remark})", seen.0.entry().name, seen.1)
    };
    match summary.faults.as_slice() {
        [] => "none".into(),
        faults => faults.iter().map(text).collect::<Vec<_>>().join(", "),
    }
}

/// A line for each command that the leg refused; nothing without one.
fn refused_text(refused: &[RefusedCommand]) -> String {
    let line = |refused: &RefusedCommand| format!("Refused: {refused}\n");
    refused.iter().map(line).collect()
}

fn divergence_text(divergence: &Divergence) -> String {
    let others = match divergence.first_other_tick {
        None => String::new(),
        Some(first) => format!(
            "; {} ticks in another state, the first of them {first}",
            divergence.other_state
        ),
    };
    format!(
        "Largest difference between f32 and its shadow in f64: duty {:.1e}, pull {:.1e} mm, pose {:.1e}{others}\n",
        divergence.duty,
        divergence.reference_m * 1000.0,
        divergence.pose,
    )
}

fn row(measurement: &ScenarioMeasurement) -> String {
    let [lowest, highest] = measurement.between;
    format!(
        "{:6.2} s {:9.4}  {:<8} {lowest:11.4} {highest:9.4}   {}   {}\n",
        measurement.at_s,
        measurement.value,
        measurement.unit,
        if measurement.passes() { "pass" } else { "FAIL" },
        measurement.name,
    )
}
