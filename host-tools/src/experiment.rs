//! The paper's Fig. 9: how far the tip sags along one azimuth under four payloads.

mod curve;

pub use curve::Curve;

use crate::evaluate::EvaluateError;
use crate::link::Link;
use crate::plot::{self, Chart};
use crate::rig_file::RigFile;
use serde::Serialize;

/// Azimuth of every pose, degrees.
pub const AZIMUTH_DEG: f64 = 30.0;

/// How far a maximum may be from the paper's, percent.
pub const BOUND_PERCENT: f64 = 1.5;

/// Payloads in kg, each with the maximum that the paper gives in mm.
const PAPER: [(f64, f64); 4] = [(0.0, 2.0), (0.5, 3.6), (1.0, 5.3), (2.0, 8.5)];

/// Poses from the vertical to the edge of the workspace: steps of 2° with the paper's 30°.
const STEPS_TO_EDGE: i32 = 15;

/// Why the experiment has no result.
#[derive(Debug, thiserror::Error)]
pub enum ExperimentError {
    /// The model has no result at a pose.
    #[error(
        "no result at tilt {tilt_deg}° with {payload_kg} kg: {error}; give a rig that carries this load there"
    )]
    NoResult {
        /// Tilt of the pose, degrees.
        tilt_deg: f64,
        /// The payload, kg.
        payload_kg: f64,
        /// What the model says.
        error: leg_model::Error,
    },
    /// The firmware gave no evaluation.
    #[error(transparent)]
    Firmware(EvaluateError),
}

/// What came out, for all payloads.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fig9 {
    /// Azimuth of every pose, degrees.
    pub azimuth_deg: f64,
    /// Tilt of each pose, degrees.
    pub tilts_deg: Vec<f64>,
    /// One curve a payload.
    pub curves: Vec<Curve>,
}

/// How many poses [`Fig9::measure`] evaluates.
#[must_use]
pub fn pose_count() -> u64 {
    (tilts(0.0).count() * PAPER.len()) as u64
}

impl Fig9 {
    /// Evaluates every pose on the firmware and on the host, and calls `done` after each.
    ///
    /// # Errors
    /// The first pose that has no result.
    pub fn measure(
        rig: &RigFile,
        link: &mut dyn Link,
        mut done: impl FnMut(),
    ) -> Result<Self, ExperimentError> {
        let of_the_paper = rig.is_table_1();
        let tilts_deg: Vec<f64> = tilts(rig.tilt_deg).collect();
        let mut curves = Vec::new();
        for (payload_kg, paper_max_mm) in PAPER {
            let paper_max_mm = of_the_paper.then_some(paper_max_mm);
            let mut curve = Curve {
                payload_kg,
                paper_max_mm,
                ..Curve::default()
            };
            for &tilt_deg in &tilts_deg {
                curve.measure(rig, link, tilt_deg)?;
                done();
            }
            curves.push(curve);
        }
        Ok(Self {
            azimuth_deg: AZIMUTH_DEG,
            tilts_deg,
            curves,
        })
    }

    /// The largest difference between the firmware and the host, mm.
    #[must_use]
    pub fn largest_difference_mm(&self) -> f64 {
        curve::largest(self.curves.iter().map(Curve::largest_difference_mm))
    }

    /// Whether every maximum lies within [`BOUND_PERCENT`] of the paper's, where there is one.
    #[must_use]
    pub fn held(&self) -> bool {
        self.curves.iter().all(Curve::held)
    }

    /// The curves of the firmware, with the paper's maxima as marks.
    #[must_use]
    pub fn chart(&self, title: String) -> Chart {
        Chart {
            title,
            x_title: format!("tilt (°) along azimuth {AZIMUTH_DEG}°"),
            y_title: "deviation of the tip (mm)".into(),
            lines: self.curves.iter().map(|curve| self.line(curve)).collect(),
            marks_label: "paper's maximum".into(),
        }
    }

    fn line(&self, curve: &Curve) -> plot::Line {
        let edges = [self.tilts_deg.first(), self.tilts_deg.last()];
        let mark = |max_mm| edges.into_iter().flatten().map(move |&tilt| (tilt, max_mm));
        plot::Line {
            label: format!("payload {} kg", curve.payload_kg),
            points: self
                .tilts_deg
                .iter()
                .copied()
                .zip(curve.firmware_mm.iter().copied())
                .collect(),
            marks: curve.paper_max_mm.into_iter().flat_map(mark).collect(),
        }
    }
}

/// From one edge of the workspace through the vertical to the other.
fn tilts(edge_deg: f64) -> impl Iterator<Item = f64> {
    let tilt = move |step| edge_deg * f64::from(step) / f64::from(STEPS_TO_EDGE);
    (-STEPS_TO_EDGE..=STEPS_TO_EDGE).map(tilt)
}
