//! The simulated leg, the host that commands it, and what is seen of both.

use super::extremes::Extremes;
use super::outcome::{Finding, Sample, Summary};
use super::{Divergence, SimulationError};
use crate::plant::{Plant, Truth};
use crate::scenario::Scenario;
use leg_base::tick_time::tick_s;
use leg_firmware::command::Command;
use leg_firmware::drive::Drive;
use leg_firmware::frame::{self, MAX_FRAME};
use leg_firmware::host_link::{HOST_SCHEMA, Hello};
use leg_firmware::host_link::{HostId, HostRequest};
use leg_firmware::linked_leg::LINK_BYTES_MAX;
use leg_firmware::supervisor::{Fault, FaultSet, State};
use leg_firmware::telemetry::Telemetry;
use leg_rig::rig_file::RigFile;
use nalgebra::Vector3;
use std::collections::VecDeque;

/// Ticks over which the tip is averaged: a quarter of a second, about a swing of the loaded leg.
const AVERAGE_TICKS: usize = 2000;

/// Ticks between two signs of life of the host.
const ALIVE_TICKS: u64 = 400;

/// Ticks between two samples.
const SAMPLE_TICKS: u64 = 16;

/// The only host of a scenario.
const HOST: HostId = 1;

/// A force at the tip that comes up smoothly.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pushing {
    pub force_n: Vector3<f64>,
    pub from_s: f64,
    pub until_s: f64,
    /// Time in which it comes up, s.
    pub ramp_s: f64,
}

/// Everything but the controller.
#[derive(Debug)]
pub(super) struct Stage {
    pub plant: Plant,
    pub truth: Truth,
    pub telemetry: Option<Telemetry<f32>>,
    pub extremes: Extremes,
    pub silent: bool,
    pub pushing: Option<Pushing>,
    pub bounds_n: [f64; 2],
    pub tip_length_m: f64,
    pub rng: fastrand::Rng,
    /// Where the host has sent the leg, as horizontal components; none after a hold on the way.
    pub asked: Option<[f64; 2]>,
    /// Whether the leg compensates its load.
    pub compensated: bool,
    all: Extremes,
    driven_max_n: f64,
    queue: VecDeque<u8>,
    sequence: u16,
    tips_m: VecDeque<Vector3<f64>>,
    ticks: u64,
    seen: FaultSet,
    faults: Vec<(Fault, f64)>,
    samples: Vec<Sample>,
}

impl Stage {
    pub fn new(rig: &RigFile, plant: Plant, scenario: &Scenario) -> Self {
        let (seed, asked) = (scenario.seed, scenario.start().direction());
        let truth = plant.truth();
        let parameters = &rig.parameters;
        Self {
            extremes: Extremes::new(&truth),
            all: Extremes::new(&truth),
            driven_max_n: 0.0,
            plant,
            truth,
            telemetry: None,
            silent: false,
            pushing: None,
            bounds_n: [rig.f_min_n, rig.f_max_n],
            tip_length_m: parameters.joint_length_m + parameters.leg_length_m,
            rng: fastrand::Rng::with_seed(seed),
            asked: Some(asked),
            compensated: true,
            queue: VecDeque::new(),
            sequence: 0,
            tips_m: VecDeque::new(),
            ticks: 0,
            seen: FaultSet::NONE,
            faults: Vec::new(),
            samples: Vec::new(),
        }
    }

    pub fn time_s(&self) -> f64 {
        self.ticks as f64 * tick_s()
    }

    pub fn state(&self) -> State {
        self.telemetry
            .map_or(State::Boot, |telemetry| telemetry.state)
    }

    /// Sends a command.
    pub fn send(&mut self, command: &Command) -> Result<(), SimulationError> {
        if self.sequence == 0 {
            self.ask(&HostRequest::Identify(Hello {
                schema: HOST_SCHEMA,
            }))?;
        }
        self.ask(&HostRequest::Command {
            host: HOST,
            command: *command,
        })
    }

    fn ask(&mut self, request: &HostRequest) -> Result<(), SimulationError> {
        self.sequence = self.sequence.checked_add(1).unwrap_or(1);
        let mut out = [0; MAX_FRAME];
        let bytes =
            frame::encode(self.sequence, request, &mut out).map_err(SimulationError::Command)?;
        self.queue.extend(bytes);
        Ok(())
    }

    /// Sends bytes that mean nothing.
    pub fn send_garbage(&mut self, count: u32) {
        for _ in 0..count {
            self.queue.push_back(self.rng.u8(..));
        }
        // Ends whatever frame they may look like.
        self.queue.push_back(0);
    }

