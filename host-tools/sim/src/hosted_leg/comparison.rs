//! What was commanded, what the trajectory asks for, what the leg estimates, and what is true.

use serde::{Deserialize, Serialize};

/// The simulated leg beside what it reports, as a tick finds them. Tips are in frame {A}.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// Where the host has sent the tip: the end of a move, or the point of a streamed path at that time; the reference after a
    /// hold, mm.
    pub tip_commanded_mm: [f64; 3],
    /// Where the trajectory has the tip, mm.
    pub tip_reference_mm: [f64; 3],
    /// Where the leg estimates its tip, mm; without meaning before homing.
    pub tip_estimated_mm: [f64; 3],
    /// Where the tip is, mm.
    pub tip_true_mm: [f64; 3],
    /// Tension of each tendon, N.
    pub tensions_true_n: [f64; 3],
    /// kg.
    pub payload_true_kg: f64,
    /// Distance of the true tip from where a streamed path has it at that time, mm; none where no path is followed.
    pub path_error_mm: Option<f64>,
}

impl Comparison {
    /// How far the true tip is from where the trajectory has it, mm.
    #[must_use]
    pub fn reference_error_mm(&self) -> f64 {
        self.error_mm(&self.tip_reference_mm)
    }

    /// How far the true tip is from where the host has sent it, mm.
    #[must_use]
    pub fn commanded_error_mm(&self) -> f64 {
        self.error_mm(&self.tip_commanded_mm)
    }

    fn error_mm(&self, tip_mm: &[f64; 3]) -> f64 {
        let pairs = self.tip_true_mm.iter().zip(tip_mm);
        pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    }
}
