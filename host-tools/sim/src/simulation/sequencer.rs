//! Carries out the steps of a scenario.

use super::extremes::Extremes;
use super::follower::Follower;
use super::measure::measure;
use super::summary::SimulationError;
use super::test_stand::{COMMAND_S, TestStand};
use crate::scenario::{PushTest, Scenario, Step, TestStep};
use leg_base::description;
use leg_base::timed_path::TimedPath;
use leg_firmware::supervisor::{FaultSet, State};
use nalgebra::Vector3;

/// Time in which the force of a push test rises, s: slow enough that the leg does not swing.
const PUSH_TEST_RISE_S: f64 = 0.5;

/// Longest time that a path takes, with the way to its start and to rest, s.
const FOLLOW_TIMEOUT_S: f64 = 400.0;

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
    /// Tip before a push, m, and when that began, s.
    before_push: Option<(Vector3<f64>, f64)>,
    /// Since when the leg has arrived, s.
    arrived_s: Option<f64>,
    /// The path that is being streamed.
    follower: Option<Follower>,
    /// Faults that may come.
    pub expected: FaultSet,
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
            before_push: None,
            arrived_s: None,
            follower: None,
        }
    }

    /// Does all steps that are due; the number of the step that takes time, or none at the end.
    pub fn advance(&mut self, stand: &mut TestStand<'_>) -> Result<Option<usize>, SimulationError> {
        while let Some(step) = self.steps.get(self.next) {
            if !self.carry_out(step, stand)? {
                return Ok(Some(self.next + 1));
            }
            self.next += 1;
            self.began_s = stand.leg.time_s();
            self.arrived_s = None;
        }
        // What becomes of a command in the last step is seen. The leg ticks once in any case: without that there is nothing to report.
        let goes_on = stand.summary.ticks == 0 || stand.awaits_answer();
        Ok(goes_on.then_some(self.steps.len()))
    }

    /// Whether a step is done.
    fn carry_out(
        &mut self,
        step: &Step,
        stand: &mut TestStand<'_>,
    ) -> Result<bool, SimulationError> {
        match step {
            Step::Action(action) => action.apply(stand.leg.leg_mut().plant_mut()),
            Step::Command(command) => stand.command(command)?,
            Step::Test(TestStep::Garbage(count)) => stand.leg.host_mut().send_garbage(*count),
            Step::Test(TestStep::Silence(silent)) => stand.leg.host_mut().silent = *silent,
            Step::Test(TestStep::Mark) => stand.extremes = Extremes::new(stand.leg.truth()),
            Step::Test(step) => return self.test(step, stand),
        }
        self.acted_s = stand.leg.time_s();
        Ok(true)
    }

    /// Whether a step that waits or measures is done.
    fn test(
        &mut self,
        step: &TestStep,
        stand: &mut TestStand<'_>,
    ) -> Result<bool, SimulationError> {
        Ok(match step {
            // These act when they begin and wait for nothing.
            TestStep::Garbage(_) | TestStep::Silence(_) | TestStep::Mark => true,
            TestStep::WaitS(time_s) => stand.leg.time_s() - self.began_s >= *time_s,
            TestStep::Await { state, timeout_s } => {
                let there = stand.leg.state() == *state;
                self.check_timeout(there, description::state(*state), *timeout_s, stand)?
            }
            TestStep::Follow(step) => self.follow(|| step.rows.clone(), step.ends, stand)?,
            TestStep::Circle(step) => self.follow(|| step.path(), true, stand)?,
            TestStep::Arrive { then_s, timeout_s } => self.arrive(*then_s, *timeout_s, stand)?,
            TestStep::Reaction {
                fault,
                state,
                within_ms,
            } => {
                self.expected.add(*fault, true);
                let telemetry = stand.leg.telemetry();
                let seen = telemetry.is_some_and(|telemetry| telemetry.faults.has(*fault));
                self.reaction(seen, fault.entry().name, *state, *within_ms, stand)?
            }
            TestStep::Measure {
                name,
                quantity,
                between,
            } => {
                let value = (measure(*quantity, stand), quantity.unit());
                stand.record(name, value, *between, Some(*quantity));
                true
            }
            TestStep::PushTest(push) => self.push_test(push, stand),
        })
    }

    /// Whether a path has been followed to its end, and the leg rests.
    fn follow(
        &mut self,
        path: impl FnOnce() -> TimedPath,
        ends: bool,
        stand: &mut TestStand<'_>,
    ) -> Result<bool, SimulationError> {
        let mut follower = match self.follower.take() {
            Some(follower) => follower,
            None => Follower::new(path(), ends, stand)?,
        };
        let done = follower.advance(stand)?;
        if done {
            // Whatever follows from it counts from its end.
            self.acted_s = stand.leg.time_s();
        } else {
            self.follower = Some(follower);
        }
        self.check_timeout(done, "the end of the path", FOLLOW_TIMEOUT_S, stand)
    }

    fn check_timeout(
        &self,
        there: bool,
        what: &str,
        timeout_s: f64,
        stand: &TestStand<'_>,
    ) -> Result<bool, SimulationError> {
        if !there && stand.leg.time_s() - self.began_s > timeout_s {
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
        let now_s = stand.leg.time_s();
        let started = now_s - self.began_s > COMMAND_S;
        let telemetry = stand.leg.telemetry();
        let still = telemetry.is_some_and(|telemetry| !telemetry.moving);
        if started && still {
            self.arrived_s.get_or_insert(now_s);
        }
        let done = self.arrived_s.is_some_and(|at_s| now_s - at_s >= then_s);
        self.check_timeout(done, "the end of the move", timeout_s + then_s, stand)
    }

    /// Measures the time to a fault, once it is seen, and to the state that it leads to.
    fn reaction(
        &mut self,
        seen: bool,
        name: &str,
        state: State,
        within_ms: f64,
        stand: &mut TestStand<'_>,
    ) -> Result<bool, SimulationError> {
        let there = seen && stand.leg.state() == state;
        if there {
            let value_ms = (stand.leg.time_s() - self.acted_s) * 1000.0;
            let name = format!("{name}: {}", description::state(state));
            stand.record(&name, (value_ms, "ms"), [0.0, within_ms], None);
        }
        let timeout_s = REACTION_TIMEOUT_S + within_ms / 1000.0;
        self.check_timeout(there, name, timeout_s, stand)
    }

    /// Pushes across the leg and compares the moment with the angle.
    fn push_test(&mut self, push: &PushTest, stand: &mut TestStand<'_>) -> bool {
        let across = stand.leg.leg().plant().transverse(push.azimuth_deg);
        let Some((before_m, began_s)) = self.before_push else {
            let Some(tip_m) = stand.average_tip_m() else {
                return false;
            };
            self.before_push = Some((tip_m, stand.leg.time_s()));
            let force_n = across * push.force_n;
            let plant = stand.leg.leg_mut().plant_mut();
            plant.push(force_n, push.settle_s, PUSH_TEST_RISE_S);
            return false;
        };
        let Some(after_m) = stand
            .average_tip_m()
            .filter(|_| stand.leg.time_s() - began_s >= push.settle_s)
        else {
            return false;
        };
        let length_m = before_m.norm();
        let moved_m = (after_m - before_m).dot(&across);
        let stiffness = push.force_n * length_m / (moved_m / length_m);
        let off = push.nm_per_rad * push.within_percent / 100.0;
        let between = [push.nm_per_rad - off, push.nm_per_rad + off];
        stand.record(&push.name, (stiffness, "N·m/rad"), between, None);
        self.before_push = None;
        stand
            .leg
            .leg_mut()
            .plant_mut()
            .push(Vector3::zeros(), 0.0, 0.0);
        true
    }
}

/// The state of the leg and its faults as text.
fn describe(stand: &TestStand<'_>) -> String {
    let state = description::state(stand.leg.state());
    match stand.leg.telemetry() {
        Some(telemetry) if telemetry.faults.any() => {
            format!("{state} ({})", description::faults(telemetry.faults))
        }
        _ => state.into(),
    }
}
