//! What is seen of a leg in a scenario.

use super::extremes::Extremes;
use super::shadow::Divergence;
use super::summary::{Measurement, Sample, Summary};
use crate::plant::Truth;
use leg_firmware::command::{Command, Compensation};
use leg_firmware::supervisor::{Fault, FaultSet, State};
use leg_firmware::telemetry::Telemetry;
use leg_firmware_bench::protocol::TickReply;
use leg_rig::rig_file::RigFile;
use nalgebra::Vector3;
use std::collections::VecDeque;

/// Ticks over which the tip is averaged: a quarter of a second, about a swing of the loaded leg.
const AVERAGE_TICKS: usize = 2000;

/// Ticks between two samples.
const SAMPLE_TICKS: u64 = 16;

/// What is seen of a leg.
#[derive(Debug)]
pub(super) struct Observer {
    /// Ticks since the start.
    pub ticks: u64,
    pub truth: Truth,
    pub telemetry: Option<Telemetry<f32>>,
    /// Since the last mark.
    pub extremes: Extremes,
    /// Whether the leg compensates its load.
    pub compensated: bool,
    /// Where the host has sent the leg, as horizontal components; none after a hold.
    commanded: Option<[f64; 2]>,
    bounds_n: [f64; 2],
    tip_length_m: f64,
    /// Since the start.
    all: Extremes,
    driven_max_n: f64,
    tips_m: VecDeque<Vector3<f64>>,
    seen: FaultSet,
    faults: Vec<(Fault, f64)>,
    samples: Vec<Sample>,
}

impl Observer {
    /// At the start, when the leg has a direction.
    pub fn new(rig: &RigFile, truth: Truth, direction: [f64; 2]) -> Self {
        let parameters = &rig.parameters;
        Self {
            ticks: 0,
            extremes: Extremes::new(&truth),
            all: Extremes::new(&truth),
            driven_max_n: 0.0,
            truth,
            telemetry: None,
            bounds_n: [rig.f_min_n, rig.f_max_n],
            tip_length_m: parameters.joint_length_m + parameters.leg_length_m,
            commanded: Some(direction),
            compensated: true,
            tips_m: VecDeque::new(),
            seen: FaultSet::NONE,
            faults: Vec::new(),
            samples: Vec::new(),
        }
    }

    pub fn state(&self) -> State {
        self.telemetry
            .map_or(State::Boot, |telemetry| telemetry.state)
    }

    /// Notes where a command sends the leg.
    pub fn note_command(&mut self, command: &Command) {
        match *command {
            Command::Move { x, y } => self.commanded = Some([x, y].map(f64::from)),
            Command::Home => self.commanded = Some([0.0; 2]),
            Command::Hold | Command::Stop => self.commanded = None,
            Command::Compensation(compensation) => {
                self.compensated = compensation != Compensation::Off;
            }
            _ => {}
        }
    }

    /// Takes a tick that began at a time, and where it has brought the leg.
    pub fn take(&mut self, time_s: f64, truth: Truth, reply: &TickReply) {
        let telemetry = &reply.telemetry;
        self.truth = truth;
        self.telemetry = Some(*telemetry);
        self.extremes.take(&truth, self.bounds_n);
        self.all.take(&truth, self.bounds_n);
        if reply.motors.enabled && telemetry.state.follows() {
            let highest = truth.tensions_n.into_iter().fold(0.0, f64::max);
            self.driven_max_n = self.driven_max_n.max(highest);
        }
        self.tips_m.push_back(truth.tip_m);
        if self.tips_m.len() > AVERAGE_TICKS {
            self.tips_m.pop_front();
        }
        for fault in telemetry.faults.faults() {
            if !self.seen.has(fault) {
                self.faults.push((fault, time_s));
            }
        }
        self.seen = self.seen.union(telemetry.faults);
        if self.ticks.is_multiple_of(SAMPLE_TICKS) {
            self.samples.push(Sample {
                time_s,
                tip_error_mm: (truth.tip_m - self.target_m()).norm() * 1000.0,
                tensions_n: truth.tensions_n,
                payload_kg: truth.payload_kg,
                telemetry: *telemetry,
            });
        }
        self.ticks += 1;
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

    pub fn summary(
        self,
        measurements: Vec<Measurement>,
        expected: FaultSet,
        divergence: Divergence,
        stopped: Option<String>,
    ) -> Summary {
        let faults = self.faults.iter().map(|(fault, _)| *fault);
        Summary {
            measurements,
            stopped,
            unexpected: faults.filter(|fault| !expected.has(*fault)).collect(),
            ticks: self.ticks,
            tension_range_n: [self.all.tension_min_n, self.all.tension_max_n],
            driven_max_n: self.driven_max_n,
            divergence,
            faults: self.faults,
            samples: self.samples,
        }
    }
}
