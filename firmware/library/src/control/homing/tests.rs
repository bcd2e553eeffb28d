#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{HaulLimit, HomingSequence, HomingStep};
use crate::control::{CYCLE_TICKS, JogBounds, Measured, Mechanism, TICK_S};
use crate::settings::Settings;

/// A leg whose motors go exactly where they are led, and whose tensions and currents a test makes up.
struct Leg {
    settings: Settings,
    mechanism: Mechanism<f64>,
    homing: HomingSequence<f64>,
    measured: Measured<f64>,
    /// Where the motors are led, m.
    goals_m: [f64; 3],
    ticks: u32,
}

impl Leg {
    fn homing() -> Self {
        let settings = Settings::table_1().unwrap();
        let zero = [0.0; 3];
        Self {
            mechanism: Mechanism::new(&settings).unwrap(),
            homing: HomingSequence::new(
                &settings.homing,
                &zero,
                [HaulLimit::new(&bounds(&settings)); 3],
                0.0,
            ),
            measured: Measured {
                pulled_m: zero,
                tensions_n: zero,
                steady_tensions_n: zero,
                currents_a: zero,
                supply_v: 24.0,
                temperature_c: 30.0,
            },
            goals_m: zero,
            ticks: 0,
            settings,
        }
    }

    /// Ticks until homing asks for something else than to be led; `tensions_n` by how far the tendons are pulled in, m.
    fn lead(&mut self, tensions_n: impl Fn([f64; 3]) -> [f64; 3]) -> HomingStep<f64> {
        for _ in 0..400_000 {
            self.measured.tensions_n = tensions_n(self.measured.pulled_m);
            match self.advance() {
                HomingStep::Lead(_) | HomingStep::Searching => {}
                asked => return asked,
            }
        }
        panic!("homing asks for nothing");
    }

    /// A tick: its motors go where homing leads them.
    fn advance(&mut self) -> HomingStep<f64> {
        self.ticks += 1;
        let asked = self.homing.step(&self.mechanism, &self.measured);
        if let HomingStep::Lead(goals) = &asked {
            for (pulled, goal) in self.measured.pulled_m.iter_mut().zip(goals) {
                let step_m = goal.speed_m_per_s * f64::from(TICK_S);
                *pulled += (goal.pulled_m - *pulled).clamp(-step_m, step_m);
            }
            self.goals_m = goals.map(|goal| goal.pulled_m);
        }
        asked
    }

    /// With its load cells tared, and the first tendon about to be reeled in.
    fn tared() -> Self {
        let mut leg = Self::homing();
        assert_eq!(leg.lead(|_| [0.0; 3]), HomingStep::Tare([0.0; 3]));
        leg
    }
}

/// What its first motor may draw.
fn bounds(settings: &Settings) -> JogBounds<f64> {
    JogBounds::new(settings, &settings.servos[0])
}

fn slack(_: [f64; 3]) -> [f64; 3] {
    [0.0; 3]
}

/// One step of the release is enough for tendons that do not pull.
#[test]
fn slack_tendons_are_paid_out_by_one_step() {
    let mut leg = Leg::homing();
    assert!(leg.homing.releases());
    assert_eq!(leg.lead(slack), HomingStep::Tare([0.0; 3]));
    let release_m = f64::from(leg.settings.homing.release_m);
    assert_eq!(leg.goals_m, [-release_m; 3]);
    assert!(!leg.homing.releases());
}

#[test]
fn a_tendon_that_becomes_slack_is_paid_out_step_by_step_until_then() {
    let mut leg = Leg::homing();
    let release_m = f64::from(leg.settings.homing.release_m);
    // Taut over the first one and a half steps.
    let taut = |pulled: [f64; 3]| [0.0, (1e3 * (pulled[1] + 1.5 * release_m)).max(0.0), 0.0];
    assert_eq!(leg.lead(taut), HomingStep::Tare([0.0; 3]));
    // The step in which it became slack changed its tension still; the next one did not.
    for goal_m in leg.goals_m {
        assert!((goal_m + 3.0 * release_m).abs() < 1e-9, "{goal_m}");
    }
}

#[test]
fn a_tendon_that_stays_taut_over_its_travel_is_named() {
    for tendon in 1..=3_u8 {
        let mut leg = Leg::homing();
        let homing = leg.settings.homing;
        let stays_taut = |pulled: [f64; 3]| {
            let mut tensions_n = [0.0; 3];
            let i = usize::from(tendon) - 1;
            tensions_n[i] = 100.0 + 1e3 * pulled[i];
            tensions_n
        };
        assert_eq!(leg.lead(stays_taut), HomingStep::Failed(tendon));
        let (travel_m, release_m) = (homing.travel_m, homing.release_m);
        for pulled_m in leg.measured.pulled_m {
            let beyond_m = -pulled_m - f64::from(travel_m);
            let step = -1e-9..f64::from(release_m);
            assert!(step.contains(&beyond_m), "{beyond_m} m beyond its travel");
        }
    }
}

