//! What `leg curve` prints.

use leg_base::json_object;
use leg_base::paths::relative_path;
use leg_model::CurvePoint;
use leg_model_tools::tensile::{Fit, Hysteresis};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Tendons break before they are stretched by more than this part of their length.
const STRAIN_LIKELY: f64 = 0.2;

/// Everything that `leg curve` found.
pub(super) struct CurveReport<'a> {
    pub(super) fit: &'a Fit,
    /// Of the tendon: those of the fit, scaled.
    pub(super) points: &'a [CurvePoint<f64>],
    /// Of the test piece, where it is known.
    pub(super) length_mm: Option<f64>,
    pub(super) out: Option<&'a Path>,
    pub(super) plots: &'a [PathBuf],
}

impl CurveReport<'_> {
    pub(super) fn json(&self) -> impl Serialize {
        json_object! {
            points: self.points,
            take_up_m: self.fit.take_up_m,
            taut_n: self.fit.taut_n,
            error_max_m: self.fit.error_max_m,
            error_rms_m: self.fit.error_rms_m,
            hysteresis: self.fit.hysteresis,
            plots: self.plots,
            strain_max: self.strain_max(),
            warning: self.warning(),
            out: self.out,
        }
    }

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
        let hysteresis = match &self.fit.hysteresis {
            None => "no unloading branch".into(),
            Some(Hysteresis { elongation_m, lost }) => format!(
                "up to {:.4} mm between the branches, {:.1} % of the energy lost",
                elongation_m * 1e3,
                lost * 100.0
            ),
        };
        let warning = self.warning().map(|text| format!("warning     {text}\n"));
        format!(
            "rows        {} taut ones of the loading branch, from {:.3} N\n\
             take-up     {}\n\
             fit         {} points, off by at most {:.5} mm, {:.5} mm root mean square\n\
             hysteresis  {hysteresis}\n{}",
            self.fit.rows.len(),
            self.fit.taut_n,
            take_up(self.fit.take_up_m * 1e3),
            self.points.len(),
            self.fit.error_max_m * 1e3,
            self.fit.error_rms_m * 1e3,
            warning.unwrap_or_default(),
        )
    }

    fn files(&self) -> String {
        let named = |what: &str, path: &Path| format!("{what}{}\n", relative_path(path).display());
        let plots = self.plots.iter().map(|path| named("plot        ", path));
        let out = self.out.map(|path| named("rig file    ", path));
        plots.chain(out).chain(["\n".into()]).collect()
    }

    /// The largest strain of the test piece, where its length is known.
    fn strain_max(&self) -> Option<f64> {
        let elongations_mm = self.fit.rows.iter().map(|row| row.elongation_m * 1e3);
        Some(elongations_mm.fold(0.0, f64::max) / self.length_mm?)
    }

    /// What is unlikely for a tendon.
    fn warning(&self) -> Option<String> {
        let strain = self.strain_max().filter(|strain| *strain > STRAIN_LIKELY)?;
        Some(format!(
            "the test piece is stretched by {:.0} % of --length-mm: check the length and the unit of the elongation",
            strain * 100.0
        ))
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
