//! The whole leg: sensors in, duties out, one tick at a time. The same code on every board and in the host's process.

mod active;
mod commands;
mod motors;

use crate::command::{Command, CommandRefusal, Compensation};
use crate::control::{
    Axis, CYCLE_TICKS, Estimator, Homing, Measured, Measurement, Mechanism, Pretension, Target,
    Targets, Trajectory, ticks,
};
use crate::drive::Drive;
use crate::sensors::Sensors;
use crate::settings::{Settings, SettingsError};
use crate::supervisor::{Event, Fault, FaultSet, Monitors, State, Supervisor, View};
use crate::telemetry::Telemetry;
use heapless::Deque;
use leg_model::{Error, Scalar};

/// Commands that may wait: a tick takes one.
const COMMANDS_MAX: usize = 8;

/// Ticks of [`State::Boot`].
const BOOT_TICKS: u32 = 16;

/// What became of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// The number that the command was given.
    pub number: u16,
    /// Whether it was obeyed.
    pub result: Result<(), CommandRefusal>,
}

/// The controller of a leg.
#[derive(Debug)]
pub struct Leg<T> {
    tick: u32,
    /// The tick that ends the boot.
    ready_tick: u32,
    phase: u8,
    commands: Deque<(u16, Command), COMMANDS_MAX>,
    outcomes: Deque<Outcome, COMMANDS_MAX>,
    silence: u32,
    bad_frames: u16,
    mechanism: Mechanism<T>,
    measurement: Measurement<T>,
    estimator: Estimator<T>,
    trajectory: Trajectory<T>,
    pretension: Pretension<T>,
    targets: Targets<T>,
    axes: [Axis<T>; 3],
    monitors: Monitors<T>,
    supervisor: Supervisor,
    homing: Option<Homing<T>>,
    /// Tension above which a tendon is let out in what the leg does now, N, and while homing takes tendons up.
    f_max_n: T,
    homing_f_max_n: T,
    settings_of_homing: crate::settings::Homing,
    /// Length of each tendon without tension when the board started, m.
    zero_m: Option<[T; 3]>,
    compensation: Compensation,
    target: Option<Target<T>>,
    residual_m: Option<T>,
    /// Whether every tendon has been above the minimum tension since the leg was armed.
    tensioned: bool,
    /// What is left of the way until every tendon pulls.
    slack: Slack<T>,
    /// Where the tendons were when the state began, and how far they may be let out in it, m.
    rest_m: [T; 3],
    lowest_m: [T; 3],
    refused: bool,
    failed_tendon: u8,
    /// Whether homing has given up, or pulls more than it may.
    homing_failed: bool,
    measured: Option<Measured<T>>,
    limits: Limits<T>,
}

/// The way from slack to taut: every tendon is as far from its target as every other, so that the leg does not swing.
#[derive(Clone, Copy, Debug)]
struct Slack<T> {
    /// How far, m; none before the first target.
    left_m: Option<T>,
    /// Cycles since the leg was armed.
    cycles: u32,
}

impl<T: Scalar> Slack<T> {
    /// Whether every tendon is led to its target itself.
    #[inline(always)]
    fn gone(&self) -> bool {
        self.left_m.is_some_and(|left| left <= T::zero())
    }
}

impl<T> Default for Slack<T> {
    fn default() -> Self {
        Self {
            left_m: None,
            cycles: 0,
        }
    }
}

/// What the tick itself decides by.
#[derive(Clone, Copy, Debug)]
struct Limits<T> {
    silence: u32,
    bad_frames: u16,
    ramp_m_per_s: T,
    homing_travel_m: T,
    homing_release_m: T,
    hold_travel_m: T,
    relax_travel_m: T,
    taut_cycles: u32,
    slack_n: T,
    servo_m_per_s: T,
    tilt_max_sine: T,
}

/// The first whole number that is not below.
fn at_least(number: f32) -> u16 {
    let whole = number as u16;
    whole.saturating_add(u16::from(f32::from(whole) < number))
}

