//! How far the control law in f32 gets from its shadow in f64.

use leg_firmware::drive::Drive;
use leg_firmware::telemetry::Telemetry;
use serde::Serialize;

/// The largest differences over all ticks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Divergence {
    /// Of a duty.
    pub duty: f64,
    /// Of where a tendon shall be pulled to, m.
    pub reference_m: f64,
    /// Of the estimated pose, as a component of the direction.
    pub pose: f64,
    /// Ticks at which the two were not in the same state or had other faults.
    pub other_state: u64,
    /// The first of them: the differences above are of the other ticks alone.
    pub first_other_tick: Option<u32>,
}

impl Divergence {
    pub(super) fn compare(
        &mut self,
        drive: &Drive<f32>,
        telemetry: &Telemetry<f32>,
        shadow: &Drive<f64>,
        shadow_telemetry: &Telemetry<f64>,
    ) {
        if telemetry.state != shadow_telemetry.state || telemetry.faults != shadow_telemetry.faults
        {
            self.other_state += 1;
            self.first_other_tick.get_or_insert(telemetry.tick);
            return;
        }
        self.duty = self.duty.max(largest(&drive.duty, &shadow.duty));
        self.reference_m = self.reference_m.max(largest(
            &telemetry.reference_m,
            &shadow_telemetry.reference_m,
        ));
        self.pose = self
            .pose
            .max(largest(&telemetry.pose, &shadow_telemetry.pose));
    }
}

fn largest<const N: usize>(single: &[f32; N], double: &[f64; N]) -> f64 {
    let pairs = single.iter().zip(double);
    pairs
        .map(|(single, double)| (f64::from(*single) - double).abs())
        .fold(0.0, f64::max)
}
