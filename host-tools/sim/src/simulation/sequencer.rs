//! Carries out the steps of a scenario.

use super::extremes::Extremes;
use super::measure::measure;
use super::summary::{Measurement, SimulationError};
use super::test_stand::TestStand;
use crate::scenario::{Measurand, PushTest, Scenario, Step, TestStep};
use leg_base::description;
use leg_firmware::supervisor::{FaultSet, State};
use nalgebra::Vector3;

/// Time in which the force of a push test rises, s: slow enough that the leg does not swing.
const PUSH_TEST_RISE_S: f64 = 0.5;

/// Time that a command takes to reach the leg, s, at most.
const COMMAND_S: f64 = 0.02;

/// Longest time to a fault beyond that in which it has to be there, s: so a late one still has its time measured.
const REACTION_TIMEOUT_S: f64 = 10.0;

/// The steps and how far they are done.
#[derive(Debug)]
pub(super) struct Sequencer<'a> {
    steps: &'a [Step],
    next: usize,
    /// When the present step began, and the last one that did something, s.
    began_s: f64,
    acted_s: f64,
    /// Tip before a push, m.
    before_m: Option<Vector3<f64>>,
    /// Since when the leg has arrived, s.
    arrived_s: Option<f64>,
    measurements: Vec<Measurement>,
    expected: FaultSet,
}

