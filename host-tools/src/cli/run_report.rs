//! What `leg run` prints.

use crate::experiment::{Curve, Fig9};
use crate::failure::Failure;
use crate::paths::from_here;
use crate::rig_file::RigFile;
use serde::Serialize;
use std::path::Path;

const HEADING: &str = "\
payload   paper max   firmware f32 max   host f64 max   off the paper
     kg          mm                 mm             mm               %
";

/// Everything that `leg run` found.
pub(super) struct Report<'a> {
    pub(super) rig: &'a RigFile,
    /// Where the firmware ran.
    pub(super) place: &'static str,
    pub(super) fig9: &'a Fig9,
    /// The SVG file; the PNG file is beside it.
    pub(super) plot: &'a Path,
}

impl Report<'_> {
    /// A table for people.
    pub(super) fn table(&self) -> String {
        let edge = self.rig.tilt_deg;
        let title = format!(
            "Fig. 9: firmware {}, azimuth {}°, tilt -{edge}° to {edge}°, level {} N, {}\n\n",
            self.place,
            self.fig9.azimuth_deg,
            self.rig.level_n,
            self.rig.stiffness_words(),
        );
        let rows: String = self.fig9.curves.iter().map(row).collect();
        title + HEADING + &rows + &self.remarks()
    }

    fn remarks(&self) -> String {
        let other_rig = "\nThe paper's maxima are left out: this is not the paper's rig.\n";
        let paper = if self.rig.is_table_1() { "" } else { other_rig };
        let difference = self.fig9.largest_difference_mm();
        format!(
            "{paper}\nLargest difference between f32 and f64: {difference:.1e} mm\nPlot: {} (and .png)\n",
            from_here(self.plot).display(),
        )
    }

    /// One line of JSON for machines.
    pub(super) fn json(&self) -> Result<String, Failure> {
        let report = JsonReport {
            experiment: "fig9",
            firmware: self.place,
            level_n: self.rig.level_n,
            stiffness_at_level_n_per_m: self.rig.stiffnesses_n_per_m(),
            fig9: self.fig9,
            maxima: self.fig9.curves.iter().map(Maxima::of).collect(),
            largest_difference_mm: self.fig9.largest_difference_mm(),
            held: self.fig9.held(),
            plot: self.plot,
        };
        match serde_json::to_string(&report) {
            Ok(json) => Ok(json + "\n"),
            Err(error) => Err(Failure::from_error(&error)),
        }
    }
}

fn row(curve: &Curve) -> String {
    let paper = curve
        .paper_max_mm
        .map_or("-".into(), |max| format!("{max:.1}"));
    let off = curve
        .off_paper_percent()
        .map_or("-".into(), |percent| format!("{percent:+.2}"));
    format!(
        "{:7.1}   {paper:>9}   {:16.3}   {:12.3}   {off:>13}\n",
        curve.payload_kg,
        curve.firmware_max_mm(),
        curve.host_max_mm(),
    )
}

#[derive(Serialize)]
struct JsonReport<'a> {
    experiment: &'static str,
    firmware: &'static str,
    level_n: f64,
    stiffness_at_level_n_per_m: [f64; 3],
    #[serde(flatten)]
    fig9: &'a Fig9,
    maxima: Vec<Maxima>,
    largest_difference_mm: f64,
    held: bool,
    plot: &'a Path,
}

#[derive(Serialize)]
struct Maxima {
    payload_kg: f64,
    paper_mm: Option<f64>,
    firmware_mm: f64,
    host_mm: f64,
    off_paper_percent: Option<f64>,
}

impl Maxima {
    fn of(curve: &Curve) -> Self {
        Self {
            payload_kg: curve.payload_kg,
            paper_mm: curve.paper_max_mm,
            firmware_mm: curve.firmware_max_mm(),
            host_mm: curve.host_max_mm(),
            off_paper_percent: curve.off_paper_percent(),
        }
    }
}
