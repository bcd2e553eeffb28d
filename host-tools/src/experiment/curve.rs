//! The deviations under one payload, beside the paper's maximum.

use super::{AZIMUTH_DEG, BOUND_PERCENT, ExperimentError};
use crate::evaluate::{self, EvaluateError};
use crate::link::Link;
use crate::rig_file::RigFile;
use serde::Serialize;

/// The deviations under one payload.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Curve {
    /// The payload, kg.
    pub payload_kg: f64,
    /// The paper's maximum, mm; none when the rig is not the paper's.
    pub paper_max_mm: Option<f64>,
    /// The firmware's deviation at each tilt, mm.
    pub firmware_mm: Vec<f64>,
    /// The host's in f64, mm.
    pub host_mm: Vec<f64>,
}

impl Curve {
    /// Evaluates one more pose.
    pub(super) fn measure(
        &mut self,
        rig: &RigFile,
        link: &mut dyn Link,
        tilt_deg: f64,
    ) -> Result<(), ExperimentError> {
        let payload_kg = self.payload_kg;
        let query = rig.query(AZIMUTH_DEG, tilt_deg, payload_kg);
        let no_result = |error| ExperimentError::NoResult {
            tilt_deg,
            payload_kg,
            error,
        };
        let firmware = match evaluate::on_link(link, &rig.parameters, &query) {
            Err(EvaluateError::Model(error)) => return Err(no_result(error)),
            answer => answer.map_err(ExperimentError::Firmware)?,
        };
        let host = leg_model::evaluate(&rig.parameters, &query).map_err(no_result)?;
        self.firmware_mm
            .push(f64::from(firmware.deviation_m) * 1000.0);
        self.host_mm.push(host.deviation_m * 1000.0);
        Ok(())
    }

    /// The firmware's largest deviation, mm.
    #[must_use]
    pub fn firmware_max_mm(&self) -> f64 {
        largest(self.firmware_mm.iter().copied())
    }

    /// The host's largest deviation, mm.
    #[must_use]
    pub fn host_max_mm(&self) -> f64 {
        largest(self.host_mm.iter().copied())
    }

    /// The largest difference between the firmware and the host, mm.
    #[must_use]
    pub fn largest_difference_mm(&self) -> f64 {
        let pairs = self.firmware_mm.iter().zip(&self.host_mm);
        largest(pairs.map(|(firmware, host)| (firmware - host).abs()))
    }

    /// How far the firmware's maximum is from the paper's, percent of the paper's.
    #[must_use]
    pub fn off_paper_percent(&self) -> Option<f64> {
        self.paper_max_mm
            .map(|paper| percent_off(self.firmware_max_mm(), paper))
    }

    /// Whether both maxima lie within [`BOUND_PERCENT`] of the paper's, if there is one.
    #[must_use]
    pub fn held(&self) -> bool {
        let near = |paper: f64| {
            let maxima = [self.firmware_max_mm(), self.host_max_mm()];
            maxima
                .iter()
                .all(|max| percent_off(*max, paper).abs() <= BOUND_PERCENT)
        };
        self.paper_max_mm.is_none_or(near)
    }
}

fn percent_off(value: f64, reference: f64) -> f64 {
    100.0 * (value - reference) / reference
}

/// The largest of some magnitudes; NaN if there is one among them, so that it cannot hide.
pub(super) fn largest(magnitudes: impl Iterator<Item = f64>) -> f64 {
    magnitudes.max_by(f64::total_cmp).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::Curve;

    fn curve(firmware_max_mm: f64, host_max_mm: f64) -> Curve {
        Curve {
            paper_max_mm: Some(2.0),
            firmware_mm: vec![0.0, firmware_max_mm, 1.0],
            host_mm: vec![0.0, host_max_mm, 1.0],
            ..Curve::default()
        }
    }

    #[test]
    fn either_maximum_beyond_the_bound_is_a_miss() {
        assert!(curve(2.029, 1.971).held());
        assert!(!curve(2.031, 2.0).held());
        assert!(!curve(2.0, 1.969).held());
    }

    #[test]
    fn a_pose_without_a_number_is_a_miss() {
        let mut curve = curve(2.0, 2.0);
        curve.firmware_mm[0] = f64::NAN;
        assert!(!curve.held());
        assert!(curve.largest_difference_mm().is_nan());
    }

    #[test]
    fn another_rig_has_nothing_to_miss() {
        let curve = Curve {
            paper_max_mm: None,
            ..curve(7.0, 7.0)
        };
        assert!(curve.held());
        assert_eq!(curve.off_paper_percent(), None);
    }
}
