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
        let mut telemetry = self.course();
        self.report_measured(&mut telemetry);
        telemetry
    }

    /// The first part of the telemetry: where the leg is and where it shall be, with zeros for what
    /// [`Self::report_measured`] adds. In two parts, as the board's control interrupt waits while one of them is made.
    #[inline(never)]
    #[must_use]
    pub fn course(&self) -> Telemetry<T> {
        let zero = [T::zero(); 3];
        let shared = &self.shared;
        let pose = shared.estimator.direction().vector();
        let target = shared
            .target
            .map_or(pose, |target| target.direction.vector());
        let target = [target.x, target.y];
        let active = self.mode.active();
        let [pretension_commanded_n, stiffness_commanded_nm_per_rad] = shared.pretension.demanded();
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
            residual_m: T::zero(),
            tensions_n: zero,
            target_tensions_n: zero,
            pulled_m: zero,
            reference_m: zero,
            motor_currents_a: zero,
            supply_v: T::zero(),
            temperature_c: T::zero(),
            pretension_commanded_n,
            stiffness_commanded_nm_per_rad,
            pretension_n: shared
                .target
                .map_or(T::zero(), |target| target.pretension_n),
            stiffness_nm_per_rad: shared.pretension.stiffness_nm_per_rad(),
            load_nm: [T::zero(); 2],
            payload_kg: T::zero(),
            unstretched_at_zero_m: zero,
            elongation_factor: shared.elongation_factor,
        }
    }

    /// Adds the second part of the telemetry: what is measured, and what follows from that.
    #[inline(never)]
    pub fn report_measured(&self, telemetry: &mut Telemetry<T>) {
        let shared = &self.shared;
        telemetry.residual_m = shared.residual_m().unwrap_or(T::zero());
        if let Some(measured) = &self.measured {
            telemetry.tensions_n = measured.tensions_n;
            telemetry.pulled_m = measured.pulled_m;
            telemetry.motor_currents_a = measured.currents_a;
            telemetry.supply_v = measured.supply_v;
            telemetry.temperature_c = measured.temperature_c;
        }
        if let Some(target) = &shared.target {
            telemetry.target_tensions_n = target.tensions_n;
        }
        telemetry.reference_m = shared.axes.each_ref().map(|axis| axis.reference_m());
        telemetry.load_nm = shared.estimator.excess_nm(&shared.mechanism);
        telemetry.payload_kg = shared.estimator.load.payload_kg();
        if let Some(zero_m) = shared.zero_m {
            telemetry.unstretched_at_zero_m = zero_m;
        }
    }
}
