//! What the leg does while it follows commands or looks for its zero.

use super::Leg;
use crate::command::Compensation;
use crate::control::bounds::most;
use crate::control::{Axis, AxisGoal, CYCLE_S, CYCLE_TICKS, HomingStep, Measured, Weighing, Wish};
use crate::supervisor::Event;
use leg_model::{Error, Scalar};

impl<T: Scalar> Leg<T> {
    /// Follows the trajectory: estimate, pretension, target and plan in turn, one a tick.
    #[inline(always)]
    pub(super) fn follow(&mut self, measured: &Measured<T>) -> Result<(), Error> {
        let Some(zero_m) = self.zero_m else {
            return Err(Error::NotConverged);
        };
        match self.phase {
            0 => self.track(&zero_m, measured),
            1 => self.choose_pretension(),
            2 => self.aim(&zero_m, measured),
            // A leg that is not taut yet does not set out.
            _ if self.slack.gone() => {
                self.trajectory.advance_plan();
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Goes on estimating pose and load while nothing is made of them, so that the leg starts from where it is.
    #[inline(always)]
    pub(super) fn look(&mut self, measured: &Measured<T>) {
        if let (0, Some(zero_m)) = (self.phase, self.zero_m) {
            // Where there is no result, the last pose stands.
            let _ = self.estimate(&zero_m, measured, Weighing::AtOnce);
        }
    }

    /// Estimates pose and load. While the tendons come up from slack there is no load to be told.
    #[inline(always)]
    fn track(&mut self, zero_m: &[T; 3], measured: &Measured<T>) -> Result<(), Error> {
        let weighing = if self.compensation == Compensation::Frozen || !self.tensioned {
            Weighing::Frozen
        } else {
            Weighing::Filtered
        };
        if !self.tensioned {
            self.slack.cycles = self.slack.cycles.saturating_add(1);
            let f_min_n = self.mechanism.f_min_n;
            let tensions_n = &measured.steady_tensions_n;
            self.tensioned =
                self.slack.gone() && tensions_n.iter().all(|&tension| tension > f_min_n);
        }
        self.estimate(zero_m, measured, weighing)
    }

    #[inline(never)]
    fn estimate(
        &mut self,
        zero_m: &[T; 3],
        measured: &Measured<T>,
        weighing: Weighing,
    ) -> Result<(), Error> {
        let mut unstretched_m = *zero_m;
        for (unstretched, &pulled) in unstretched_m.iter_mut().zip(&measured.pulled_m) {
            *unstretched -= pulled;
        }
        let tensions_n = &measured.steady_tensions_n;
        let torsion = self.targets.torsion();
        let mechanism = &self.mechanism;
        let estimate =
            self.estimator
                .update(mechanism, &unstretched_m, tensions_n, torsion, weighing)?;
        self.residual_m = Some(estimate.residual_m);
        Ok(())
    }

    #[inline(never)]
    fn choose_pretension(&mut self) -> Result<(), Error> {
        match &self.target {
            Some(target) => {
                self.pretension
                    .step(&self.mechanism, target, self.estimator.payload_kg())
            }
            None => Ok(()),
        }
    }

    #[inline(never)]
    fn aim(&mut self, zero_m: &[T; 3], measured: &Measured<T>) -> Result<(), Error> {
        let taut = self.slack.gone();
        let wish = Wish {
            q: self.trajectory.step(),
            excess_nm: self.estimator.excess_nm(),
            compensated: self.compensation != Compensation::Off,
            trimmed: self.compensation == Compensation::Estimated && self.tensioned,
            // The pretension comes up when every tendon is as far from slack as every other.
            pretension_n: if taut {
                self.pretension.pretension_n()
            } else {
                T::zero()
            },
        };
        let target = self
            .targets
            .next(&self.mechanism, &wish, &measured.steady_tensions_n);
        let mut target = match target {
            Ok(target) => target,
            Err(error) => {
                self.stay();
                return Err(error);
            }
        };
        let mut pulled_m = *zero_m;
        for (pulled, &unstretched) in pulled_m.iter_mut().zip(&target.unstretched_m) {
            *pulled -= unstretched;
        }
        let speed_m_per_s = if taut {
            self.limits.servo_m_per_s
        } else {
            self.tauten(&mut pulled_m);
            self.limits.ramp_m_per_s
        };
        let per_ticks = T::one() / T::from(f32::from(CYCLE_TICKS));
        for (axis, &pulled_m) in self.axes.iter_mut().zip(&pulled_m) {
            let goal = AxisGoal {
                pulled_m,
                speed_m_per_s,
            };
            axis.lead(&goal, per_ticks);
        }
        target.limited &= taut;
        self.target = Some(target);
        Ok(())
    }

    /// Stays where the last target was: there is none where the trajectory is now.
    #[cold]
    fn stay(&mut self) {
        for axis in &mut self.axes {
            axis.pause();
        }
        if let Some(target) = &self.target {
            self.trajectory.start(target.direction.half_tangent());
        }
        self.refused = true;
    }

    /// Takes from the goals how far the tendons are still kept from them, m, and lessens that.
    #[inline(never)]
    fn tauten(&mut self, goals_m: &mut [T; 3]) {
        let mut left_m = self.slack.left_m.unwrap_or_else(|| {
            let farthest = |farthest: T, (axis, &goal): (&Axis<T>, &T)| {
                most(farthest, goal - axis.reference_m())
            };
            self.axes
                .iter()
                .zip(goals_m.iter())
                .fold(T::zero(), farthest)
        });
        let step_m = self.limits.ramp_m_per_s * T::from(CYCLE_S);
        let mut there = true;
        for (axis, goal) in self.axes.iter().zip(goals_m) {
            *goal -= left_m;
            there &= (*goal - axis.reference_m()).abs() <= T::TWO * step_m;
        }
        if there {
            left_m -= step_m;
        }
        self.slack.left_m = Some(left_m);
    }

    /// One tick of homing.
    #[inline(never)]
    pub(super) fn seek(&mut self, measured: &Measured<T>) {
        let Some(homing) = &mut self.homing else {
            return;
        };
        let step = homing.step(&self.mechanism, &measured.pulled_m, &measured.tensions_n);
        if !homing.releases() {
            self.f_max_n = self.homing_f_max_n;
            let twice = self.homing_f_max_n + self.homing_f_max_n;
            self.homing_failed = measured.tensions_n.iter().any(|&tension| tension > twice);
        }
        match step {
            HomingStep::Lead(goals) => {
                for (axis, goal) in self.axes.iter_mut().zip(&goals) {
                    axis.lead(goal, T::one());
                }
            }
            HomingStep::Tare(offsets_n) => self.measurement.tare(&offsets_n),
            HomingStep::Searching => {}
            HomingStep::Found(zero_m) => {
                self.zero_m = Some(zero_m);
                self.homing = None;
                self.estimator.straight_down();
                self.supervisor.happen(Event::Homed);
            }
            HomingStep::Failed(tendon) => {
                self.failed_tendon = tendon;
                self.homing_failed = true;
                self.homing = None;
            }
        }
    }
}
