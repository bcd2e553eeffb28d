//! What `leg run` prints.

use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_base::paths::from_here;
use leg_base::tick_time::tick_s;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::{Finding, Summary};
use serde::Serialize;
use std::path::PathBuf;

const HEADING: &str = "   time       value  unit          lowest   highest            what\n";

/// Everything that `leg run` found.
pub(super) struct Report<'a> {
    pub(super) scenario: &'a Scenario,
    /// Where the firmware ran.
    pub(super) place: &'static str,
    pub(super) summary: &'a Summary,
    pub(super) ticks_per_s: f64,
    /// The SVG files; the PNG files are beside them.
    pub(super) plots: &'a [PathBuf],
}

impl Report<'_> {
    /// A table for people.
    pub(super) fn table(&self) -> String {
        let title = format!(
            "{}\nFirmware {}, {:.1} s of the leg's time\n\n",
            self.scenario.title,
            self.place,
            self.time_s()
        );
        let rows: String = self.summary.findings.iter().map(row).collect();
        title + HEADING + &rows + &self.remarks()
    }

    fn time_s(&self) -> f64 {
        self.summary.ticks as f64 * tick_s()
    }

    fn remarks(&self) -> String {
        let summary = self.summary;
        let [lowest, highest] = summary.tension_range_n;
        let faults: Vec<String> = summary
            .faults
            .iter()
            .map(|(fault, at_s)| {
                let name = fault.entry().name;
                let expected = !summary.unexpected.contains(fault);
                let remark = if expected { "" } else { ", not expected" };
                format!("{name} ({at_s:.3} s{remark})")
            })
            .collect();
        let faults = if faults.is_empty() {
            "none".into()
        } else {
            faults.join(", ")
        };
        let plots: String = self
            .plots
            .iter()
            .map(|path| format!("Chart: {} (and .png)\n", from_here(path).display()))
            .collect();
        format!(
            "\nTensions: {lowest:.1} to {highest:.1} N\nFaults: {faults}\n{}Speed: {:.0} ticks a second\n{plots}",
            divergence(summary),
            self.ticks_per_s,
        )
    }

    /// One line of JSON for machines.
    pub(super) fn json(&self) -> Result<String, Failure> {
        let summary = self.summary;
        let report = JsonReport {
            title: &self.scenario.title,
            firmware: self.place,
            ticks: summary.ticks,
            ticks_per_s: self.ticks_per_s,
            tension_range_n: summary.tension_range_n,
            findings: &summary.findings,
            faults: summary
                .faults
                .iter()
                .map(|(fault, at_s)| JsonFault {
                    code: fault.code(),
                    name: fault.entry().name,
                    at_s: *at_s,
                })
                .collect(),
            divergence: &summary.divergence,
            stopped: summary.stopped.as_deref(),
            held: summary.held(),
            plots: self.plots,
        };
        to_line(&report)
    }
}

fn divergence(summary: &Summary) -> String {
    let divergence = &summary.divergence;
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

fn row(finding: &Finding) -> String {
    let [lowest, highest] = finding.between;
    format!(
        "{:6.2} s {:9.4}  {:<8} {lowest:11.4} {highest:9.4}   {}   {}\n",
        finding.at_s,
        finding.value,
        finding.unit,
        if finding.held() { "held  " } else { "missed" },
        finding.name,
    )
}

#[derive(Serialize)]
struct JsonReport<'a> {
    title: &'a str,
    firmware: &'a str,
    ticks: u64,
    ticks_per_s: f64,
    tension_range_n: [f64; 2],
    findings: &'a [Finding],
    faults: Vec<JsonFault>,
    divergence: &'a leg_sim::simulation::Divergence,
    stopped: Option<&'a str>,
    held: bool,
    plots: &'a [PathBuf],
}

#[derive(Serialize)]
struct JsonFault {
    code: u8,
    name: &'static str,
    at_s: f64,
}
