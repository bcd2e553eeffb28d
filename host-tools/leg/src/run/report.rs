//! What `leg run` prints.

use leg_base::paths::relative_path;
use leg_base::tick_time::tick_s;
use leg_firmware::supervisor::Fault;
use leg_sim::simulation::{Divergence, Measurement, Summary};
use serde::Serialize;
use std::path::PathBuf;

const HEADING: &str = "   time       value  unit          lowest   highest            what\n";

/// Everything that `leg run` found.
#[derive(Serialize)]
pub(super) struct RunReport<'a> {
    title: &'a str,
    /// Where the firmware ran.
    firmware: &'a str,
    ticks: u64,
    ticks_per_s: f64,
    tension_range_n: [f64; 2],
    findings: &'a [Measurement],
    faults: Vec<SeenFault>,
    divergence: &'a Divergence,
    stopped: Option<&'a str>,
    passed: bool,
    /// The same, under its former name.
    held: bool,
    /// The SVG files; the PNG files are beside them.
    plots: &'a [PathBuf],
}

#[derive(Serialize)]
struct SeenFault {
    code: u8,
    name: &'static str,
    at_s: f64,
    expected: bool,
}

impl<'a> RunReport<'a> {
    pub(super) fn new(
        title: &'a str,
        firmware: &'a str,
        summary: &'a Summary,
        ticks_per_s: f64,
        plots: &'a [PathBuf],
    ) -> Self {
        let fault = |&(fault, at_s): &(Fault, f64)| SeenFault {
            code: fault.code(),
            name: fault.entry().name,
            at_s,
            expected: !summary.unexpected.contains(&fault),
        };
        Self {
            title,
            firmware,
            ticks: summary.ticks,
            ticks_per_s,
            tension_range_n: summary.tension_range_n,
            findings: &summary.measurements,
            faults: summary.faults.iter().map(fault).collect(),
            divergence: &summary.divergence,
            stopped: summary.stopped.as_deref(),
            passed: summary.passes(),
            held: summary.passes(),
            plots,
        }
    }

    /// A table for people.
    pub(super) fn table(&self) -> String {
        let title = format!(
            "{}\nFirmware {}, {:.1} s of the leg's time\n\n",
            self.title,
            self.firmware,
            self.ticks as f64 * tick_s()
        );
        let rows: String = self.findings.iter().map(row).collect();
        title + HEADING + &rows + &self.remarks()
    }

    fn remarks(&self) -> String {
        let [lowest, highest] = self.tension_range_n;
        let plots: String = self
            .plots
            .iter()
            .map(|path| format!("Chart: {} (and .png)\n", relative_path(path).display()))
            .collect();
        format!(
            "\nTensions: {lowest:.1} to {highest:.1} N\nFaults: {}\n{}Speed: {:.0} ticks a second\n{plots}",
            self.faults_text(),
            divergence_text(self.divergence),
            self.ticks_per_s,
        )
    }

    fn faults_text(&self) -> String {
        if self.faults.is_empty() {
            return "none".into();
        }
        let text = |fault: &SeenFault| {
            let remark = if fault.expected { "" } else { ", not expected" };
            format!("{} ({:.3} s{remark})", fault.name, fault.at_s)
        };
        let faults: Vec<String> = self.faults.iter().map(text).collect();
        faults.join(", ")
    }
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

fn row(measurement: &Measurement) -> String {
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
