//! What `leg curve` prints.

use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_base::paths::from_here;
use leg_model::CurvePoint;
use leg_model_tools::tensile::{Fit, Hysteresis};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Tendons break before they are stretched by more than this part of their length.
const STRAIN_LIKELY: f64 = 0.2;

/// Everything that `leg curve` found.
pub(super) struct Report<'a> {
    pub(super) fit: &'a Fit,
    /// Of the tendon: those of the fit, scaled.
    pub(super) points: &'a [CurvePoint<f64>],
    /// The largest of the test piece, where its length is known.
    pub(super) strain: Option<f64>,
    pub(super) out: Option<&'a Path>,
    pub(super) plots: &'a [PathBuf],
}

impl Report<'_> {
    /// A table for people.
    pub(super) fn table(&self) -> String {
        let row = |point: &CurvePoint<f64>| {
            format!(
                "{:9.2}   {:13.4}   {:13.0}\n",
                point.tension_n,
                point.elongation_m * 1e3,
                point.stiffness_n_per_m
            )
        };
        let rows: String = self.points.iter().map(row).collect();
        format!(
            "tension N   elongation mm   stiffness N/m\n{rows}\n{}{}",
            self.remarks(),
            self.files()
        )
    }

    fn remarks(&self) -> String {
        let fit = self.fit;
        let hysteresis = match &fit.hysteresis {
            None => "no unloading branch".into(),
            Some(Hysteresis { elongation_m, lost }) => format!(
                "up to {:.4} mm between the branches, {:.1} % of the energy lost",
                elongation_m * 1e3,
                lost * 100.0
            ),
        };
        format!(
            "rows        {} taut ones of the loading branch, from {:.3} N\n\
             take-up     {}\n\
             fit         {} points, off by at most {:.5} mm, {:.5} mm root mean square\n\
             hysteresis  {hysteresis}\n{}",
            fit.rows.len(),
            fit.taut_n,
            take_up(fit.take_up_m * 1e3),
            fit.points.len(),
            fit.error_max_m * 1e3,
            fit.error_rms_m * 1e3,
            self.warning()
                .map_or_else(String::new, |warning| format!("warning     {warning}\n")),
        )
    }

    /// What is unlikely for a tendon.
    fn warning(&self) -> Option<String> {
        let strain = self.strain.filter(|strain| *strain > STRAIN_LIKELY)?;
        Some(format!(
            "the test piece is stretched by {:.0} % of --length-mm: check the length and the unit of the elongation",
            strain * 100.0
        ))
    }

    fn files(&self) -> String {
        let named = |what: &str, path: &Path| format!("{what}{}\n", from_here(path).display());
        let plots = self.plots.iter().map(|path| named("plot        ", path));
        let out = self.out.map(|path| named("rig file    ", path));
        plots.chain(out).chain(["\n".into()]).collect()
    }

    /// One line of JSON for machines.
    pub(super) fn json(&self) -> Result<String, Failure> {
        let report = JsonReport {
            points: self.points.iter().map(JsonPoint::of).collect(),
            take_up_m: self.fit.take_up_m,
            taut_n: self.fit.taut_n,
            error_max_m: self.fit.error_max_m,
            error_rms_m: self.fit.error_rms_m,
            hysteresis: self.fit.hysteresis,
            plots: self.plots,
            strain_max: self.strain,
            warning: self.warning(),
            out: self.out,
        };
        to_line(&report)
    }
}

fn take_up(slack_mm: f64) -> String {
    // Less than what is printed is rounding.
    if slack_mm < -5e-5 {
        return format!(
            "none; {:.4} mm added, as the test's zero is under tension",
            -slack_mm
        );
    }
    format!("{slack_mm:.4} mm removed")
}

#[derive(Serialize)]
struct JsonReport<'a> {
    points: Vec<JsonPoint>,
    take_up_m: f64,
    taut_n: f64,
    error_max_m: f64,
    error_rms_m: f64,
    hysteresis: Option<Hysteresis>,
    plots: &'a [PathBuf],
    strain_max: Option<f64>,
    warning: Option<String>,
    out: Option<&'a Path>,
}

#[derive(Serialize)]
struct JsonPoint {
    tension_n: f64,
    elongation_m: f64,
    stiffness_n_per_m: f64,
}

impl JsonPoint {
    fn of(point: &CurvePoint<f64>) -> Self {
        Self {
            tension_n: point.tension_n,
            elongation_m: point.elongation_m,
            stiffness_n_per_m: point.stiffness_n_per_m,
        }
    }
}
