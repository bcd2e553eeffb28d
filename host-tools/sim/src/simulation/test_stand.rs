//! The emulated leg of a scenario, its host, and what is seen of it.

use super::extremes::{Extremes, NO_RANGE, range_with_tensions};
use super::follow_error::FollowError;
use super::{Comparison, Measurement, Sample, SimulationError, Summary};
use crate::emulated_leg::EmulatedLeg;
use crate::host::Host;
use crate::link::Link;
use crate::plant::Truth;
use crate::scenario::{CommandStep, Measurand, Scenario};
use leg_firmware::command::{Command, Compensation};
use leg_firmware::control::MotionState;
use leg_firmware::sensors::Sensors;
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use leg_firmware_bench::protocol::TickReply;
use leg_rig::rig_file::RigFile;
use nalgebra::Vector3;
use std::collections::VecDeque;

/// Ticks over which the tip is averaged: a quarter of a second, about a swing of the loaded leg.
const AVERAGE_TICKS: usize = 2000;

/// Ticks between two samples.
pub const SAMPLE_TICKS: u32 = 16;

/// Everything but the steps.
pub(super) struct TestStand<'a> {
    pub leg: EmulatedLeg<&'a mut dyn Link>,
    pub host: Host,
    pub truth: Truth,
    pub telemetry: Option<Telemetry<f32>>,
    /// Since the last mark.
    pub extremes: Extremes,
    /// Since the last path began.
    pub follow_error: FollowError,
    /// What has come out up to now.
    pub summary: Summary,
    /// Those that the firmware started with.
    pub settings: Settings,
    /// Whether the leg compensates its load.
    compensated: bool,
    /// Where the host has sent the leg, as horizontal components; none after a hold.
    commanded: Option<[f64; 2]>,
    bounds_n: [f64; 2],
    /// Distance of the true tip from where the path that is followed has it now, m.
    path_error_m: Option<f64>,
    tip_length_m: f64,
    tips_m: VecDeque<Vector3<f64>>,
}

impl<'a> TestStand<'a> {
    pub fn new(
        leg: EmulatedLeg<&'a mut dyn Link>,
        rig: &RigFile,
        settings: &Settings,
        scenario: &Scenario,
    ) -> Self {
        let (truth, parameters) = (leg.plant().truth(), &rig.parameters);
        Self {
            leg,
            host: Host::new(scenario.seed),
            extremes: Extremes::new(&truth),
            follow_error: FollowError::default(),
            settings: settings.clone(),
            truth,
            telemetry: None,
            summary: Summary {
                tension_range_n: NO_RANGE,
                ..Summary::default()
            },
            compensated: true,
            commanded: Some(scenario.start.direction()),
            path_error_m: None,
            bounds_n: [rig.f_min_n, rig.f_max_n],
            tip_length_m: parameters.joint_length_m + parameters.leg_length_m,
            tips_m: VecDeque::new(),
        }
    }

    pub fn time_s(&self) -> f64 {
        self.leg.plant().time_s()
    }

    pub fn state(&self) -> State {
        self.telemetry
            .map_or(State::Boot, |telemetry| telemetry.state)
    }

    /// Sends the command of a step.
    pub fn command(&mut self, step: &CommandStep) -> Result<(), SimulationError> {
        self.send(&step.command())
    }

    /// Sends a command, and notes where it sends the leg.
    pub fn send(&mut self, command: &Command) -> Result<(), SimulationError> {
        match *command {
            Command::Move { x, y } => self.commanded = Some([x, y].map(f64::from)),
            Command::Home => self.commanded = Some([0.0; 2]),
            Command::Hold | Command::Stop => self.commanded = None,
            Command::Compensation(compensation) => {
                self.compensated = compensation != Compensation::Off;
            }
            _ => {}
        }
        self.host.send(command).map_err(SimulationError::Command)
    }

    /// Nothing is commanded beside what the leg itself takes for its target.
    pub fn forget_commanded(&mut self) {
        self.path_error_m = None;
        self.commanded = None;
    }

