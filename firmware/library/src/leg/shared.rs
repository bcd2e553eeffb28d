//! What more than one mode of the leg uses.

use super::station::StationLimits;
use crate::command::Compensation;
use crate::control::{
    Axis, AxisInput, CYCLE_TICKS, Estimate, Estimator, Friction, JogBounds, LoadEstimation,
    Measured, Mechanism, MotionLimits, Play, PretensionSearch, REACHED, Stream, StreamLimits,
    SwingDamping, TICK_S, Target, TargetGenerator, Turn, bounds, ticks,
};
use crate::drive::Drive;
use crate::jog::JogReport;
use crate::settings::{CurrentOutputs, Homing, Settings, SettingsError};
use crate::supervisor::State;
use leg_model::{Direction, Error, Scalar, inverse_kinematics};

/// The control law's state that outlasts a mode.
///
/// In this order in memory: a load instruction reaches 1020 bytes, and what every tick uses is within them.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Shared<T> {
    pub axes: [Axis<T>; 3],
    pub estimator: Estimator<T>,
    pub targets: TargetGenerator<T>,
    pub damping: SwingDamping<T>,
    pub play: Play<T>,
    /// Length of each tendon without tension when the board started, m.
    pub zero_m: Option<[T; 3]>,
    /// The last target, and the residual of the last estimate, m.
    pub target: Option<Target<T>>,
    pub estimate: Option<Estimate<T>>,
    /// Tension above which a tendon is paid out now, N.
    pub f_max_n: T,
    /// No tendon is paid out beyond this, m.
    pub lowest_m: [T; 3],
    /// Where the last ramp down led each tendon that it knew to be slack there, m; −MAX where that is not known.
    pub known_slack_m: [T; 3],
    /// Whether a command or a pose was refused, until another one is accepted.
    pub refused: bool,
    /// Tendon at which homing failed the last time, from 1; 0 for none.
    pub failed_tendon: u8,
    /// What the current outputs show.
    pub current_outputs: CurrentOutputs,
    pub compensation: Compensation,
    /// Whether the leg was homed and not armed since.
    pub just_homed: bool,
    /// Whether it showed a load straight down, and has its zero from then.
    pub load_seen: bool,
    pub limits: LegLimits<T>,
    pub pretension: PretensionSearch<T>,
    pub mechanism: Mechanism<T>,
    pub stream: Stream<T>,
    /// What the last jog measured.
    pub jog_report: Option<JogReport<T>>,
    pub station: StationLimits<T>,
    pub friction: [Friction<T>; 3],
    /// Elongation of the tendons over that of the settings.
    pub elongation_factor: T,
}

/// Slack of each tendon of a relaxed leg whose zero is known, m: more than the servo leaves, and little enough that the tip of a
/// hanging leg plays by a millimetre.
pub const SLACK_M: f32 = 1e-4;

/// A tendon that is beyond the maximum tension by 2.5 of the bands in which the servo slows down, 10 N at the default, is paid out by
/// the whole speed, and nearer to it by the square of what it is beyond: it gives way before it is 10 % beyond, and is hardly paid out by a
/// load cell that reads some newtons too much until that is found. By the band alone, load cells that had changed their places let
/// a leg swing up to 268 N, and up to 232 N so.
const GIVE_PART: f32 = 1.0 / (2.5 * 2.5);

/// Limits of the settings that the modes themselves apply.
#[derive(Clone, Copy, Debug)]
pub struct LegLimits<T> {
    pub motion: MotionLimits<T>,
    /// Damping of the joint, N·m·s/rad.
    pub joint_damping: T,
    pub homing: Homing,
    pub ramp_m_per_s: T,
    pub relax_travel_m: T,
    /// Ticks that this takes at that speed.
    pub relax_ticks: u32,
    /// Lengths of the tendons of a leg that hangs straight down, with their slack, m.
    pub slack_lengths_m: [T; 3],
    pub taut_cycles: u32,
    /// The farthest that every motor follows in a tick, m.
    pub servo_step_m: T,
    pub tilt_max_sine: T,
    /// Part of the square of what a tension is beyond the maximum to which a tendon gives way, 1/N.
    pub give_per_n: T,
    /// Of each motor.
    pub jogs: [JogBounds<T>; 3],
}

