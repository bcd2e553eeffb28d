//! What more than one mode of the leg uses.

use crate::command::Compensation;
use crate::control::{
    Axis, AxisGoal, AxisInput, CYCLE_TICKS, Estimator, LoadEstimation, Measured, Mechanism,
    MotionLimits, PretensionSearch, Target, TargetGenerator, ticks,
};
use crate::drive::Drive;
use crate::settings::{Homing, Settings, SettingsError};
use crate::supervisor::State;
use leg_model::{Error, Scalar};

/// The control law's state that outlasts a mode.
#[derive(Clone, Debug)]
pub struct Shared<T> {
    pub mechanism: Mechanism<T>,
    pub estimator: Estimator<T>,
    pub pretension: PretensionSearch<T>,
    pub targets: TargetGenerator<T>,
    pub axes: [Axis<T>; 3],
    pub compensation: Compensation,
    /// Length of each tendon without tension when the board started, m.
    pub zero_m: Option<[T; 3]>,
    /// The last target, and the residual of the last estimate, m.
    pub target: Option<Target<T>>,
    pub residual_m: Option<T>,
    /// Tension above which a tendon is paid out now, N.
    pub f_max_n: T,
    /// No tendon is paid out beyond this, m.
    pub lowest_m: [T; 3],
    /// Whether a command or a pose was refused, until another one is accepted.
    pub refused: bool,
    /// Tendon at which homing failed the last time, from 1; 0 for none.
    pub failed_tendon: u8,
    pub limits: LegLimits<T>,
}

/// Limits of the settings that the modes themselves apply.
#[derive(Clone, Copy, Debug)]
pub struct LegLimits<T> {
    pub motion: MotionLimits<T>,
    pub homing: Homing,
    pub homing_f_max_n: T,
    pub ramp_m_per_s: T,
    pub hold_travel_m: T,
    pub relax_travel_m: T,
    pub taut_cycles: u32,
    pub slack_n: T,
    pub servo_m_per_s: T,
    pub tilt_max_sine: T,
}

impl<T: Scalar> LegLimits<T> {
    fn new(settings: &Settings) -> Self {
        let limits = &settings.limits;
        Self {
            motion: MotionLimits::new(&settings.motion),
            homing: settings.homing,
            homing_f_max_n: settings.homing.f_max_n.into(),
            ramp_m_per_s: limits.ramp_m_per_s.into(),
            hold_travel_m: limits.hold_travel_m.into(),
            relax_travel_m: limits.relax_travel_m.into(),
            taut_cycles: ticks(limits.taut_time_s) / u32::from(CYCLE_TICKS),
            slack_n: limits.slack_n.into(),
            servo_m_per_s: settings.servo.speed_m_per_s.into(),
            tilt_max_sine: settings.tilt_max_sine.into(),
        }
    }
}

impl<T: Scalar> Shared<T> {
    /// Before the first tick.
    pub fn new(settings: &Settings) -> Result<Self, SettingsError> {
        let zero = |i: usize| settings.axes[i].unstretched_at_zero_m;
        let zero_m = match [zero(0), zero(1), zero(2)] {
            [Some(a), Some(b), Some(c)] => Some([a.into(), b.into(), c.into()]),
            _ => None,
        };
        Ok(Self {
            mechanism: Mechanism::new(settings)?,
            estimator: Estimator::new(settings),
            pretension: PretensionSearch::new(settings.pretension_n.into()),
            targets: TargetGenerator::new(settings),
            axes: [Axis::new(settings); 3],
            compensation: Compensation::Estimated,
            zero_m,
            target: None,
            residual_m: None,
            f_max_n: settings.f_max_n.into(),
            lowest_m: [T::zero(); 3],
            refused: false,
            failed_tendon: 0,
            limits: LegLimits::new(settings),
        })
    }

    /// Every axis stays where it is; sets how far and at which tension a tendon may be paid out in a state.
    pub fn come_to_rest(&mut self, state: State, measured: &Measured<T>) {
        for (axis, &pulled) in self.axes.iter_mut().zip(&measured.pulled_m) {
            axis.rest(pulled);
        }
        self.f_max_n = self.mechanism.f_max_n;
        let travel_m = match state {
            // All the way to slack, the last step of it, and once more for each tendon.
            State::Homing => {
                let homing = &self.limits.homing;
                T::from(homing.travel_m) + T::TWO * T::from(homing.release_m)
            }
            State::RampingDown => self.limits.relax_travel_m,
            _ => T::MAX,
        };
        self.lowest_m = measured.pulled_m.map(|rest| rest - travel_m);
    }

    /// Estimates pose and load.
    #[inline(never)]
    pub fn estimate(
        &mut self,
        measured: &Measured<T>,
        load_estimation: LoadEstimation,
    ) -> Result<(), Error> {
        let Some(mut unstretched_m) = self.zero_m else {
            return Err(Error::NotConverged);
        };
        for (unstretched, &pulled) in unstretched_m.iter_mut().zip(&measured.pulled_m) {
            *unstretched -= pulled;
        }
        let estimate = self.estimator.update(
            &self.mechanism,
            &unstretched_m,
            &measured.steady_tensions_n,
            self.targets.torsion(),
            load_estimation,
        )?;
        self.residual_m = Some(estimate.residual_m);
        Ok(())
    }

    /// Leads an axis to a goal at the speed of [`LegLimits::ramp_m_per_s`].
    #[inline(always)]
    pub fn ramp(axis: &mut Axis<T>, pulled_m: T, limits: &LegLimits<T>) {
        axis.lead(
            &AxisGoal {
                pulled_m,
                speed_m_per_s: limits.ramp_m_per_s,
            },
            T::one(),
        );
    }

    /// The duties of a tick, if the drivers are on.
    #[inline(always)]
    pub fn drive(&mut self, enabled: bool, measured: &Measured<T>) -> Drive<T> {
        let mut drive = Drive {
            duty: [T::zero(); 3],
            enabled,
        };
        if !enabled {
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
