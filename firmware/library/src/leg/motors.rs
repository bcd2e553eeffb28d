//! What the motors do in each state, and what a change of state begins.

use super::{Leg, Slack};
use crate::command::Compensation;
use crate::control::{AxisGoal, AxisInput, Homing, Measured};
use crate::drive::Drive;
use crate::supervisor::{Event, FaultSet, State};
use leg_model::Scalar;

impl<T: Scalar> Leg<T> {
    /// Begins what a state does.
    #[inline(never)]
    pub(super) fn entered(&mut self, state: State, measured: &Measured<T>) {
        for (axis, &pulled) in self.axes.iter_mut().zip(&measured.pulled_m) {
            axis.rest(pulled);
        }
        self.silence = 0;
        self.f_max_n = self.mechanism.f_max_n;
        self.homing_failed = false;
        self.rest_m = measured.pulled_m;
        let travel_m = match state {
            // All the way to slack, the last step of it, and once more for each tendon.
            State::Homing => self.limits.homing_travel_m + T::TWO * self.limits.homing_release_m,
            State::RampingDown => self.limits.relax_travel_m,
            _ => T::MAX,
        };
        self.lowest_m = self.rest_m.map(|rest| rest - travel_m);
        match state {
            State::Homing => {
                self.failed_tendon = 0;
                self.homing = Some(Homing::new(&self.settings_of_homing, &measured.pulled_m));
            }
            State::Active => self.begin_here(measured),
            State::Boot | State::Disarmed | State::Held | State::RampingDown | State::Off => {}
        }
    }

    /// Follows commands from the present pose and pretension on.
    fn begin_here(&mut self, measured: &Measured<T>) {
        let [a, b, c] = measured.tensions_n;
        let pretension_n = (a + b + c) * T::from(1.0 / 3.0);
        let compensated = self.compensation != Compensation::Off;
        self.targets.start(pretension_n, compensated);
        self.trajectory
            .start(self.estimator.direction().half_tangent());
        self.tensioned = false;
        self.slack = Slack::default();
        self.target = None;
        self.residual_m = None;
        self.phase = 0;
    }

    /// How far a tendon may move while the leg is held, m: not at all while it is doubted what the cells say.
    #[inline(always)]
    fn hold_travel_m(&self) -> T {
        if self.supervisor.latched().overlaps(FaultSet::DOUBTED_CELLS) {
            T::zero()
        } else {
            self.limits.hold_travel_m
        }
    }

    /// Pulls in any tendon that is below the minimum tension, as far as that is allowed.
    #[inline(never)]
    pub(super) fn keep_f_min(&mut self, measured: &Measured<T>) {
        let travel_m = self.hold_travel_m();
        self.lowest_m = self.rest_m.map(|rest| rest - travel_m);
        for (i, axis) in self.axes.iter_mut().enumerate() {
            let low = measured.steady_tensions_n[i] < self.mechanism.f_min_n;
            let room = measured.pulled_m[i] - self.rest_m[i] < travel_m;
            let goal = if low && room {
                measured.pulled_m[i] + self.limits.hold_travel_m
            } else {
                axis.reference_m()
            };
            axis.lead(
                &AxisGoal {
                    pulled_m: goal,
                    speed_m_per_s: self.limits.ramp_m_per_s,
                },
                T::one(),
            );
        }
    }

    /// Lets every tendon out that still pulls, as far as that is allowed: a dead load cell may say so for ever.
    #[inline(never)]
    pub(super) fn relax(&mut self, measured: &Measured<T>) {
        let mut relaxed = true;
        for (i, axis) in self.axes.iter_mut().enumerate() {
            let pulls = measured.steady_tensions_n[i] > self.limits.slack_n;
            let room = self.rest_m[i] - measured.pulled_m[i] < self.limits.relax_travel_m;
            relaxed &= !(pulls && room);
            let goal = if pulls && room {
                axis.reference_m() - self.limits.hold_travel_m
            } else {
                axis.reference_m()
            };
            axis.lead(
                &AxisGoal {
                    pulled_m: goal,
                    speed_m_per_s: self.limits.ramp_m_per_s,
                },
                T::one(),
            );
        }
        if relaxed {
            self.supervisor.happen(Event::Relaxed);
        }
    }

    /// The duties of the state.
    #[inline(always)]
    pub(super) fn drive(&mut self, measured: &Measured<T>) -> Drive<T> {
        let state = self.supervisor.state();
        let mut drive = Drive {
            duty: [T::zero(); 3],
            enabled: state.driven(),
        };
        if !drive.enabled {
            return drive;
        }
        for (i, axis) in self.axes.iter_mut().enumerate() {
            drive.duty[i] = axis.drive(&AxisInput {
                pulled_m: measured.pulled_m[i],
                tension_n: measured.tensions_n[i],
                f_max_n: self.f_max_n,
                supply_v: measured.supply_v,
                lowest_m: self.lowest_m[i],
            });
        }
        drive
    }
}
