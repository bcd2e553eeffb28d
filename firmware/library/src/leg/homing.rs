//! One tick of homing.

use super::mode::ModeStep;
use super::shared::Shared;
use crate::control::{HomingSequence, HomingStep, Measured, Measurement};
use crate::supervisor::{Event, Fault, FaultSet};
use leg_model::Scalar;

/// Goes on with homing, and does what that asks for.
#[inline(never)]
pub fn step<T: Scalar>(
    homing: &mut HomingSequence<T>,
    shared: &mut Shared<T>,
    measurement: &mut Measurement<T>,
    measured: &Measured<T>,
) -> ModeStep {
    let asked = if shared.current_outputs.has_magnitudes() {
        homing.step(&shared.mechanism, &replace_currents(shared, measured))
    } else {
        homing.step(&shared.mechanism, measured)
    };
    let mut failed = false;
    if !homing.releases() {
        let f_max_n = T::from(shared.limits.homing.f_max_n);
        shared.f_max_n = f_max_n;
        let twice_n = f_max_n + f_max_n;
        failed = measured.tensions_n.iter().any(|&tension| tension > twice_n);
    }
    let mut event = None;
    match asked {
        HomingStep::Lead(goals) => {
            for (axis, goal) in shared.axes.iter_mut().zip(&goals) {
                axis.lead(goal, T::one());
            }
        }
        HomingStep::Tare(offsets_n) => measurement.tare(&offsets_n),
        HomingStep::Searching => {}
        HomingStep::Found(zero_m) => {
            shared.zero_m = Some(zero_m);
            shared.estimator.straight_down();
            (shared.just_homed, shared.load_seen) = (true, false);
            event = Some(Event::Homed);
        }
        HomingStep::Failed(tendon) => {
            shared.failed_tendon = tendon;
            failed = true;
        }
    }
    let mut faults = FaultSet::NONE;
    faults.add(Fault::HomingFailed, failed);
    ModeStep { faults, event }
}

/// What is measured, and in the place of the currents those that are compared with their ceilings.
fn replace_currents<T: Scalar>(shared: &Shared<T>, measured: &Measured<T>) -> Measured<T> {
    let mut measured = *measured;
    let supply_v = measured.supply_v;
    let axes = shared.limits.jogs.iter().zip(&shared.axes);
    let currents = measured.currents_a.iter_mut().zip(axes).enumerate();
    for (motor, (current, (bounds, axis))) in currents {
        if shared.current_outputs.hides_short_pulses(motor) {
            *current = bounds.ceiling_a(*current, &axis.applied(), supply_v);
        }
    }
    measured
}
