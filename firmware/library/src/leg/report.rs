//! What a leg reports.

use super::Leg;
use crate::jog::JogReport;
use crate::sensors::CurrentZero;
use crate::supervisor::State;
use crate::telemetry::Telemetry;
use leg_model::Scalar;

impl<T: Scalar> Leg<T> {
    /// What the leg may do.
    #[must_use]
    pub fn state(&self) -> State {
        self.mode.state()
    }

    /// The zero of each motor's current.
    #[must_use]
    pub fn current_zeros(&self) -> [CurrentZero; 3] {
        self.measurement.current_zeros()
    }

    /// What the last jog measured; none since the start.
    #[must_use]
    pub fn jog_report(&self) -> Option<&JogReport<T>> {
        self.shared.jog_report.as_ref()
    }

    /// What the leg reports of itself.
    #[must_use]
    pub fn telemetry(&self) -> Telemetry<T> {
        let zero = [T::zero(); 3];
        let shared = &self.shared;
        let measured = self.measured.as_ref();
        let pose = shared.estimator.direction().vector();
        let target = shared
            .target
            .map_or(pose, |target| target.direction.vector());
        let target = [target.x, target.y];
        let active = self.mode.active();
        let [pretension_commanded_n, stiffness_commanded_nm_per_rad] = shared.pretension.demanded();
        let [a, b, c] = &shared.axes;
        Telemetry {
            tick: self.tick,
            state: self.state(),
            faults: self.supervisor.latched(),
            homed: shared.zero_m.is_some(),
            failed_tendon: shared.failed_tendon,
            moving: self.mode.moving(),
            commanded: active.and_then(|active| active.commanded).unwrap_or(target),
            target,
            pose: [pose.x, pose.y],
            residual_m: shared.residual_m().unwrap_or(T::zero()),
            tensions_n: measured.map_or(zero, |measured| measured.tensions_n),
            target_tensions_n: shared.target.map_or(zero, |target| target.tensions_n),
            pulled_m: measured.map_or(zero, |measured| measured.pulled_m),
            reference_m: [a.reference_m(), b.reference_m(), c.reference_m()],
            motor_currents_a: measured.map_or(zero, |measured| measured.currents_a),
            supply_v: measured.map_or(T::zero(), |measured| measured.supply_v),
            temperature_c: measured.map_or(T::zero(), |measured| measured.temperature_c),
            pretension_commanded_n,
            stiffness_commanded_nm_per_rad,
            pretension_n: shared
                .target
                .map_or(T::zero(), |target| target.pretension_n),
            stiffness_nm_per_rad: shared.pretension.stiffness_nm_per_rad(),
            load_nm: shared.estimator.excess_nm(&shared.mechanism),
            payload_kg: shared.estimator.load.payload_kg(),
            unstretched_at_zero_m: shared.zero_m.unwrap_or(zero),
            elongation_factor: shared.elongation_factor,
        }
    }
}