impl<T: Scalar> LegLimits<T> {
    // Apart, so that its kinematics take stack only as long as they run.
    #[inline(never)]
    fn new(settings: &Settings, mechanism: &Mechanism<T>) -> Result<Self, Error> {
        let limits = &settings.limits;
        let down = Direction::straight_down();
        let mut twisted = None;
        let geometry = mechanism.geometry(&down, T::zero(), &mut twisted);
        let hanging_m = inverse_kinematics(geometry, &down)?.lengths;
        Ok(Self {
            jogs: settings
                .servos
                .each_ref()
                .map(|servo| JogBounds::new(settings, servo)),
            slack_lengths_m: (hanging_m.add_scalar(T::from(SLACK_M))).into(),
            motion: MotionLimits::new(settings),
            joint_damping: settings.motion.joint_damping_nm_s_per_rad.into(),
            homing: settings.homing,
            ramp_m_per_s: limits.ramp_m_per_s.into(),
            relax_travel_m: limits.relax_travel_m.into(),
            relax_ticks: ticks(limits.relax_travel_m / limits.ramp_m_per_s),
            taut_cycles: ticks(limits.taut_time_s) / u32::from(CYCLE_TICKS),
            servo_step_m: T::from(settings.least(|servo| servo.speed_m_per_s)) * T::from(TICK_S),
            tilt_max_sine: T::from(settings.tilt_max_sine) * T::from(REACHED),
            give_per_n: T::from(GIVE_PART / settings.greatest(|servo| servo.f_max_band_n)),
        })
    }
}

/// What of a leg can be refused. It is made first, so that the rest is written at its place without a copy on the stack.
#[derive(Debug)]
pub struct Checked<T> {
    mechanism: Mechanism<T>,
    limits: LegLimits<T>,
}

impl<T: Scalar> Checked<T> {
    /// Checks settings.
    ///
    /// # Errors
    /// Settings that are refused.
    // Apart, so that its checks take stack only as long as they run.
    #[inline(never)]
    pub fn new(settings: &Settings) -> Result<Self, SettingsError> {
        settings.check()?;
        let mechanism = Mechanism::new(settings)?;
        let limits = LegLimits::new(settings, &mechanism)?;
        Ok(Self { mechanism, limits })
    }
}

impl<T: Scalar> Shared<T> {
    /// Before the first tick.
    #[inline(always)]
    pub fn new(settings: &Settings, checked: Checked<T>) -> Self {
        let zero = |i: usize| settings.axes[i].unstretched_at_zero_m;
        let axis = |i: usize| Axis::new(&settings.servos[i]);
        let friction = |i: usize| Friction::new(&settings.servos[i]);
        let zero_m = match [zero(0), zero(1), zero(2)] {
            [Some(a), Some(b), Some(c)] => Some([a.into(), b.into(), c.into()]),
            _ => None,
        };
        Self {
            estimator: Estimator::new(settings),
            pretension: PretensionSearch::new(settings.pretension_n.into()),
            targets: TargetGenerator::new(settings),
            damping: SwingDamping::new(settings),
            play: Play::new(settings.servos.each_ref().map(|servo| servo.play_m)),
            stream: Stream::new(StreamLimits::new(settings)),
            axes: [axis(0), axis(1), axis(2)],
            compensation: Compensation::Estimated,
            zero_m,
            target: None,
            estimate: None,
            f_max_n: settings.f_max_n.into(),
            lowest_m: [T::zero(); 3],
            known_slack_m: [-T::MAX; 3],
            refused: false,
            failed_tendon: 0,
            current_outputs: settings.current_outputs,
            limits: checked.limits,
            mechanism: checked.mechanism,
            jog_report: None,
            station: StationLimits::new(settings),
            friction: [friction(0), friction(1), friction(2)],
            elongation_factor: T::one(),
            just_homed: false,
            load_seen: false,
        }
    }

    /// The most that a motor leaves of its way, m.
    pub fn dead_band_m(&self) -> T {
        let [a, b, c] = self.axes.each_ref().map(Axis::dead_band_m);
        bounds::max(bounds::max(a, b), c)
    }

