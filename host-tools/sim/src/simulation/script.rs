//! Carries out the steps of a scenario.

use super::extremes::Extremes;
use super::outcome::{Finding, SimulationError};
use super::stage::{Pushing, Stage};
use crate::scenario::{Quantity, Scenario, Step};
use leg_base::words;
use leg_firmware::command::{Command, Compensation};
use leg_firmware::supervisor::FaultSet;
use nalgebra::Vector3;

/// Time in which a push of a test comes up, s.
const RAMP_S: f64 = 0.5;

/// The steps and how far they are done.
#[derive(Debug)]
pub(super) struct Script<'a> {
    steps: &'a [Step],
    next: usize,
    /// When the present step began, and the last one that did something, s.
    began_s: f64,
    acted_s: f64,
    /// Tip before a push, m.
    before_m: Option<Vector3<f64>>,
    /// Since when the leg has arrived, s.
    arrived_s: Option<f64>,
    findings: Vec<Finding>,
    expected: FaultSet,
}

impl<'a> Script<'a> {
    pub fn new(scenario: &'a Scenario) -> Self {
        let mut expected = FaultSet::NONE;
        for fault in &scenario.expected {
            expected.add(*fault, true);
        }
        Self {
            steps: &scenario.steps,
            expected,
            next: 0,
            began_s: 0.0,
            acted_s: 0.0,
            before_m: None,
            arrived_s: None,
            findings: Vec::new(),
        }
    }

    /// What was found, and the faults that had to come.
    pub fn findings(self) -> (Vec<Finding>, FaultSet) {
        (self.findings, self.expected)
    }

    /// Goes on as far as it can; the number of the step that takes time, or none at the end.
    pub fn advance(&mut self, stage: &mut Stage) -> Result<Option<usize>, SimulationError> {
        while let Some(step) = self.steps.get(self.next) {
            if !self.carry_out(step, stage)? {
                return Ok(Some(self.next + 1));
            }
            self.next += 1;
            self.began_s = stage.time_s();
            self.arrived_s = None;
        }
        Ok(None)
    }

    /// Whether a step is done.
    fn carry_out(&mut self, step: &Step, stage: &mut Stage) -> Result<bool, SimulationError> {
        let waited_s = stage.time_s() - self.began_s;
        match step {
            Step::WaitS(time_s) => Ok(waited_s >= *time_s),
            Step::Await { state, timeout_s } => {
                let there = stage.state() == *state;
                self.in_time(there, words::state(*state), *timeout_s, stage)
            }
            Step::Arrive { then_s, timeout_s } => self.arrive(*then_s, *timeout_s, stage),
            Step::Reaction {
                fault,
                state,
                within_ms,
            } => {
                self.expected.add(*fault, true);
                let seen = stage
                    .telemetry
                    .is_some_and(|telemetry| telemetry.faults.has(*fault));
                let there = seen && stage.state() == *state;
                let name = fault.entry().name;
                if there {
                    let value = (stage.time_s() - self.acted_s) * 1000.0;
                    self.find(
                        &format!("{name}: {}", words::state(*state)),
                        (value, "ms"),
                        [0.0, *within_ms],
                        None,
                        stage,
                    );
                }
                self.in_time(there, name, 10.0 + within_ms / 1000.0, stage)
            }
            Step::Measure {
                name,
                quantity,
                between,
            } => {
                self.find(
                    name,
                    (measure(*quantity, stage), quantity.unit()),
                    *between,
                    Some(*quantity),
                    stage,
                );
                Ok(true)
            }
            Step::PushTest {
                name,
                azimuth_deg,
                force_n,
                settle_s,
                nm_per_rad,
                within_percent,
            } => {
                let asked = [*nm_per_rad, *within_percent];
                Ok(self.push_test(name, [*azimuth_deg, *force_n], *settle_s, asked, stage))
            }
            _ => {
                self.acted_s = stage.time_s();
                act(step, stage)?;
                Ok(true)
            }
        }
    }

    fn in_time(
        &self,
        there: bool,
        what: &str,
        timeout_s: f64,
        stage: &Stage,
    ) -> Result<bool, SimulationError> {
        if !there && stage.time_s() - self.began_s > timeout_s {
            return Err(SimulationError::Timeout {
                step: self.next + 1,
                what: what.into(),
                timeout_s,
                state: describe(stage),
            });
        }
        Ok(there)
    }

    fn arrive(
        &mut self,
        then_s: f64,
        timeout_s: f64,
        stage: &Stage,
    ) -> Result<bool, SimulationError> {
        // The command itself takes a few ticks to get there.
        let started = stage.time_s() - self.began_s > 0.02;
        let still = stage.telemetry.is_some_and(|telemetry| !telemetry.moving);
        if started && still && self.arrived_s.is_none() {
            self.arrived_s = Some(stage.time_s());
        }
        let done = self
            .arrived_s
            .is_some_and(|at_s| stage.time_s() - at_s >= then_s);
        self.in_time(done, "the end of the move", timeout_s + then_s, stage)
    }

    /// Pushes across the leg and compares the moment with the angle.
    fn push_test(
        &mut self,
        name: &str,
        [azimuth_deg, force_n]: [f64; 2],
        settle_s: f64,
        [asked, within_percent]: [f64; 2],
        stage: &mut Stage,
    ) -> bool {
        let now_s = stage.time_s();
        let Some(before_m) = self.before_m else {
            self.before_m = Some(stage.average_tip_m());
            stage.pushing = Some(Pushing {
                force_n: across(azimuth_deg, stage) * force_n,
                from_s: now_s,
                until_s: now_s + settle_s,
                ramp_s: RAMP_S,
            });
            return false;
        };
        if now_s - self.began_s < settle_s {
            return false;
        }
        let length_m = before_m.norm();
        let moved_m = (stage.average_tip_m() - before_m).dot(&across(azimuth_deg, stage));
        let stiffness = force_n * length_m / (moved_m / length_m);
        let off = asked * within_percent / 100.0;
        self.find(
            name,
            (stiffness, "N·m/rad"),
            [asked - off, asked + off],
            None,
            stage,
        );
        self.before_m = None;
        stage.pushing = None;
        true
    }

