//! What `leg curve` prints.

use leg_base::paths::relative_path;
use leg_model::CurvePoint;
use leg_model_tools::tensile::{Fit, Hysteresis};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Tendons break before they are stretched by more than this part of their length.
const STRAIN_LIKELY: f64 = 0.2;

/// Everything that `leg curve` found.
#[derive(Serialize)]
pub(super) struct CurveReport<'a> {
    /// Of the tendon: those of the fit, scaled.
    points: &'a [CurvePoint<f64>],
    take_up_m: f64,
    taut_n: f64,
    error_max_m: f64,
    error_rms_m: f64,
    hysteresis: Option<Hysteresis>,
    plots: &'a [PathBuf],
    /// The largest of the test piece, where its length is known.
    strain_max: Option<f64>,
    warning: Option<String>,
    out: Option<&'a Path>,
    #[serde(skip)]
    fit: &'a Fit,
}

impl<'a> CurveReport<'a> {
    pub(super) fn new(
        fit: &'a Fit,
        points: &'a [CurvePoint<f64>],
        length_mm: Option<f64>,
        out: Option<&'a Path>,
        plots: &'a [PathBuf],
    ) -> Self {
        let strain_max = length_mm.map(|length_mm| strain(fit, length_mm));
        Self {
            points,
            take_up_m: fit.take_up_m,
            taut_n: fit.taut_n,
            error_max_m: fit.error_max_m,
            error_rms_m: fit.error_rms_m,
            hysteresis: fit.hysteresis,
            plots,
            strain_max,
            warning: strain_max.and_then(warning),
            out,
            fit,
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
        let hysteresis = match &self.hysteresis {
            None => "no unloading branch".into(),
            Some(Hysteresis { elongation_m, lost }) => format!(
                "up to {:.4} mm between the branches, {:.1} % of the energy lost",
                elongation_m * 1e3,
                lost * 100.0
            ),
        };
        let warning = self.warning.as_ref();
        let warning = warning.map_or_else(String::new, |text| format!("warning     {text}\n"));
        format!(
            "rows        {} taut ones of the loading branch, from {:.3} N\n\
             take-up     {}\n\
             fit         {} points, off by at most {:.5} mm, {:.5} mm root mean square\n\
             hysteresis  {hysteresis}\n{warning}",
            self.fit.rows.len(),
            self.taut_n,
            take_up(self.take_up_m * 1e3),
            self.points.len(),
            self.error_max_m * 1e3,
            self.error_rms_m * 1e3,
        )
    }

    fn files(&self) -> String {
        let named = |what: &str, path: &Path| format!("{what}{}\n", relative_path(path).display());
        let plots = self.plots.iter().map(|path| named("plot        ", path));
        let out = self.out.map(|path| named("rig file    ", path));
        plots.chain(out).chain(["\n".into()]).collect()
    }
}

/// The largest strain of the test piece.
fn strain(fit: &Fit, length_mm: f64) -> f64 {
    let elongations_mm = fit.rows.iter().map(|row| row.elongation_m * 1e3);
    elongations_mm.fold(0.0, f64::max) / length_mm
}

/// What is unlikely for a tendon.
fn warning(strain: f64) -> Option<String> {
    (strain > STRAIN_LIKELY).then(|| {
        format!(
            "the test piece is stretched by {:.0} % of --length-mm: check the length and the unit of the elongation",
            strain * 100.0
        )
    })
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
