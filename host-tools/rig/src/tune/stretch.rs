//! How much the tendons stretch for what they do by the rig file, of a leg that its firmware holds for it.

use super::error::TuneError;
use super::tuned_leg::TunedLeg;
use crate::number::{plain, significant};
use crate::rig_file::{ELONGATION_FACTOR, RigFile};
use leg_firmware::supervisor::Fault;
use leg_firmware::telemetry::Telemetry;
use leg_model::{Elasticity, evaluate};

/// How far the leg may lean, as a direction: its lengths are taken for those straight down.
const STRAIGHT: f32 = 0.005;

/// Why the leg was not measured. Where its sensors disagree while it hangs straight down, on tendons that all pull, the tendons may stretch
/// otherwise than by the rig file: by how much is told.
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
            "the sensors disagree on the pose of a leg that hangs straight down: its tendons stretch {} times as much as by the curve or \
             stiffness of the rig file, or its load cells are off",
            plain(significant(factor, 2)),
        ),
        "calibrate the load cells; where they were right, write this number as `elongation_factor` under `[tendon.measured]` of the rig \
         file, send that with `leg settings set`, and measure again",
    )
}

/// What the lengths and tensions of a resting leg give for the key of a rig file, roughly: they begin where homing found the zero. None
/// where nothing says that the tendons are others, or no file may say so.
fn elongation_factor(telemetry: &Telemetry<f32>, rig: &RigFile) -> Option<f64> {
    let [x, y] = telemetry.pose;
    let hangs = telemetry.homed && x.abs() < STRAIGHT && y.abs() < STRAIGHT;
    if !hangs || !telemetry.faults.has(Fault::Residual) {
        return None;
    }
    let lengths_m = evaluate(&rig.parameters, &rig.query(0.0, 0.0, 0.0))
        .ok()?
        .lengths_m;
    let (mut stretched_m, mut expected_m) = (0.0, 0.0);
    for (i, length_m) in lengths_m.into_iter().enumerate() {
        let [at_zero_m, pulled_m] =
            [telemetry.unstretched_at_zero_m, telemetry.pulled_m].map(|all| f64::from(all[i]));
        stretched_m += length_m - (at_zero_m - pulled_m);
        expected_m += rig.tendons[i]
            .elongation(telemetry.tensions_n[i].into())
            .ok()?;
    }
    let factor = rig.elongation_factor * stretched_m / expected_m;
    let [low, high] = ELONGATION_FACTOR.range;
    (low..=high).contains(&factor).then_some(factor)
}