    /// Compares the true tip with the motion of a direction, as horizontal components.
    pub fn compare_with(&mut self, motion: &MotionState<f64>) {
        let direction = motion.position;
        let commanded_m = self.tip_m(direction);
        let ([x, y], [x_rate, y_rate]) = (direction, motion.rate);
        let z_rate = -(x * x_rate + y * y_rate) / commanded_m.z * self.tip_length_m;
        let velocity = Vector3::new(x_rate, y_rate, z_rate) * self.tip_length_m;
        let error_m = self.truth.tip_m - commanded_m;
        self.follow_error.take(&error_m, &velocity);
        self.path_error_m = Some(error_m.norm());
        self.commanded = Some(direction);
    }

    /// Records a measured value with its unit, the range in which it has to be, and what was measured.
    pub fn record(
        &mut self,
        name: &str,
        (value, unit): (f64, &'static str),
        between: [f64; 2],
        quantity: Option<Measurand>,
    ) {
        let at_s = self.time_s();
        self.summary.measurements.push(Measurement {
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
    /// [`SimulationError::NotFinite`] if a number is lost; a link that fails.
    pub fn tick(
        &mut self,
        comparison: &Comparison,
        watch: impl FnOnce(&Sensors, &[u8], &TickReply),
    ) -> Result<(), SimulationError> {
        let time_s = self.time_s();
        let link = self.host.outgoing(self.summary.ticks);
        let (taken, reply) = self.leg.advance(link)?;
        watch(&taken.sensors, &taken.link, &reply);
        let truth = self.leg.plant().truth();
        let numbers = truth.tensions_n.iter().chain(truth.tip_m.iter());
        if !numbers.copied().all(f64::is_finite) {
            return Err(SimulationError::NotFinite(time_s));
        }
        self.sample(time_s, comparison, &reply.telemetry);
        self.take(time_s, truth, &reply);
        Ok(())
    }

    /// Takes a tick that began at a time, and where it has brought the leg.
    fn take(&mut self, time_s: f64, truth: Truth, reply: &TickReply) {
        let telemetry = &reply.telemetry;
        self.truth = truth;
        self.telemetry = Some(*telemetry);
        self.extremes.take(&truth, self.bounds_n);
        let summary = &mut self.summary;
        summary.tension_range_n = range_with_tensions(summary.tension_range_n, &truth);
        if reply.motors.enabled && telemetry.state.led() {
            let [_, highest] = range_with_tensions([0.0; 2], &truth);
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

    /// The leg as the next tick finds it.
    pub fn comparison(&self) -> Comparison {
        let pose = self.telemetry.map_or([0.0; 2], |telemetry| telemetry.pose);
        let mm = |tip_m: Vector3<f64>| (tip_m * 1000.0).into();
        Comparison {
            tip_commanded_mm: mm(self.commanded_m()),
            tip_reference_mm: mm(self.target_m()),
            tip_estimated_mm: mm(self.tip_m(pose.map(f64::from))),
            tip_true_mm: mm(self.truth.tip_m),
            tensions_true_n: self.truth.tensions_n,
            payload_true_kg: self.truth.payload_kg,
            path_error_mm: self.path_error_m.map(|m| m * 1000.0),
        }
    }

    /// Where the trajectory has the tip now, m.
    fn target_m(&self) -> Vector3<f64> {
        self.tip_m(
            self.telemetry
                .map_or([0.0; 2], |telemetry| telemetry.target.map(f64::from)),
        )
    }

    /// Where the host has sent the tip, m: whatever the leg itself takes for its target.
    pub fn commanded_m(&self) -> Vector3<f64> {
        self.commanded
            .map_or_else(|| self.target_m(), |direction| self.tip_m(direction))
    }

    /// The tip of a leg with a direction, m.
    fn tip_m(&self, [x, y]: [f64; 2]) -> Vector3<f64> {
        let z = -(1.0 - x * x - y * y).max(0.0).sqrt();
        Vector3::new(x, y, z) * self.tip_length_m
    }

    /// Where the tip was on average, m.
    pub fn average_tip_m(&self) -> Vector3<f64> {
        let sum: Vector3<f64> = self.tips_m.iter().sum();
        sum / (self.tips_m.len().max(1) as f64)
    }
}
