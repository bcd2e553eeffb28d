//! Scenarios as a board can run them: it forgets its zero when it starts, so that a leg that starts homed is homed first.

use super::{CommandStep, Measurand, Scenario, Step, TestStep};
use crate::action::Action;
use crate::plant::{Defect, Start};
use leg_firmware::supervisor::State;

/// Slack of each tendon before homing, mm.
const SLACK_MM: f64 = 1.0;

/// Time in which the payload is brought on, and in which the leg rests where the scenario starts, s.
const LOADING_S: f64 = 0.5;
const REST_S: f64 = 2.0;

/// What homing leaves of error in the zero moves the tip by up to as much, mm: the bound of the ready scenario `homing`.
const HOMED_TIP_MM: f64 = 0.04;

/// Bytes that a board's serial line takes in a second: 921 600 baud, ten bits for a byte.
const LINE_BYTES_PER_S: f64 = 92_160.0;

/// How far a board's run of a ready scenario differs from that in process, and why: `docs/scenarios.md` has the same table.
pub const BOARD_EXCEPTIONS: &[(&str, &str, &str)] = &[
    (
        "every scenario that starts homed",
        "begins slack and is homed first; its payload comes on after that",
        "a board forgets its zero when it starts",
    ),
    (
        "every `tip_error_mm` after that",
        "may be 0.04 mm larger, and has no lower bound",
        "the bounds are for a zero without error, and homing leaves one of up to 0.01 mm",
    ),
    (
        "fault_bad_frame",
        "the next command waits until the line is free",
        "4 000 bytes take 43 ms at 921 600 baud",
    ),
    (
        "fault_settings_corrupt",
        "a bit of the settings in flash is wrong before the board starts",
        "a board reads its settings when it starts",
    ),
    (
        "fault_cell_stale",
        "TIM1's trigger does not reach ADC2: the codes of the currents stand still, and no code counts as fresh",
        "ADC1 and ADC2 run as a pair, and without ADC1 there is no tick",
    ),
    (
        "fault_late_tick",
        "the processor is held for more than the budget within each tick",
        "whether a tick is late is measured by the board, not read from a sensor",
    ),
    (
        "fault_following",
        "is not run",
        "its motors get too little voltage for homing, and other settings would end the zero",
    ),
    ("arm_lean", "is not run", LEANS_DISARMED),
];

/// Why a leg that is armed where it leans is not run.
const LEANS_DISARMED: &str = "a leg with a zero is led straight down before it is disarmed: it is not disarmed where it leans";

/// The key of a scenario's `[control.servo]` without which a board cannot home its leg.
const DUTY_MAX: &str = "duty_max";

impl Scenario {
    /// The same as a board can run it, with a note of what is different: see [`BOARD_EXCEPTIONS`].
    ///
    /// # Errors
    /// Why a board cannot run it.
    pub fn board_variant(&self) -> Result<Self, &'static str> {
        let mut scenario = self.clone();
        if needs_zero(&scenario) {
            if scenario
                .control
                .iter()
                .any(|change| change.name() == DUTY_MAX)
            {
                return Err(
                    "its motors get too little voltage for homing, and other settings would end the zero",
                );
            }
            let note =
                "a board forgets its zero when it starts: the leg begins slack, and is homed first";
            scenario.notes.push(note.into());
            let arming = [
                await_state(State::Disarmed, 1.0),
                Step::Command(CommandStep::Arm),
            ];
            let mut steps = preparation(scenario.start);
            match scenario.steps.strip_prefix(&arming) {
                Some(rest) => steps.extend(rest.iter().cloned().map(with_homed_bounds)),
                None if leans(scenario.start) => return Err(LEANS_DISARMED),
                None => {
                    steps.push(Step::Command(CommandStep::Disarm));
                    steps.push(await_state(State::Disarmed, 10.0));
                    steps.extend(scenario.steps.into_iter().map(with_homed_bounds));
                }
            }
            scenario.steps = steps;
            scenario.start = Start::Slack { slack_mm: SLACK_MM };
        }
        scenario.steps = with_a_free_line(scenario.steps);
        Ok(scenario)
    }
}