    /// The bytes of the next tick.
    pub fn outgoing(&mut self) -> Vec<u8> {
        if !self.silent && self.ticks.is_multiple_of(ALIVE_TICKS) && self.queue.is_empty() {
            // It is short enough for any frame.
            let _ = self.send(&Command::KeepAlive);
        }
        let count = self.queue.len().min(LINK_BYTES_MAX);
        self.queue.drain(..count).collect()
    }

    /// Lets the leg go on for a tick.
    ///
    /// # Errors
    /// [`SimulationError::NotFinite`] if a number is lost.
    pub fn step(
        &mut self,
        motors: &Drive<f32>,
        telemetry: &Telemetry<f32>,
    ) -> Result<(), SimulationError> {
        self.push();
        self.plant.step(motors);
        self.truth = self.plant.truth();
        let numbers = self.truth.tensions_n.iter().chain(self.truth.tip_m.iter());
        if !numbers.copied().all(f64::is_finite) {
            let time_s = self.time_s();
            return Err(SimulationError::NotFinite { time_s });
        }
        self.telemetry = Some(*telemetry);
        self.extremes.take(&self.truth, self.bounds_n);
        self.all.take(&self.truth, self.bounds_n);
        if motors.enabled && telemetry.state.follows() {
            let highest = self.truth.tensions_n.into_iter().fold(0.0, f64::max);
            self.driven_max_n = self.driven_max_n.max(highest);
        }
        self.tips_m.push_back(self.truth.tip_m);
        if self.tips_m.len() > AVERAGE_TICKS {
            self.tips_m.pop_front();
        }
        self.note_faults(telemetry.faults);
        if self.ticks.is_multiple_of(SAMPLE_TICKS) {
            self.samples.push(Sample {
                time_s: self.time_s(),
                tip_error_mm: (self.truth.tip_m - self.target_m()).norm() * 1000.0,
                tensions_n: self.truth.tensions_n,
                payload_kg: self.truth.payload_kg,
                telemetry: *telemetry,
            });
        }
        self.ticks += 1;
        Ok(())
    }

    fn push(&mut self) {
        let now_s = self.time_s();
        if let Some(pushing) = self.pushing {
            if now_s >= pushing.until_s {
                self.pushing = None;
                return;
            }
            let part = ((now_s - pushing.from_s) / pushing.ramp_s).min(1.0);
            // Up and down without a corner.
            let smooth = part * part * (3.0 - 2.0 * part);
            self.plant.push((pushing.force_n * smooth).into(), tick_s());
        }
    }

    fn note_faults(&mut self, faults: FaultSet) {
        for fault in faults.faults().filter(|fault| !self.seen.has(*fault)) {
            self.faults.push((fault, self.ticks as f64 * tick_s()));
        }
        self.seen = self.seen.with(faults);
    }

    /// Where the trajectory has the tip now, m.
    pub fn target_m(&self) -> Vector3<f64> {
        self.tip_towards(
            self.telemetry
                .map_or([0.0; 2], |telemetry| telemetry.target.map(f64::from)),
        )
    }

    /// Where the host has sent the tip, m: whatever the leg itself takes for its target.
    pub fn asked_m(&self) -> Vector3<f64> {
        self.asked
            .map_or_else(|| self.target_m(), |asked| self.tip_towards(asked))
    }

    fn tip_towards(&self, [x, y]: [f64; 2]) -> Vector3<f64> {
        let z = -(1.0 - x * x - y * y).max(0.0).sqrt();
        Vector3::new(x, y, z) * self.tip_length_m
    }

    /// Where the tip was on average, m.
    pub fn average_tip_m(&self) -> Vector3<f64> {
        let sum: Vector3<f64> = self.tips_m.iter().sum();
        sum / (self.tips_m.len().max(1) as f64)
    }

    pub fn summary(
        self,
        findings: Vec<Finding>,
        expected: FaultSet,
        divergence: Divergence,
        stopped: Option<String>,
    ) -> Summary {
        let unexpected = self.faults.iter().map(|(fault, _)| *fault);
        Summary {
            findings,
            stopped,
            unexpected: unexpected.filter(|fault| !expected.has(*fault)).collect(),
            ticks: self.ticks,
            tension_range_n: [self.all.tension_min_n, self.all.tension_max_n],
            driven_max_n: self.driven_max_n,
            divergence,
            faults: self.faults,
            samples: self.samples,
        }
    }
}