#[test]
fn an_offset_beyond_what_is_taken_as_a_zero_is_no_zero() {
    let max_n = f64::from(Leg::homing().settings.homing.tare_max_n);
    for tendon in 1..=3_u8 {
        for sign in [1.0, -1.0] {
            let with = |offset_n: f64| {
                let mut tensions_n = [0.0; 3];
                tensions_n[usize::from(tendon) - 1] = sign * offset_n;
                tensions_n
            };
            let allowed = Leg::homing().lead(|_| with(max_n));
            assert_eq!(allowed, HomingStep::Tare(with(max_n)));
            let beyond = Leg::homing().lead(|_| with(max_n + 0.1));
            assert_eq!(beyond, HomingStep::Failed(tendon));
        }
    }
}

#[test]
fn a_tendon_that_is_not_taut_within_its_travel_is_named() {
    let mut leg = Leg::tared();
    assert_eq!(leg.lead(slack), HomingStep::Failed(1));
    let travel_m = leg.goals_m[0] - leg.measured.pulled_m[0];
    assert!(travel_m < 1e-3, "{travel_m} m are left");
}

/// Whichever way it is driven, and whichever tendon is reeled in.
/// Those before it are found meanwhile.
#[test]
fn whichever_tendon_does_not_become_taut_is_named() {
    for tendon in 1..=3_u8 {
        let mut leg = Leg::tared();
        let taut_from_1_mm = |pulled_m: [f64; 3]| {
            let mut tensions_n = pulled_m.map(|pulled| 1e4 * (pulled - 1e-3).max(0.0));
            tensions_n[usize::from(tendon) - 1] = 0.0;
            tensions_n
        };
        assert_eq!(leg.lead(taut_from_1_mm), HomingStep::Failed(tendon));
    }
}

#[test]
fn a_motor_that_draws_more_than_any_tension_asks_for_is_named_at_once() {
    for tendon in 1..=3_u8 {
        for sign in [1.0, -1.0] {
            let mut leg = Leg::tared();
            let i = usize::from(tendon) - 1;
            leg.measured.currents_a[i] = sign * (bounds(&leg.settings).current_max_a + 0.01);
            let begun = leg.ticks;
            assert_eq!(leg.lead(slack), HomingStep::Failed(tendon));
            let time_s = f64::from(leg.ticks - begun) * f64::from(TICK_S);
            assert!((0.029..0.032).contains(&time_s), "{time_s} s");
        }
    }
}

/// A dead load cell shows no touch. What the motor draws beyond what it drew while its tendon was slack does.
#[test]
fn a_motor_that_draws_more_than_with_a_slack_tendon_is_named() {
    for (part, fails) in [(0.95, false), (1.05, true)] {
        let mut leg = Leg::tared();
        let pull_a = bounds(&leg.settings).pull_max_a;
        let friction_a = 0.7 * f64::from(leg.settings.servos[0].friction_a);
        leg.measured.currents_a[0] = friction_a;
        let begun_m = leg.measured.pulled_m[0];
        let travel_m = f64::from(leg.settings.homing.travel_m);
        let release_m = f64::from(leg.settings.homing.release_m);
        // Slack for most of a step of the release.
        while leg.measured.pulled_m[0] < begun_m + 0.9 * release_m {
            leg.advance();
        }
        leg.measured.currents_a[0] = friction_a + part * pull_a;
        assert_eq!(leg.lead(slack), HomingStep::Failed(1));
        let way_m = leg.measured.pulled_m[0] - begun_m;
        assert_eq!(way_m < 0.5 * travel_m, fails, "{way_m} m");
    }
}

/// A cell that shows a tension where its tendon is slack.
#[test]
fn a_slack_tendon_that_shows_a_tension_is_named() {
    for tendon in 2..=3_u8 {
        for sign in [1.0, -1.0] {
            let mut leg = Leg::tared();
            let shown_n = sign * 0.6 * f64::from(leg.settings.homing.touch_n);
            let mut tensions_n = [0.0; 3];
            tensions_n[usize::from(tendon) - 1] = shown_n;
            let begun = leg.ticks;
            assert_eq!(leg.lead(|_| tensions_n), HomingStep::Failed(tendon));
            assert!(leg.ticks - begun < 100 * u32::from(CYCLE_TICKS));
        }
    }
}