impl<'a> Sequencer<'a> {
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
            measurements: Vec::new(),
        }
    }

    /// What was measured, and the faults that are expected.
    pub fn finish(self) -> (Vec<Measurement>, FaultSet) {
        (self.measurements, self.expected)
    }

    /// Does all steps that are due; the number of the step that takes time, or none at the end.
    pub fn advance(&mut self, stand: &mut TestStand<'_>) -> Result<Option<usize>, SimulationError> {
        while let Some(step) = self.steps.get(self.next) {
            if !self.carry_out(step, stand)? {
                return Ok(Some(self.next + 1));
            }
            self.next += 1;
            self.began_s = stand.time_s();
            self.arrived_s = None;
        }
        Ok(None)
    }

    /// Whether a step is done.
    fn carry_out(
        &mut self,
        step: &Step,
        stand: &mut TestStand<'_>,
    ) -> Result<bool, SimulationError> {
        if let Step::Test(step) = step
            && let Some(done) = self.test(step, stand)?
        {
            return Ok(done);
        }
        self.acted_s = stand.time_s();
        match step {
            Step::Action(action) => action.apply(stand.plant_mut()),
            Step::Command(command) => stand.command(command)?,
            Step::Test(TestStep::Garbage(count)) => stand.host.send_garbage(*count),
            Step::Test(TestStep::Silence(silent)) => stand.host.silent = *silent,
            Step::Test(_) => stand.seen.extremes = Extremes::new(&stand.seen.truth),
        }
        Ok(true)
    }

    /// Whether a step that waits or measures is done; none for one that acts.
    fn test(
        &mut self,
        step: &TestStep,
        stand: &mut TestStand<'_>,
    ) -> Result<Option<bool>, SimulationError> {
        let done = match step {
            TestStep::Garbage(_) | TestStep::Silence(_) | TestStep::Mark => return Ok(None),
            TestStep::WaitS(time_s) => stand.time_s() - self.began_s >= *time_s,
            TestStep::Await { state, timeout_s } => {
                let there = stand.seen.state() == *state;
                self.in_time(there, description::state(*state), *timeout_s, stand)?
            }
            TestStep::Arrive { then_s, timeout_s } => self.arrive(*then_s, *timeout_s, stand)?,
            TestStep::Reaction {
                fault,
                state,
                within_ms,
            } => {
                self.expected.add(*fault, true);
                let telemetry = stand.seen.telemetry;
                let seen = telemetry.is_some_and(|telemetry| telemetry.faults.has(*fault));
                self.reaction(seen, fault.entry().name, *state, *within_ms, stand)?
            }
            TestStep::Measure {
                name,
                quantity,
                between,
            } => {
                let value = (measure(*quantity, stand), quantity.unit());
                self.record(name, value, *between, Some(*quantity), stand);
                true
            }
            TestStep::PushTest(push) => self.push_test(push, stand),
        };
        Ok(Some(done))
    }

    fn in_time(
        &self,
        there: bool,
        what: &str,
        timeout_s: f64,
        stand: &TestStand<'_>,
    ) -> Result<bool, SimulationError> {
        if !there && stand.time_s() - self.began_s > timeout_s {
            return Err(SimulationError::Timeout {
                step: self.next + 1,
                what: what.into(),
                timeout_s,
                state: describe(stand),
            });
        }
        Ok(there)
    }

    fn arrive(
        &mut self,
        then_s: f64,
        timeout_s: f64,
        stand: &TestStand<'_>,
    ) -> Result<bool, SimulationError> {
        let now_s = stand.time_s();
        let started = now_s - self.began_s > COMMAND_S;
        let telemetry = stand.seen.telemetry;
        let still = telemetry.is_some_and(|telemetry| !telemetry.moving);
        if started && still {
            self.arrived_s.get_or_insert(now_s);
        }
        let done = self.arrived_s.is_some_and(|at_s| now_s - at_s >= then_s);
        self.in_time(done, "the end of the move", timeout_s + then_s, stand)
    }

    /// Measures the time to a fault, once it is seen, and to the state that it leads to.
    fn reaction(
        &mut self,
        seen: bool,
        name: &str,
        state: State,
        within_ms: f64,
        stand: &TestStand<'_>,
    ) -> Result<bool, SimulationError> {
        let there = seen && stand.seen.state() == state;
        if there {
            let value_ms = (stand.time_s() - self.acted_s) * 1000.0;
            let name = format!("{name}: {}", description::state(state));
            self.record(&name, (value_ms, "ms"), [0.0, within_ms], None, stand);
        }
        let timeout_s = REACTION_TIMEOUT_S + within_ms / 1000.0;
        self.in_time(there, name, timeout_s, stand)
    }

    /// Pushes across the leg and compares the moment with the angle.
    fn push_test(&mut self, push: &PushTest, stand: &mut TestStand<'_>) -> bool {
        let across = stand.plant().across(push.azimuth_deg);
        let Some(before_m) = self.before_m else {
            self.before_m = Some(stand.seen.average_tip_m());
            let force_n = across * push.force_n;
            let plant = stand.plant_mut();
            plant.push(force_n, push.settle_s, PUSH_TEST_RISE_S);
            return false;
        };
        if stand.time_s() - self.began_s < push.settle_s {
            return false;
        }
        let length_m = before_m.norm();
        let moved_m = (stand.seen.average_tip_m() - before_m).dot(&across);
        let stiffness = push.force_n * length_m / (moved_m / length_m);
        let off = push.nm_per_rad * push.within_percent / 100.0;
        let between = [push.nm_per_rad - off, push.nm_per_rad + off];
        self.record(&push.name, (stiffness, "N·m/rad"), between, None, stand);
        self.before_m = None;
        stand.plant_mut().push(Vector3::zeros(), 0.0, 0.0);
        true
    }

    fn record(
        &mut self,
        name: &str,
        (value, unit): (f64, &'static str),
        between: [f64; 2],
        quantity: Option<Measurand>,
        stand: &TestStand<'_>,
    ) {
        self.measurements.push(Measurement {
            name: name.into(),
            value,
            unit,
            between,
            at_s: stand.time_s(),
            quantity,
            compensated: stand.seen.compensated,
        });
    }
}

/// The state of the leg and its faults as text.
fn describe(stand: &TestStand<'_>) -> String {
    let state = description::state(stand.seen.state());
    match stand.seen.telemetry {
        Some(telemetry) if telemetry.faults.any() => {
            format!("{state} ({})", description::faults(telemetry.faults))
        }
        _ => state.into(),
    }
}