impl<T: Scalar> Leg<T> {
    /// A leg that has not seen its sensors yet.
    ///
    /// # Errors
    /// Settings that are refused.
    pub fn new(settings: &Settings) -> Result<Self, SettingsError> {
        settings.check()?;
        let limits = &settings.limits;
        let zero = |i: usize| settings.axes[i].unstretched_at_zero_m;
        let zero_m = match [zero(0), zero(1), zero(2)] {
            [Some(a), Some(b), Some(c)] => Some([a.into(), b.into(), c.into()]),
            _ => None,
        };
        Ok(Self {
            tick: 0,
            ready_tick: BOOT_TICKS,
            phase: 0,
            commands: Deque::new(),
            outcomes: Deque::new(),
            silence: 0,
            bad_frames: 0,
            mechanism: Mechanism::new(settings)?,
            measurement: Measurement::new(settings),
            estimator: Estimator::new(settings),
            trajectory: Trajectory::new(settings),
            pretension: Pretension::new(settings.pretension_n.into()),
            targets: Targets::new(settings),
            axes: [Axis::new(settings); 3],
            monitors: Monitors::new(settings),
            supervisor: Supervisor::default(),
            homing: None,
            f_max_n: settings.f_max_n.into(),
            homing_f_max_n: settings.homing.f_max_n.into(),
            settings_of_homing: settings.homing,
            zero_m,
            compensation: Compensation::Estimated,
            target: None,
            residual_m: None,
            tensioned: false,
            slack: Slack::default(),
            rest_m: [T::zero(); 3],
            lowest_m: [T::zero(); 3],
            refused: false,
            failed_tendon: 0,
            homing_failed: false,
            measured: None,
            limits: Limits {
                silence: ticks(limits.command_time_s),
                bad_frames: at_least(limits.bad_frames),
                ramp_m_per_s: limits.ramp_m_per_s.into(),
                homing_travel_m: settings.homing.travel_m.into(),
                homing_release_m: settings.homing.release_m.into(),
                hold_travel_m: limits.hold_travel_m.into(),
                relax_travel_m: limits.relax_travel_m.into(),
                taut_cycles: ticks(limits.taut_time_s) / u32::from(CYCLE_TICKS),
                slack_n: limits.slack_n.into(),
                servo_m_per_s: settings.servo.speed_m_per_s.into(),
                tilt_max_sine: settings.tilt_max_sine.into(),
            },
        })
    }

    /// One tick. It takes one of the commands that wait.
    #[inline(never)]
    pub fn tick(&mut self, sensors: &Sensors) -> Drive<T> {
        self.tick = self.tick.wrapping_add(1);
        let measured = self.measurement.convert(sensors);
        for (axis, &pulled) in self.axes.iter_mut().zip(&measured.pulled_m) {
            axis.track(pulled);
        }
        if self.tick == self.ready_tick {
            self.supervisor.happen(Event::Ready);
        }
        if let Some(command) = self.commands.pop_front() {
            self.obey(command, &measured);
        }
        let before = self.supervisor.state();
        let result = self.advance(&measured);
        let faults = self.faults(sensors, &measured, result);
        self.supervisor.watch(faults);
        let state = self.supervisor.state();
        if state != before {
            self.entered(state, &measured);
        }
        self.phase = if self.phase + 1 < CYCLE_TICKS {
            self.phase + 1
        } else {
            0
        };
        let drive = self.drive(&measured);
        self.measured = Some(measured);
        drive
    }

    /// One step of what the state does.
    #[inline(always)]
    fn advance(&mut self, measured: &Measured<T>) -> Result<(), Error> {
        match self.supervisor.state() {
            State::Active => self.follow(measured),
            State::Homing => {
                self.seek(measured);
                Ok(())
            }
            State::Held => {
                self.look(measured);
                self.keep_f_min(measured);
                Ok(())
            }
            State::RampingDown => {
                self.look(measured);
                self.relax(measured);
                Ok(())
            }
            State::Boot | State::Disarmed | State::Off => {
                self.look(measured);
                Ok(())
            }
        }
    }