    fn find(
        &mut self,
        name: &str,
        (value, unit): (f64, &'static str),
        between: [f64; 2],
        quantity: Option<Quantity>,
        stage: &Stage,
    ) {
        let at_s = stage.time_s();
        self.findings.push(Finding {
            name: name.into(),
            value,
            unit,
            between,
            at_s,
            quantity,
            compensated: stage.compensated,
        });
    }
}

/// The direction across the leg that is nearest to a horizontal one.
fn across(azimuth_deg: f64, stage: &Stage) -> Vector3<f64> {
    let (sin, cos) = azimuth_deg.to_radians().sin_cos();
    let (horizontal, leg) = (Vector3::new(cos, sin, 0.0), stage.truth.tip_m.normalize());
    (horizontal - leg * leg.dot(&horizontal)).normalize()
}

fn describe(stage: &Stage) -> String {
    let state = words::state(stage.state());
    match stage.telemetry {
        Some(telemetry) if telemetry.faults.any() => {
            format!("{state} ({})", words::faults(telemetry.faults))
        }
        _ => state.into(),
    }
}

fn act(step: &Step, stage: &mut Stage) -> Result<(), SimulationError> {
    match step {
        Step::Payload { kg, over_s } => stage.plant.set_payload(*kg, *over_s),
        Step::Push {
            azimuth_deg,
            force_n,
            for_s,
        } => {
            let now_s = stage.time_s();
            stage.pushing = Some(Pushing {
                force_n: across(*azimuth_deg, stage) * *force_n,
                from_s: now_s,
                until_s: now_s + for_s,
                ramp_s: 0.02,
            });
        }
        Step::Fault(fault) => stage.plant.set_fault(*fault, true),
        Step::Repair(fault) => stage.plant.set_fault(*fault, false),
        Step::EmergencyStop(pressed) => stage.plant.press_emergency_stop(*pressed),
        Step::Garbage(count) => stage.send_garbage(*count),
        Step::Silence(silent) => stage.silent = *silent,
        Step::Mark => stage.extremes = Extremes::new(&stage.truth),
        _ => {
            if let Some(command) = command(step) {
                match command {
                    Command::Move { x, y } => stage.asked = Some([x, y].map(f64::from)),
                    Command::Home => stage.asked = Some([0.0; 2]),
                    Command::Hold | Command::Stop => stage.asked = None,
                    Command::Compensation(compensation) => {
                        stage.compensated = compensation != Compensation::Off;
                    }
                    _ => {}
                }
                stage.send(&command)?;
            }
        }
    }
    Ok(())
}

/// The command that a step sends.
fn command(step: &Step) -> Option<Command> {
    Some(match *step {
        Step::Arm => Command::Arm,
        Step::Home => Command::Home,
        Step::Hold => Command::Hold,
        Step::Stop => Command::Stop,
        Step::Disarm => Command::Disarm,
        Step::Clear => Command::Clear,
        Step::Move {
            azimuth_deg,
            tilt_deg,
        } => {
            let (sin, cos) = azimuth_deg.to_radians().sin_cos();
            let sine = tilt_deg.to_radians().sin();
            Command::Move {
                x: (sine * cos) as f32,
                y: (sine * sin) as f32,
            }
        }
        Step::PretensionN(pretension_n) => Command::Pretension(pretension_n as f32),
        Step::Stiffness {
            nm_per_rad,
            towards_deg,
        } => Command::Stiffness {
            demand_nm_per_rad: nm_per_rad as f32,
            towards: towards_deg.map(|azimuth_deg| {
                let (sin, cos) = azimuth_deg.to_radians().sin_cos();
                [cos as f32, sin as f32]
            }),
        },
        Step::Compensation(compensation) => Command::Compensation(compensation),
        _ => return None,
    })
}

fn measure(quantity: Quantity, stage: &Stage) -> f64 {
    let told = |of: fn(&leg_firmware::telemetry::Telemetry<f32>) -> f32| {
        stage
            .telemetry
            .as_ref()
            .map_or(f64::NAN, |telemetry| f64::from(of(telemetry)))
    };
    match quantity {
        Quantity::TipErrorMm => (stage.average_tip_m() - stage.asked_m()).norm() * 1000.0,
        Quantity::TipMovedMm => stage.extremes.tip_moved_mm,
        Quantity::TensionMinN => stage.extremes.tension_min_n,
        Quantity::TensionMaxN => stage.extremes.tension_max_n,
        Quantity::OutsideMs => stage.extremes.outside_ms,
        Quantity::PayloadKg => told(|telemetry| telemetry.payload_kg),
        Quantity::PretensionN => told(|telemetry| telemetry.pretension_n),
        Quantity::StiffnessNmPerRad => told(|telemetry| telemetry.stiffness_nm_per_rad),
        Quantity::HomingErrorMm => homing_error_mm(stage),
    }
}

fn homing_error_mm(stage: &Stage) -> f64 {
    let found = stage
        .telemetry
        .map_or([f32::NAN; 3], |telemetry| telemetry.unstretched_at_zero_m);
    let real = stage.plant.unstretched_at_zero_m();
    let errors = found
        .iter()
        .zip(real)
        .map(|(found, real)| (f64::from(*found) - real).abs() * 1000.0);
    errors.fold(0.0, f64::max)
}
