//! The emulated leg of a scenario, its host, and what is seen of it.

use super::extremes::{Extremes, NO_RANGE, range_with_tensions};
use super::follow_error::FollowError;
use super::{Comparison, Sample, ScenarioMeasurement, SimulationError, Summary};
use crate::emulated_leg::EmulatedLeg;
use crate::hosted_leg::HostedLeg;
use crate::link::Link;
use crate::plant::Truth;
use crate::scenario::{CommandStep, Measurand, Scenario};
use leg_base::refusal;
use leg_firmware::command::{Command, Compensation};
use leg_firmware::control::MotionState;
use leg_firmware::sensors::Sensors;
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;
use leg_firmware_bench::protocol::TickReply;
use leg_rig::rig_file::RigFile;
use nalgebra::Vector3;
use std::collections::VecDeque;

/// Ticks over which the tip is averaged: a quarter of a second, about a swing of the loaded leg.
const AVERAGE_TICKS: usize = 2000;

/// Ticks between two samples.
pub const SAMPLE_TICKS: u32 = 16;

/// Time that a command takes to reach the leg, s, at most.
pub(super) const COMMAND_S: f64 = 0.02;

/// Time within which it is answered, s: a leg that brakes executes no command until it stands.
const ANSWER_S: f64 = 1.0;

/// Everything but the steps.
pub(super) struct TestStand<'a> {
    pub leg: HostedLeg<&'a mut dyn Link>,
    /// Since the last mark.
    pub extremes: Extremes,
    /// Since the last path began.
    pub follow_error: FollowError,
    /// What has come out up to now.
    pub summary: Summary,
    /// Those that the firmware started with.
    pub settings: Settings,
    /// Commands that the leg has not answered: the number of each, what it is, and when it was sent, s.
    unanswered: Vec<(u16, &'static str, f64)>,
    /// Whether the leg compensates its load.
    compensated: bool,
    bounds_n: [f64; 2],
    /// Distance of the true tip from where the path that is followed has it now, m.
    path_error_m: Option<f64>,
    tips_m: VecDeque<Vector3<f64>>,
}

impl<'a> TestStand<'a> {
    pub fn new(
        leg: EmulatedLeg<&'a mut dyn Link>,
        rig: &RigFile,
        settings: &Settings,
        scenario: &Scenario,
    ) -> Self {
        let leg = HostedLeg::new(leg, rig, scenario.start.direction(), scenario.seed);
        Self {
            extremes: Extremes::new(leg.truth()),
            leg,
            follow_error: FollowError::default(),
            settings: settings.clone(),
            summary: Summary {
                tension_range_n: NO_RANGE,
                ..Summary::default()
            },
            unanswered: Vec::new(),
            compensated: true,
            path_error_m: None,
            bounds_n: [rig.f_min_n, rig.f_max_n],
            tips_m: VecDeque::new(),
        }
    }

    /// Sends the command of a step.
    pub fn command(&mut self, step: &CommandStep) -> Result<(), SimulationError> {
        self.send(&step.command(), step.into())
    }

    /// Sends a command; `what` it is, for people.
    pub fn send(&mut self, command: &Command, what: &'static str) -> Result<(), SimulationError> {
        match *command {
            Command::Compensation(compensation) => {
                self.compensated = compensation != Compensation::Off;
            }
            // A leg that homes compensates.
            Command::Home => self.compensated = true,
            _ => {}
        }
        let number = self.leg.send(command).map_err(SimulationError::Command)?;
        self.unanswered.push((number, what, self.leg.time_s()));
        Ok(())
    }

    /// Whether a command may be answered yet.
    pub fn awaits_answer(&self) -> bool {
        let last = self.unanswered.last();
        last.is_some_and(|(_, _, at_s)| self.leg.time_s() - at_s < ANSWER_S)
    }

    /// Notes which commands the leg has refused in the last tick.
    fn note_refusals(&mut self) {
        for answer in self.leg.answers() {
            let sent = |(number, ..): &mut (u16, _, _)| *number == answer.number;
            let answered = self.unanswered.extract_if(.., sent).next();
            if let (Some((_, command, at_s)), Err(refusal)) = (answered, answer.result) {
                let [reason, _] = refusal::description(&refusal);
                self.summary.note_refused(command, at_s, reason);
            }
        }
    }

