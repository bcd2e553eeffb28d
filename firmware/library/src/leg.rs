//! The whole leg: sensors in, duties out, one tick at a time. The same code on every board and in the host's process.

mod active;
mod command_queue;
mod commands;
mod give_way;
mod held;
mod homing;
mod jogging;
mod known_slack;
mod length_offsets;
mod link_watch;
mod mode;
mod phase;
mod pretension_search;
mod ramping_down;
mod recorded;
mod replacement;
mod report;
mod servo_run;
mod shadow;
mod shared;
mod slack;
mod station;
mod stretch;

pub use command_queue::CommandOutcome;

use crate::control::{Axis, LoadEstimation, Magnitude, Measured, Measurement};
use crate::drive::Drive;
use crate::jog::JogEnd;
use crate::sensors::Sensors;
use crate::settings::{Settings, SettingsError};
use crate::supervisor::{
    Agreement, ErrorGrowth, Event, Excess, Fault, FaultSet, MonitorInput, Monitors, State,
    Supervisor,
};
use active::Active;
use command_queue::CommandQueue;
use leg_model::{Error, Scalar};
use link_watch::LinkWatch;
use mode::{Mode, ModeStep, Trust};
use phase::Phase;
use shared::Shared;
pub use shared::{Checked, SLACK_M};
use stretch::StretchSearch;

/// The controller of a leg.
///
/// In this order in memory: a load instruction reaches 1020 bytes, and what every tick uses is within them.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Leg<T> {
    tick: u32,
    phase: Phase,
    /// Whether the offsets had the last cycle, so that the next one is that of the search for the pretension.
    offsets_had: bool,
    supervisor: Supervisor,
    link: LinkWatch,
    measurement: Measurement<T>,
    measured: Option<Measured<T>>,
    monitors: Monitors<T>,
    agreement: Agreement<T>,
    mode: Mode<T>,
    shared: Shared<T>,
    queue: CommandQueue,
    magnitudes: [Magnitude<T>; 3],
}

impl<T: Scalar> Leg<T> {
    /// A leg before the first reading of its sensors.
    ///
    /// # Errors
    /// Settings that are refused.
    pub fn new(settings: &Settings) -> Result<Self, SettingsError> {
        Ok(Self::assembled(settings, Checked::new(settings)?))
    }

    /// The same of settings that were checked: it cannot fail, so that a board builds its leg at its place.
    #[inline(always)]
    pub fn assembled(settings: &Settings, checked: Checked<T>) -> Self {
        Self {
            tick: 0,
            phase: Phase::Estimate,
            offsets_had: true,
            queue: CommandQueue::default(),
            link: LinkWatch::new(&settings.limits),
            measurement: Measurement::new(settings),
            measured: None,
            shared: Shared::new(settings, checked),
            mode: Mode::boot(),
            monitors: Monitors::new(settings),
            agreement: Agreement::new(settings),
            supervisor: Supervisor::default(),
            magnitudes: settings.current_outputs.each().map(Magnitude::new),
        }
    }

    /// One tick. One in eight executes a command, if one waits.
    #[inline(never)]
    pub fn tick(&mut self, sensors: &Sensors) -> Drive<T> {
        self.tick = self.tick.wrapping_add(1);
        if let Some(axis) = self.phase.monitored_motor() {
            self.measurement.end_current(axis);
        }
        if self.measurement.has_magnitudes() {
            self.take_magnitudes(sensors);
        }
        let measured = self.measurement.convert(sensors);
        for (axis, &pulled) in self.shared.axes.iter_mut().zip(&measured.pulled_m) {
            axis.track(pulled);
        }
        if self.phase == Phase::Plan {
            self.shared.play.follow(&measured.pulled_m);
        }
        if self.measurement.seeks_current_zeros() {
            // A leg that a fault has switched off meanwhile seeks them all the same.
            let driven = self.mode.state().driven();
            self.measurement.seek_current_zeros(sensors, driven);
        }
        if self.mode.boots_up() {
            self.mode = Mode::Disarmed;
        }
        // Whoever disarms or clears a leg that brakes waits until it stands: stopped at once it would swing with its payload.
        if self.phase == Phase::Pretension
            && !self.mode.brakes()
            && let Some(command) = self.queue.pop()
        {
            self.phase = Phase::Command;
            self.obey(command, &measured);
        }
        let before = self.mode.state();
        let step = self.advance(&measured);
        let faults = step.faults.union(self.faults(before, sensors, &measured));
        let after = step
            .event
            .and_then(|event| self.supervisor.next(before, event))
            .unwrap_or(before);
        let state = self.supervisor.react(after, faults);
        if state != before {
            self.enter(state, &measured);
        }
        self.phase = self.phase.next(&mut self.offsets_had);
        let mut drive = self
            .shared
            .drive(state.driven(), self.mode.turns(), &measured);
        if let Mode::Jogging(jogging) = &self.mode {
            let (motor, voltage_v) = jogging.voltage();
            drive.push(motor, voltage_v, measured.supply_v);
        }
        self.measured = Some(measured);
        drive
    }