    /// Every fault of the tick.
    #[inline(always)]
    fn faults(
        &mut self,
        sensors: &Sensors,
        measured: &Measured<T>,
        result: Result<(), Error>,
    ) -> FaultSet {
        let state = self.supervisor.state();
        let active = state == State::Active;
        let view = View {
            sensors,
            measured,
            driven: state.driven(),
            led: state.follows(),
            tensioned: active && self.tensioned,
            residual_m: if active && self.tensioned {
                self.residual_m
            } else {
                None
            },
        };
        let mut faults = self.monitors.watch(&view);
        // Where there is most time.
        let turns: &[usize] = match self.phase {
            0 => &[0],
            3 => &[1, 2],
            _ => &[],
        };
        for &turn in turns {
            if let (Some(axis), Some(&pulled)) = (self.axes.get(turn), measured.pulled_m.get(turn))
            {
                let shown = axis.view(pulled);
                self.monitors.watch_axis(turn, &view, &shown);
            }
        }
        faults = faults.with(self.monitors.of_axes());
        faults.add(Fault::Infeasible, self.refused);
        let late = self.slack.cycles > self.limits.taut_cycles;
        faults.add(Fault::Slack, active && !self.tensioned && late);
        match result {
            Ok(()) => {}
            Err(Error::Infeasible) => faults.add(Fault::Infeasible, true),
            Err(_) => faults.add(Fault::PoseLost, true),
        }
        let limited = self.target.is_some_and(|target| target.limited);
        faults.add(
            Fault::Unreachable,
            active && (limited || self.pretension.unreachable()),
        );
        self.silence = if state.follows() {
            self.silence.saturating_add(1)
        } else {
            0
        };
        faults.add(Fault::CommandTimeout, self.silence > self.limits.silence);
        faults.add(Fault::BadFrame, self.bad_frames >= self.limits.bad_frames);
        faults.add(Fault::HomingFailed, self.homing_failed);
        faults
    }

    /// Goes on from the duties that another leg on the same motors has applied in this tick: a shadow's integrals are not on
    /// its own motors, and would wander.
    pub fn take_over(&mut self, applied: &Drive<T>) {
        let supply_v = self
            .measured
            .map_or(T::zero(), |measured| measured.supply_v);
        for (axis, &duty) in self.axes.iter_mut().zip(&applied.duty) {
            axis.take_over(duty * supply_v);
        }
    }

    /// Begins in the place of another leg on the same board: with its count of ticks and the faults that nobody has cleared.
    /// The commands that wait are refused, and their outcomes told from here.
    pub fn succeed(&mut self, before: &mut Self) {
        before.forget_commands();
        core::mem::swap(&mut self.outcomes, &mut before.outcomes);
        self.tick = before.tick;
        self.ready_tick = before.tick.wrapping_add(BOOT_TICKS);
        self.supervisor.inherit(before.supervisor.latched());
    }

    /// What the leg may do.
    #[must_use]
    pub fn state(&self) -> State {
        self.supervisor.state()
    }

    /// What the leg tells of itself.
    #[must_use]
    pub fn telemetry(&self) -> Telemetry<T> {
        let zero = [T::zero(); 3];
        let (tensions_n, pulled_m) = self.measured.map_or((zero, zero), |measured| {
            (measured.tensions_n, measured.pulled_m)
        });
        let pose = self.estimator.direction().vector();
        let target = self.target.map_or(pose, |target| target.direction.vector());
        let [a, b, c] = &self.axes;
        Telemetry {
            tick: self.tick,
            state: self.supervisor.state(),
            faults: self.supervisor.latched(),
            homed: self.zero_m.is_some(),
            failed_tendon: self.failed_tendon,
            moving: self.state() == State::Active && self.trajectory.moving(),
            target: [target.x, target.y],
            pose: [pose.x, pose.y],
            residual_m: self.residual_m.unwrap_or(T::zero()),
            tensions_n,
            target_tensions_n: self.target.map_or(zero, |target| target.tensions_n),
            pulled_m,
            reference_m: [a.reference_m(), b.reference_m(), c.reference_m()],
            pretension_n: self.target.map_or(T::zero(), |target| target.pretension_n),
            stiffness_nm_per_rad: self.pretension.stiffness_nm_per_rad(),
            load_nm: self.estimator.excess_nm(),
            payload_kg: self.estimator.payload_kg(),
            unstretched_at_zero_m: self.zero_m.unwrap_or(zero),
        }
    }
}
