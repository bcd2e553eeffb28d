//! The leg at a time: its telemetry, and what follows from it.

use super::sag_model::SagModel;
use crate::leg_report;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_base::json_object;
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;

/// What is shown of a leg.
#[derive(Clone, Debug)]
pub struct MonitorView {
    pub(super) title: String,
    pub(super) bounds_n: [f32; 2],
    sag_model: Option<SagModel>,
    pub(super) telemetry: Option<Telemetry<f32>>,
    pub(super) damaged_frames: u64,
}

impl MonitorView {
    /// A leg without telemetry yet; `title` names it.
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

    /// A line of JSON; none before the first telemetry.
    pub fn json(&self) -> Result<Option<String>, Failure> {
        let Some(telemetry) = &self.telemetry else {
            return Ok(None);
        };
        let line = to_line(&json_object! {
            #[serde(flatten)]
            report: leg_report::json(telemetry),
            moving: telemetry.moving,
            target: telemetry.target,
            target_tensions_n: telemetry.target_tensions_n,
            pulled_m: telemetry.pulled_m,
            residual_m: telemetry.residual_m,
            sag_m: self.sag_m(),
            tension_bounds_n: self.bounds_n,
            damaged_frames: self.damaged_frames,
        })?;
        Ok(Some(line))
    }

    /// How far the tip would sag without compensation, m.
    pub(super) fn sag_m(&self) -> Option<f64> {
        self.sag_model.as_ref()?.sag_m(self.telemetry.as_ref()?)
    }
}
