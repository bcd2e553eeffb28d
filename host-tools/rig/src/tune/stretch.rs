//! How much the tendons stretch for what they do by the rig file, of a leg whose firmware holds it because they are nothing like it.

use super::error::TuneError;
use super::tuned_leg::TunedLeg;
use crate::number::{plain, significant};
use crate::rig_file::{ELONGATION_FACTOR, RigFile};
use leg_firmware::supervisor::Fault;
use leg_firmware::telemetry::Telemetry;
use leg_model::{Elasticity, evaluate};

/// How far the leg may lean, as a direction: its lengths are taken for those straight down.
const STRAIGHT: f32 = 0.005;

/// How far the three tendons may be off each other, as parts of what is expected, and by how much they are off that the leg itself does not measure
/// as it is tensioned (from 0.7 to 1.4, `leg/stretch.rs` in the firmware): the ratio is rough, so a little less.
const ALIKE: f64 = 0.1;
const MEASURED: f64 = 0.25;

/// Why the leg was not measured. Where its sensors disagree while it hangs straight down, by the same part on all three tendons, these may
/// stretch otherwise than the rig file says: by how much is told.
pub(super) async fn explained<L: TunedLeg>(
    leg: &mut L,
    rig: &RigFile,
    error: TuneError<L::Error>,
) -> TuneError<L::Error> {
    let TuneError::Leg(ended) = &error else {
        return error;
    };
    let telemetry = leg.telemetry_after(Some(ended)).await;
    let Some(factor) = telemetry.and_then(|telemetry| elongation_factor(&telemetry, rig)) else {
        return error;
    };
    TuneError::undetermined(
        format!(
            "the sensors disagree on the pose of a leg that hangs straight down: its tendons stretch {} times as much as the curve or \
             stiffness of the rig file says, or all its load cells or encoders are off",
            plain(significant(factor, 2)),
        ),
        "`leg disarm`, `leg clear`, calibrate the load cells; where they were right, write this number as `elongation_factor` under \
         `[tendon.measured]` of the rig file, send that with `leg settings set`, and measure again",
    )
}

/// What the lengths and tensions of a resting leg give for the key of a rig file, roughly: they begin where homing found the zero. None
/// where a tendon does not pull, where the three differ, as with one sensor that is off, or where the leg finds that by itself.
fn elongation_factor(telemetry: &Telemetry<f32>, rig: &RigFile) -> Option<f64> {
    let [x, y] = telemetry.pose;
    let hangs = telemetry.homed && x.abs() < STRAIGHT && y.abs() < STRAIGHT;
    if !hangs || !telemetry.faults.has(Fault::Residual) {
        return None;
    }
    let query = rig.query(0.0, 0.0, 0.0);
    let lengths_m = evaluate(&rig.parameters, &query).ok()?.lengths_m;
    let [mut least, mut most] = [f64::INFINITY, f64::NEG_INFINITY];
    for (i, length_m) in lengths_m.into_iter().enumerate() {
        let [at_zero_m, pulled_m, tension_n] = [
            telemetry.unstretched_at_zero_m,
            telemetry.pulled_m,
            telemetry.tensions_n,
        ]
        .map(|all| f64::from(all[i]));
        if tension_n < rig.f_min_n {
            return None;
        }
        let expected_m = rig.tendons[i].elongation(tension_n).ok()?;
        let ratio = (length_m - (at_zero_m - pulled_m)) / expected_m;
        (least, most) = (least.min(ratio), most.max(ratio));
    }
    let ratio = 0.5 * (least + most);
    let alike = most - least < ALIKE && (ratio - 1.0).abs() > MEASURED;
    let factor = rig.elongation_factor * ratio;
    let [low, high] = ELONGATION_FACTOR.range;
    (alike && (low..=high).contains(&factor)).then_some(factor)
}