    /// Nothing is commanded beside what the leg itself takes for its target.
    pub fn forget_commanded(&mut self) {
        self.path_error_m = None;
        self.leg.set_commanded(None);
    }

    /// Compares the true tip with the motion of a direction, as horizontal components.
    pub fn compare_with(&mut self, motion: &MotionState<f64>) {
        let direction = motion.position;
        let commanded_m = self.leg.tip_m(direction);
        let ([x, y], [x_rate, y_rate]) = (direction, motion.rate);
        let length_m = self.leg.tip_length_m();
        let z_rate = -(x * x_rate + y * y_rate) / commanded_m.z * length_m;
        let velocity = Vector3::new(x_rate, y_rate, z_rate) * length_m;
        let error_m = self.leg.truth().tip_m - commanded_m;
        self.follow_error.take(&error_m, &velocity);
        self.path_error_m = Some(error_m.norm());
        self.leg.set_commanded(Some(direction));
    }

    /// Records a measured value with its unit, the range in which it has to be, and what was measured.
    pub fn record(
        &mut self,
        name: &str,
        (value, unit): (f64, &'static str),
        between: [f64; 2],
        quantity: Option<Measurand>,
    ) {
        let at_s = self.leg.time_s();
        self.summary.measurements.push(ScenarioMeasurement {
            name: name.into(),
            value,
            unit,
            between,
            at_s,
            quantity,
            compensated: self.compensated,
        });
    }

    /// One tick.
    ///
    /// # Errors
    /// [`crate::emulated_leg::EmulationError::NotFinite`] if a number is lost; a link that fails.
    pub fn tick(
        &mut self,
        comparison: &Comparison,
        watch: impl FnOnce(&Sensors, &[u8], &TickReply),
    ) -> Result<(), SimulationError> {
        let time_s = self.leg.time_s();
        let (taken, reply) = self.leg.tick()?;
        watch(&taken.sensors, &taken.link, &reply);
        self.sample(time_s, comparison, &reply.telemetry);
        self.note_refusals();
        let truth = *self.leg.truth();
        self.take(time_s, &truth, &reply);
        Ok(())
    }

    /// Takes a tick that began at a time, and where it has brought the leg.
    fn take(&mut self, time_s: f64, truth: &Truth, reply: &TickReply) {
        let telemetry = &reply.telemetry;
        self.extremes.take(truth, self.bounds_n);
        let summary = &mut self.summary;
        summary.tension_range_n = range_with_tensions(summary.tension_range_n, truth);
        if reply.motors.enabled && telemetry.state.led() {
            let [_, highest] = range_with_tensions([0.0; 2], truth);
            summary.driven_max_n = summary.driven_max_n.max(highest);
        }
        for fault in telemetry.faults.faults() {
            if summary.faults.iter().all(|(seen, _)| *seen != fault) {
                summary.faults.push((fault, time_s));
            }
        }
        self.tips_m.push_back(truth.tip_m);
        if self.tips_m.len() > AVERAGE_TICKS {
            self.tips_m.pop_front();
        }
        self.summary.ticks += 1;
    }

    fn sample(&mut self, time_s: f64, comparison: &Comparison, telemetry: &Telemetry<f32>) {
        if self.summary.ticks.is_multiple_of(SAMPLE_TICKS.into()) {
            self.summary.samples.push(Sample {
                time_s,
                comparison: *comparison,
                telemetry: *telemetry,
            });
        }
    }

    /// The leg as the next tick finds it, and how far it is from a path that it follows.
    pub fn comparison(&self) -> Comparison {
        Comparison {
            path_error_mm: self.path_error_m.map(|m| m * 1000.0),
            ..self.leg.comparison()
        }
    }

    /// Where the tip was on average, m; none before the first tick.
    pub fn average_tip_m(&self) -> Option<Vector3<f64>> {
        let sum: Vector3<f64> = self.tips_m.iter().sum();
        (!self.tips_m.is_empty()).then(|| sum / (self.tips_m.len() as f64))
    }
}