    /// Takes what the outputs show that show no more than magnitudes.
    #[cold]
    #[inline(never)]
    fn take_magnitudes(&mut self, sensors: &Sensors) {
        let magnitudes = &mut self.magnitudes;
        if let Some(axis) = self.phase.monitored_motor() {
            self.measurement.end_magnitude(axis, magnitudes);
        }
        let applied = self.shared.axes.each_ref().map(Axis::applied);
        self.measurement
            .add_magnitudes(sensors, &applied, magnitudes);
    }

    /// One step of what the mode does.
    #[inline(always)]
    fn advance(&mut self, measured: &Measured<T>) -> ModeStep {
        let shared = &mut self.shared;
        let mut step = ModeStep {
            faults: FaultSet::NONE,
            event: None,
        };
        match &mut self.mode {
            Mode::Active(active) => {
                // Once a cycle, where there is time.
                if self.phase == Phase::Estimate {
                    shared.limit_tensions(measured, self.agreement.trusts());
                }
                // In the place of the search, so that the next mode has time to begin.
                if self.phase == Phase::Pretension && active.led_down() {
                    step.event = Some(Event::Disarm);
                } else if let Err(error) = active.step(self.phase, shared, measured) {
                    step = failed_step(active, error);
                }
                return step;
            }
            Mode::Homing(homing) => {
                return homing::step(homing, shared, &mut self.measurement, measured);
            }
            Mode::RampingDown(ramping_down) => {
                if ramping_down.relax(self.phase, shared, measured) {
                    step.event = Some(Event::Relaxed);
                }
            }
            Mode::Held(held) => {
                // A load cell may be found wrong while the leg brakes: from then on no tendon is paid out by it.
                if held.brakes() && self.supervisor.latched().overlaps(FaultSet::SUSPECT_CELLS) {
                    shared.ignore_tensions();
                }
                held.step(shared);
            }
            Mode::Jogging(jogging) => {
                if jogging.step(shared, measured) {
                    step.event = Some(Event::Jogged);
                }
            }
            Mode::Boot { .. } | Mode::Disarmed | Mode::Off => {}
        }
        // The estimate goes on although nothing uses it, so that the leg starts from where it is.
        if self.phase == Phase::Estimate && shared.zero_m.is_some() {
            shared.targets.rest();
            let found = shared.estimate(measured, LoadEstimation::Immediate);
            if found.is_err() {
                // The last pose stands, but nothing is compared with it.
                shared.estimate = None;
            }
        }
        step
    }

    /// The faults of a tick, but those of the mode itself.
    #[inline(always)]
    fn faults(&mut self, state: State, sensors: &Sensors, measured: &Measured<T>) -> FaultSet {
        if self.phase == Phase::Plan {
            self.watch_agreement();
        }
        let active = self.mode.active();
        let tensioned = active.is_some_and(|active| active.tensioned);
        let input = MonitorInput {
            sensors,
            measured,
            driven: state.driven(),
            led: state.led(),
            tensioned,
            residual_m: if tensioned && active.is_some_and(|active| active.stretch.is_over()) {
                self.shared.residual_m()
            } else {
                None
            },
            cells_trusted: matches!(state, State::Homing | State::Jogging)
                || self.agreement.trusts() && !self.supervisor.stopped(),
        };
        let mut faults = self.monitors.watch(&input);
        // Once another fault has been named, what follows from it needs no name of its own.
        let first = !self.supervisor.stopped_by_another(Fault::Residual);
        faults.add(Fault::Residual, first && !self.agreement.agree());
        if self.phase.monitors_cells() {
            let contradicted = self.agreement.contradicts();
            let excess = match input.cells_trusted {
                true if state == State::Held => self.agreement.held_excess(),
                true => Excess::Trusted,
                false if state.led() => Excess::Doubted,
                false => Excess::Open,
            };
            self.monitors.watch_cells(&input, contradicted, excess);
        }
        if let Some(turn) = self.phase.monitored_motor()
            && let (Some(axis), Some(&pulled)) =
                (self.shared.axes.get_mut(turn), measured.pulled_m.get(turn))
        {
            let shown = axis.view(pulled);
            let magnitude = self.magnitudes.get(turn);
            if self.measurement.has_magnitudes() && !magnitude.is_some_and(Magnitude::told) {
                self.monitors.watch_silent_motor(turn, &input, &shown);
            } else {
                self.monitors.watch_motor(turn, &input, &shown);
            }
        }
        faults = faults.union(self.monitors.axis_faults());
        faults.add(Fault::Infeasible, self.shared.refused);
        if let Some(active) = active {
            // What tendons of another make ask of the trim is known soon.
            let limited =
                self.shared.target.is_some_and(|target| target.limited) && active.stretch.is_over();
            faults.add(
                Fault::Unreachable,
                limited || self.shared.pretension.unreachable(),
            );
            faults.add(Fault::PointMissing, active.trajectory.point_missing());
            faults.add(Fault::Slack, active.stays_slack(&self.shared));
            faults = faults.union(active.faults);
        }
        let listens = state.follows() && !active.is_some_and(|active| active.disarming);
        faults.union(self.link.step(listens))
    }

