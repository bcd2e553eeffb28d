//! What the recorder takes of a leg after a tick.

use super::Leg;
use crate::drive::Drive;
use crate::settings::RecordedSignal;
use crate::supervisor::FaultSet;
use leg_model::Scalar;

impl<T: Scalar> Leg<T> {
    /// Ticks since the start.
    #[inline(always)]
    pub fn ticks(&self) -> u32 {
        self.tick
    }

    /// The latched faults that do more than limit.
    #[inline(always)]
    pub fn stopping_faults(&self) -> FaultSet {
        self.supervisor.latched().stopping()
    }

    /// A signal after the tick that gave this drive; zeros before the first tick.
    #[inline(always)]
    pub fn recorded(&self, signal: RecordedSignal, drive: &Drive<T>) -> [T; 3] {
        let zeros = [T::zero(); 3];
        let shared = &self.shared;
        let Some(measured) = &self.measured else {
            return zeros;
        };
        match signal {
            RecordedSignal::Tensions => measured.tensions_n,
            RecordedSignal::TargetTensions => {
                shared.target.map_or(zeros, |target| target.tensions_n)
            }
            RecordedSignal::Pulled => measured.pulled_m,
            RecordedSignal::References => {
                let [a, b, c] = &shared.axes;
                [a.reference_m(), b.reference_m(), c.reference_m()]
            }
            RecordedSignal::Currents => measured.currents_a,
            RecordedSignal::Duties => drive.duty,
            RecordedSignal::Pose => {
                let direction = shared.estimator.direction().vector();
                let residual_m = shared.residual_m().unwrap_or(T::zero());
                [direction.x, direction.y, residual_m]
            }
            RecordedSignal::Board => [
                measured.supply_v,
                measured.temperature_c,
                T::from(f32::from(self.state() as u8)),
            ],
        }
    }
}