/// Whether it starts with a zero, and uses that: it does not where its first command is to home, nor where a leg without
/// settings is never driven.
fn needs_zero(scenario: &Scenario) -> bool {
    let first = scenario.steps.iter().find_map(|step| match step {
        Step::Command(command) => Some(*command != CommandStep::Home),
        Step::Action(Action::Fault(Defect::SettingsCorrupt)) => Some(false),
        _ => None,
    });
    !scenario.start.is_slack() && first.unwrap_or(false)
}

fn leans(start: Start) -> bool {
    matches!(start, Start::Held { tilt_deg, .. } if tilt_deg > 0.0)
}

/// From slack tendons to where a scenario starts.
fn preparation(start: Start) -> Vec<Step> {
    let mut steps = vec![
        await_state(State::Disarmed, 1.0),
        Step::Command(CommandStep::Home),
        await_state(State::Active, 30.0),
    ];
    if let Start::Held {
        azimuth_deg,
        tilt_deg,
        pretension_n,
        payload_kg,
    } = start
    {
        if payload_kg > 0.0 {
            steps.push(Step::Action(Action::Payload {
                kg: payload_kg,
                over_s: LOADING_S,
            }));
            steps.push(Step::Test(TestStep::WaitS(LOADING_S)));
        }
        steps.extend([
            Step::Command(CommandStep::PretensionN(pretension_n)),
            Step::Command(CommandStep::Move {
                azimuth_deg,
                tilt_deg,
            }),
            Step::Test(TestStep::Arrive {
                then_s: REST_S,
                timeout_s: 5.0,
            }),
            // What homing did is not the scenario's.
            Step::Test(TestStep::Mark),
        ]);
    }
    steps
}

fn await_state(state: State, timeout_s: f64) -> Step {
    Step::Test(TestStep::Await { state, timeout_s })
}

fn with_homed_bounds(mut step: Step) -> Step {
    if let Step::Test(TestStep::Measure {
        quantity: Measurand::TipErrorMm,
        between,
        ..
    }) = &mut step
    {
        *between = [0.0, between[1] + HOMED_TIP_MM];
    }
    step
}

/// Before a command, a wait until what was sent as garbage is over.
fn with_a_free_line(steps: Vec<Step>) -> Vec<Step> {
    let mut waits_s = None;
    let mut waiting = Vec::new();
    for step in steps {
        match &step {
            Step::Test(TestStep::Garbage(bytes)) => {
                waits_s = Some(f64::from(*bytes) / LINE_BYTES_PER_S);
            }
            Step::Command(_) => waiting.extend(waits_s.take().map(TestStep::WaitS).map(Step::Test)),
            _ => {}
        }
        waiting.push(step);
    }
    waiting
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "a test may panic")]
mod tests {
    use super::{BOARD_EXCEPTIONS, Start, needs_zero};
    use crate::ready_scenarios::{READY_SCENARIOS, named};
    use crate::scenario::Scenario;

    #[test]
    fn every_scenario_of_a_board_starts_without_a_zero_or_does_not_use_it() {
        for ready in READY_SCENARIOS {
            let scenario = Scenario::parse(ready.name, ready.text).expect("it is ready");
            let on_board = scenario.board_variant();
            let not_run = ["fault_following", "arm_lean"].contains(&ready.name);
            assert_eq!(on_board.is_err(), not_run, "{}", ready.name);
            let Ok(scenario) = on_board else { continue };
            assert!(!needs_zero(&scenario), "{}", ready.name);
            if let Start::Held { tilt_deg, .. } = scenario.start {
                assert_eq!(tilt_deg, 0.0, "{}", ready.name);
            }
        }
    }

    #[test]
    fn exceptions_name_scenarios_that_there_are() {
        for (scenarios, _, _) in BOARD_EXCEPTIONS {
            if scenarios.starts_with("every") {
                continue;
            }
            for name in scenarios.split(", ") {
                assert!(named(name).is_some(), "{name}");
            }
        }
    }
}