    /// Watches whether the sensors agree on the pose: from when every tendon pulls until the tendons are paid out or the drivers
    /// are off. A held leg that is armed again goes on from what was known of it: it may swing, and what it shows meanwhile is
    /// no measure of what it shows at rest.
    #[inline(always)]
    fn watch_agreement(&mut self) {
        let estimate = self.shared.estimate.as_ref();
        let error = estimate.and_then(|estimate| estimate.length_error.as_ref());
        let is_capped = || {
            let wish_n = self.shared.pretension.pretension_n();
            let target = self.shared.target.as_ref();
            target.is_some_and(|target| target.is_capped_below(wish_n))
        };
        let growth = match (&self.mode, error) {
            (Mode::Active(active), Some(_)) if active.tensioned => {
                if active.stretch == StretchSearch::Scaled {
                    return self.agreement.end();
                } else if !active.stretch.is_over() {
                    &ErrorGrowth::TENSIONING
                } else if active.station.kept().is_some() {
                    &ErrorGrowth::STANDING
                } else if active.has_set_out() {
                    &ErrorGrowth::MOVING
                } else if is_capped() {
                    &ErrorGrowth::STANDING
                } else {
                    &ErrorGrowth::RESTING
                }
            }
            (Mode::Active(active), None) if active.begins_taut() => return self.agreement.pause(),
            (Mode::Held(_), Some(_)) if self.agreement.watches() => &ErrorGrowth::STANDING,
            // A tension beyond its curve, as of a wire that breaks for a moment: what was known stays.
            (Mode::Held(_), None) if self.agreement.watches() => return self.agreement.pause(),
            _ => return self.agreement.end(),
        };
        if let Some(error) = error {
            self.agreement.watch(error, growth);
        }
    }

    /// Begins the mode of a state.
    #[inline(never)]
    fn enter(&mut self, state: State, measured: &Measured<T>) {
        self.link.restart_silence();
        if self.mode.change_station(state, &self.shared) {
            return;
        }
        let latched = self.supervisor.latched();
        if let Some(report) = &mut self.shared.jog_report
            && report.end == JogEnd::Running
        {
            report.end = JogEnd::CutOff;
        }
        // One that homes has doubts of its earlier zero: it is not used again where that does not come to its end.
        let mut lost = latched.overlaps(FaultSet::LOSES_ZERO) || state == State::Homing;
        if matches!(state, State::RampingDown | State::Off) {
            // From now on nothing can be compared.
            lost |= self.doubts(measured).any();
            self.monitors.forget_jumps();
        }
        self.agreement.forget_far();
        let trust = Trust {
            pose: self.agreement.watches() && !self.supervisor.stopped(),
            counters: !latched.overlaps(FaultSet::SUSPECT_COUNTERS),
            free: !latched.has(Fault::Slack),
            currents: !latched.has(Fault::CurrentDisagrees),
            cells: !latched.overlaps(FaultSet::SUSPECT_CELLS),
            unfaulted: !self.supervisor.stopped(),
        };
        let momentum = self.mode.momentum(&self.shared, trust);
        self.mode = Mode::begin(state, &mut self.shared, measured, momentum, trust);
        if state == State::Active {
            // The first target comes in the next tick: pose and load have been estimated until now.
            self.phase = Phase::Command;
            // They need a target: the search comes first.
            self.offsets_had = true;
        }
        if lost {
            // Homing turns one motor after the other, with little tension, before the leg follows them together.
            self.shared.zero_m = None;
            self.shared.load_seen = false;
            self.shared.estimate = None;
        }
    }

    /// What counters and load cells contradict each other by, or themselves. A held leg is not cleared by it, but paid out and homed.
    // Apart, for none but commands and changes of the state ask for it.
    #[inline(never)]
    fn doubts(&self, measured: &Measured<T>) -> FaultSet {
        let mut doubts = FaultSet::NONE;
        // A cell that showed too much tension by itself is within what is allowed yet.
        let latched = self.supervisor.latched().has(Fault::Residual);
        let far = latched && self.agreement.is_far();
        let agree = self.agreement.agree() && !self.shared.load_seen && !far;
        doubts.add(Fault::Residual, !agree);
        let jumped = self.monitors.stay_jumped(&measured.tensions_n);
        doubts.add(Fault::TensionJump, jumped);
        doubts
    }
}

/// What follows from a step of a control law that gives no result.
// Apart from the code of every tick.
#[cold]
#[inline(never)]
fn failed_step<T: Scalar>(active: &Active<T>, error: Error) -> ModeStep {
    let faults = FaultSet::single(match error {
        Error::Infeasible => Fault::Infeasible,
        _ => Fault::PoseLost,
    });
    // Nobody gives a leg that keeps station another target.
    let event = active.station.kept().map(|_| Event::Stop);
    ModeStep { faults, event }
}
