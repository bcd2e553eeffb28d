//! The leg at a time: its telemetry, and what follows from it.

use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;
use leg_host::signals::{LegConstants, REPORT_SIGNALS, Report, json_object};

/// What is shown of a leg.
#[derive(Clone, Debug)]
pub(super) struct MonitorView {
    pub(super) title: String,
    pub(super) bounds_n: [f32; 2],
    leg: LegConstants,
    pub(super) telemetry: Option<Telemetry<f32>>,
    report: Option<Report>,
    pub(super) damaged_frames: u64,
}

impl MonitorView {
    /// A leg without telemetry yet; `title` names it.
    pub(super) fn new(title: &str, settings: &Settings) -> Self {
        Self {
            title: title.into(),
            bounds_n: [settings.f_min_n, settings.f_max_n],
            leg: LegConstants::new(settings),
            telemetry: None,
            report: None,
            damaged_frames: 0,
        }
    }

    /// Takes new telemetry, received at a time of the day in s since 1970, and how many frames could not be read so far.
    pub(super) fn take(
        &mut self,
        telemetry: &Telemetry<f32>,
        wall_time_s: f64,
        damaged_frames: u64,
    ) {
        let report = Report::new(telemetry, &self.leg);
        self.telemetry = Some(*telemetry);
        self.report = Some(report.received(wall_time_s, damaged_frames));
        self.damaged_frames = damaged_frames;
    }

    /// A line of JSON, the signals of a report; none before the first telemetry.
    pub(super) fn json(&self) -> Result<Option<String>, Failure> {
        let report = self.report.as_ref();
        let line = report.map(|report| to_line(&json_object(REPORT_SIGNALS, report)));
        line.transpose()
    }

    /// How far the tip would sag without compensation, m.
    pub(super) fn sag_m(&self) -> Option<f64> {
        self.report.as_ref()?.sag_m()
    }
}