    /// Every axis stays where it is; sets how far and at which tension a tendon may be paid out in a state.
    pub fn come_to_rest(&mut self, state: State, measured: &Measured<T>) {
        for (axis, &pulled) in self.axes.iter_mut().zip(&measured.pulled_m) {
            axis.rest(pulled);
        }
        (self.f_max_n, self.lowest_m) = match state {
            State::Homing => {
                // All the way to slack, the last step of it, and once more for each tendon.
                let homing = &self.limits.homing;
                let travel_m = T::from(homing.travel_m) + T::TWO * T::from(homing.release_m);
                (
                    self.mechanism.f_max_n,
                    measured.pulled_m.map(|rest| rest - travel_m),
                )
            }
            State::Active => (self.mechanism.f_max_n, [-T::MAX; 3]),
            _ => return self.ignore_tensions(),
        };
    }

    /// Sets the tension above which a tendon is paid out. Before lengths and tensions agree it is beyond all that are measured, for a
    /// load cell that shows too much would pay its tendon out until it is found. Once they do, the servo of a tendon beyond the maximum
    /// has the square of what is beyond it left to give way.
    #[inline(always)]
    pub fn limit_tensions(&mut self, measured: &Measured<T>, trusted: bool) {
        let f_max_n = self.mechanism.f_max_n;
        let [a, b, c] = measured.tensions_n;
        let highest_n = bounds::max(bounds::max(a, b), bounds::max(c, f_max_n));
        self.f_max_n = if trusted {
            let over_n = highest_n - f_max_n;
            highest_n - over_n * over_n * self.limits.give_per_n
        } else {
            highest_n
        };
    }

    /// Whatever turns from now on, turns by its counter alone.
    pub fn ignore_tensions(&mut self) {
        (self.f_max_n, self.lowest_m) = (T::MAX, [-T::MAX; 3]);
    }

    /// The unstretched lengths of the tendons, m; none where the zero is not known.
    #[inline(always)]
    pub fn unstretched_m(&self, measured: &Measured<T>) -> Option<[T; 3]> {
        let mut unstretched_m = self.zero_m?;
        let lag_m = self.play.lag_m();
        for (i, unstretched) in unstretched_m.iter_mut().enumerate() {
            *unstretched -= measured.pulled_m[i] + lag_m[i];
        }
        Some(unstretched_m)
    }

    /// Estimates the pose of a leg whose tendons are longer than their tensions show as the last target says, and takes the load.
    #[inline(never)]
    pub fn estimate(
        &mut self,
        measured: &Measured<T>,
        load_estimation: LoadEstimation,
    ) -> Result<(), Error> {
        let Some(mut unstretched_m) = self.unstretched_m(measured) else {
            return Err(Error::NotConverged);
        };
        for (unstretched, &damped) in unstretched_m.iter_mut().zip(self.targets.damped_m()) {
            *unstretched += damped;
        }
        let estimate = self.estimator.update(
            &self.mechanism,
            &unstretched_m,
            &measured.steady_tensions_n,
            self.targets.torsion(),
            load_estimation,
        )?;
        self.estimate = Some(estimate);
        Ok(())
    }

    /// A step of the load of a leg that shall turn so.
    #[inline(never)]
    pub fn step_load(&mut self, turn: &Turn<T>) {
        if let Some(target) = &self.target {
            self.estimator
                .step_load(&self.mechanism, &target.direction, turn);
        }
    }

    /// What forward kinematics left over in the last estimate, m.
    #[inline(always)]
    pub fn residual_m(&self) -> Option<T> {
        self.estimate.as_ref().map(|estimate| estimate.residual_m)
    }

    /// Has every tendon stretch by a factor of what its settings say, at the tensions that they have now.
    #[cold]
    #[inline(never)]
    pub fn scale_tendons(&mut self, factor: T) {
        let change = factor / self.elongation_factor;
        for tendon in &mut self.mechanism.tendons {
            tendon.scale(change);
        }
        self.elongation_factor = factor;
        // The next target begins where the tensions are.
        self.targets.start(self.compensation != Compensation::Off);
    }

