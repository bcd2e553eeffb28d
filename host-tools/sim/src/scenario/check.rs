//! Refuses numbers that no leg can meet, by the step and the name.

use super::{Scenario, StartText, Step};

/// Longest time of a step, s.
const LONGEST_S: f64 = 600.0;

/// A value that is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refused {
    /// There is nothing to do.
    #[error("there is no step")]
    Empty,
    /// A number of a step; steps count from 1.
    #[error("step {step}: {name} = {value} is not from {low} to {high}")]
    Step {
        /// The step.
        step: usize,
        /// The key.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The least that is taken.
        low: f64,
        /// The most.
        high: f64,
    },
    /// A number of a section.
    #[error("{section}: {name} = {value} is not from {low} to {high}")]
    Section {
        /// The section.
        section: &'static str,
        /// The key.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The least that is taken.
        low: f64,
        /// The most.
        high: f64,
    },
}

/// A number with its name and its range.
type Number = (&'static str, f64, [f64; 2]);

/// Checks every number.
pub(super) fn check(scenario: &Scenario) -> Result<(), Refused> {
    if scenario.steps.is_empty() {
        return Err(Refused::Empty);
    }
    section("start", &start(scenario))?;
    section("plant", &plant(scenario))?;
    for (step, numbers) in (1..).zip(scenario.steps.iter().map(numbers)) {
        for (name, value, [low, high]) in numbers {
            if !(low..=high).contains(&value) {
                return Err(Refused::Step {
                    step,
                    name,
                    value,
                    low,
                    high,
                });
            }
        }
    }
    Ok(())
}

fn section(section: &'static str, numbers: &[Number]) -> Result<(), Refused> {
    for &(name, value, [low, high]) in numbers {
        if !(low..=high).contains(&value) {
            return Err(Refused::Section {
                section,
                name,
                value,
                low,
                high,
            });
        }
    }
    Ok(())
}

fn start(scenario: &Scenario) -> Vec<Number> {
    match scenario.start {
        StartText::Slack { slack_mm } => vec![("slack_mm", slack_mm, [0.0, 50.0])],
        StartText::Held {
            azimuth_deg,
            tilt_deg,
            pretension_n,
            payload_kg,
        } => vec![
            ("azimuth_deg", azimuth_deg, [-3600.0, 3600.0]),
            ("tilt_deg", tilt_deg, [0.0, 60.0]),
            ("pretension_n", pretension_n, [0.0, 1e3]),
            ("payload_kg", payload_kg, PAYLOAD_KG),
        ],
    }
}

fn plant(scenario: &Scenario) -> Vec<Number> {
    let plant = scenario.plant;
    let gains = plant.cell_gain_error_percent;
    let offsets = plant.cell_offset_n;
    let mut numbers = vec![
        (
            "cell_noise_n",
            plant.cell_noise_n.unwrap_or(0.0),
            [0.0, 100.0],
        ),
        (
            "curve_error_percent",
            plant.curve_error_percent,
            [-50.0, 50.0],
        ),
    ];
    numbers.extend(gains.map(|gain| ("cell_gain_error_percent", gain, [-50.0, 50.0])));
    numbers.extend(offsets.map(|offset| ("cell_offset_n", offset, [-100.0, 100.0])));
    numbers
}

const PAYLOAD_KG: [f64; 2] = [0.0, 50.0];
const TIME_S: [f64; 2] = [0.0, LONGEST_S];
const ANGLE_DEG: [f64; 2] = [-3600.0, 3600.0];
const ANY: [f64; 2] = [f64::MIN, f64::MAX];

/// The numbers of a step. What the leg itself refuses by name is let through, so that this can be seen.
fn numbers(step: &Step) -> Vec<Number> {
    match step {
        Step::Move {
            azimuth_deg,
            tilt_deg,
        } => vec![
            ("azimuth_deg", *azimuth_deg, ANGLE_DEG),
            ("tilt_deg", *tilt_deg, [-90.0, 90.0]),
        ],
        Step::PretensionN(pretension_n) => vec![("pretension_n", *pretension_n, ANY)],
        Step::Stiffness {
            nm_per_rad,
            towards_deg,
        } => vec![
            ("nm_per_rad", *nm_per_rad, ANY),
            ("towards_deg", towards_deg.unwrap_or(0.0), ANGLE_DEG),
        ],
        Step::Payload { kg, over_s } => {
            vec![("kg", *kg, PAYLOAD_KG), ("over_s", *over_s, TIME_S)]
        }
        Step::Push {
            azimuth_deg,
            force_n,
            for_s,
        } => vec![
            ("azimuth_deg", *azimuth_deg, ANGLE_DEG),
            ("force_n", *force_n, [-1e4, 1e4]),
            ("for_s", *for_s, TIME_S),
        ],
        Step::WaitS(time_s) => vec![("wait_s", *time_s, TIME_S)],
        Step::Await { timeout_s, .. } => vec![("timeout_s", *timeout_s, TIME_S)],
        Step::Arrive { then_s, timeout_s } => vec![
            ("then_s", *then_s, TIME_S),
            ("timeout_s", *timeout_s, TIME_S),
        ],
        Step::Reaction { within_ms, .. } => {
            vec![("within_ms", *within_ms, [0.0, 1e3 * LONGEST_S])]
        }
        Step::Measure {
            between: [low, high],
            ..
        } => vec![
            ("the lower of between", *low, ANY),
            ("the higher of between", *high, [*low, f64::MAX]),
        ],
        Step::PushTest {
            azimuth_deg,
            force_n,
            settle_s,
            nm_per_rad,
            within_percent,
            ..
        } => vec![
            ("azimuth_deg", *azimuth_deg, ANGLE_DEG),
            ("force_n", *force_n, [1e-3, 1e4]),
            ("settle_s", *settle_s, [0.1, LONGEST_S]),
            ("nm_per_rad", *nm_per_rad, [0.0, f64::MAX]),
            ("within_percent", *within_percent, [0.0, 100.0]),
        ],
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::Scenario;

    fn refusal(text: &str) -> String {
        match Scenario::parse("a.toml", &format!("title = \"\"\n{text}")) {
            Ok(_) => String::new(),
            Err(failure) => failure.render(false),
        }
    }

    #[test]
    fn numbers_that_no_leg_can_meet_are_named() {
        for (text, part) in [
            ("steps = []", "there is no step"),
            (
                "steps = [\"arm\", { payload = { kg = nan } }]",
                "step 2: kg = NaN is not from 0 to 50",
            ),
            (
                "steps = [{ payload = { kg = -5 } }]",
                "step 1: kg = -5 is not from 0 to 50",
            ),
            (
                "steps = [{ wait_s = nan }]",
                "step 1: wait_s = NaN is not from 0 to 600",
            ),
            (
                "steps = [{ push = { azimuth_deg = 0, force_n = inf, for_s = 1 } }]",
                "step 1: force_n = inf is not from",
            ),
            (
                "steps = [{ measure = { name = \"a\", quantity = \"pretension_n\", between = [2, 1] } }]",
                "step 1: the higher of between = 1 is not from 2",
            ),
            (
                "steps = [\"arm\"]\n[start.slack]\nslack_mm = -50",
                "start: slack_mm = -50 is not from 0 to 50",
            ),
            (
                "steps = [\"arm\"]\n[plant]\ncell_gain_error_percent = [1e6, 0, 0]",
                "plant: cell_gain_error_percent = 1000000 is not from -50 to 50",
            ),
        ] {
            let words = refusal(text);
            assert!(words.contains(part), "{text}: {words}");
        }
        assert_eq!(refusal("steps = [\"arm\"]"), "");
    }
}
