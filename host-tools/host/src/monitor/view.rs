//! The leg at a time: its telemetry, and what follows from it.

use super::sag_model::SagModel;
use crate::leg_report::LegReport;
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;
use serde::Serialize;

/// What is shown of a leg.
#[derive(Clone, Debug)]
pub struct MonitorView {
    pub(super) title: String,
    pub(super) bounds_n: [f32; 2],
    sag_model: Option<SagModel>,
    pub(super) telemetry: Option<Telemetry<f32>>,
    pub(super) damaged_frames: u64,
}

/// A line of JSON: one moment of a leg.
#[derive(Serialize)]
struct MonitorLine<'a> {
    #[serde(flatten)]
    report: LegReport,
    moving: bool,
    target: [f32; 2],
    target_tensions_n: [f32; 3],
    pulled_m: [f32; 3],
    residual_m: f32,
    sag_m: Option<f64>,
    tension_bounds_n: &'a [f32; 2],
    damaged_frames: u64,
}

impl MonitorView {
    /// A leg without telemetry yet; `title` names it.
    #[must_use]
    pub fn new(title: &str, settings: &Settings) -> Self {
        Self {
            title: title.into(),
            bounds_n: [settings.f_min_n, settings.f_max_n],
            sag_model: SagModel::new(settings),
            telemetry: None,
            damaged_frames: 0,
        }
    }

    /// Takes new telemetry, and how many frames could not be read so far.
    pub fn take(&mut self, telemetry: &Telemetry<f32>, damaged_frames: u64) {
        self.telemetry = Some(*telemetry);
        self.damaged_frames = damaged_frames;
    }

    /// A line of JSON, without its end; none before the first telemetry.
    ///
    /// # Errors
    /// Numbers without a form in JSON.
    pub fn json(&self) -> Result<Option<String>, serde_json::Error> {
        let Some(telemetry) = &self.telemetry else {
            return Ok(None);
        };
        serde_json::to_string(&MonitorLine {
            report: LegReport::new(telemetry),
            moving: telemetry.moving,
            target: telemetry.target,
            target_tensions_n: telemetry.target_tensions_n,
            pulled_m: telemetry.pulled_m,
            residual_m: telemetry.residual_m,
            sag_m: self.sag_m(),
            tension_bounds_n: &self.bounds_n,
            damaged_frames: self.damaged_frames,
        })
        .map(Some)
    }

    /// How far the tip would sag without compensation, m.
    pub(super) fn sag_m(&self) -> Option<f64> {
        self.sag_model.as_ref()?.sag_m(self.telemetry.as_ref()?)
    }
}