    /// Feeds each motor the voltage against its friction, at the tensions of the last target.
    // Not beside the code of every tick, which it would take registers from.
    #[inline(never)]
    pub fn feed_friction(&mut self) {
        let Some(target) = &self.target else { return };
        let asked = self.friction.iter().zip(&target.tensions_n);
        for (axis, (friction, &tension_n)) in self.axes.iter_mut().zip(asked) {
            axis.feed_friction(friction, tension_n);
        }
    }

    /// The duties of a tick: none where the motors rest.
    #[inline(always)]
    pub fn drive(&mut self, enabled: bool, turns: bool, measured: &Measured<T>) -> Drive<T> {
        let mut drive = Drive {
            duty: [T::zero(); 3],
            enabled,
        };
        if !turns {
            return drive;
        }
        let supply_v = measured.supply_v;
        let duty_per_v = if supply_v > T::one() {
            T::one() / supply_v
        } else {
            T::zero()
        };
        for (i, axis) in self.axes.iter_mut().enumerate() {
            drive.duty[i] = axis.drive(&AxisInput {
                pulled_m: measured.pulled_m[i],
                tension_n: measured.tensions_n[i],
                f_max_n: self.f_max_n,
                supply_v,
                duty_per_v,
                lowest_m: self.lowest_m[i],
            });
        }
        drive
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{Checked, Shared};
    use crate::control::Measured;
    use crate::settings::Settings;
    use crate::supervisor::State;

    const MEASURED: Measured<f64> = Measured::resting([0.01, 0.02, 0.03], [1.0; 3]);

    /// A cell that reads too much pays its tendon out no farther than homing goes; a leg that follows commands is bounded by its
    /// maximum tension alone. Every other state does without its cells.
    #[test]
    fn a_state_decides_how_far_a_tension_may_pay_a_tendon_out() {
        let settings = Settings::table_1().unwrap();
        let homing = &settings.homing;
        let travel_m = f64::from(homing.travel_m) + 2.0 * f64::from(homing.release_m);
        let f_max_n = f64::from(settings.f_max_n);
        let mut shared = Shared::<f64>::new(&settings, Checked::new(&settings).unwrap());
        for state in State::ALL {
            shared.come_to_rest(state, &MEASURED);
            let (expected_n, bound_m) = match state {
                State::Homing => (f_max_n, Some(travel_m)),
                State::Active => (f_max_n, None),
                _ => (f64::MAX, None),
            };
            assert_eq!(shared.f_max_n, expected_n, "{state:?}");
            for (i, pulled_m) in MEASURED.pulled_m.into_iter().enumerate() {
                let lowest_m = bound_m.map_or(-f64::MAX, |bound_m| pulled_m - bound_m);
                assert!((shared.lowest_m[i] - lowest_m).abs() < 1e-9, "{state:?}");
                assert_eq!(shared.axes[i].reference_m(), pulled_m);
            }
        }
    }

    /// Up to the maximum tension it is that. Beyond it the servo has the square of what is beyond left to give way, at 2.5 bands the whole
    /// of one. While the sensors do not agree it has nothing.
    #[test]
    fn a_tendon_gives_way_by_the_square_of_what_is_beyond_the_maximum() {
        let settings = Settings::table_1().unwrap();
        let f_max_n = f64::from(settings.f_max_n);
        let band_n = f64::from(settings.servos[0].f_max_band_n);
        let mut shared = Shared::<f64>::new(&settings, Checked::new(&settings).unwrap());
        for i in 0..3 {
            for (over_n, left_n) in [
                (-50.0, None),
                (0.0, Some(0.0)),
                (1.25 * band_n, Some(0.25 * band_n)),
                (2.5 * band_n, Some(band_n)),
                (3.75 * band_n, Some(2.25 * band_n)),
            ] {
                let mut tensions_n = [0.5 * f_max_n; 3];
                tensions_n[i] = f_max_n + over_n;
                let measured = Measured::resting([0.01; 3], tensions_n);
                shared.limit_tensions(&measured, true);
                let expected_n = left_n.map_or(f_max_n, |left_n| tensions_n[i] - left_n);
                assert!((shared.f_max_n - expected_n).abs() < 1e-4, "{over_n} N");
                shared.limit_tensions(&measured, false);
                assert_eq!(shared.f_max_n, f_max_n.max(tensions_n[i]), "{over_n} N");
            }
        }
    }
}
