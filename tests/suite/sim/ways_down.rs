//! How a leg stops and comes down: on every rig, at full speed, near the maximum tension.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::ready_runs::require_shadow;
use crate::common::require_said;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::supervisor::{Fault, State};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_sim::link::InProcess;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::{Simulation, Summary, Tick};

/// Brings the leg to where it follows.
const ARM: &str = r#""arm", { wait_s = 0.4 },"#;

/// A leg that stands somewhere, and what is done to it.
struct Course<'a> {
    rig: &'a str,
    azimuth: u32,
    tilt: u32,
    payload: f64,
    pretension: f64,
    steps: &'a str,
    /// Faults that may come.
    expected: &'a str,
    /// Gains and limits in the place of the rig's.
    control: &'a str,
}

impl Course<'_> {
    /// Runs it; none where the pose does not allow its payload at the pretension.
    fn run(&self, watch: &mut dyn FnMut(&Tick<'_>)) -> Option<Summary> {
        let text = format!(
            r#"
title = "ways down"
expected = [{}]
steps = [
    {{ await = {{ state = "disarmed", timeout_s = 1 }} }},
    {}
]
{}
[start.held]
azimuth_deg = {}
tilt_deg = {}
pretension_n = {}
payload_kg = {}
"#,
            self.expected,
            self.steps,
            self.control,
            self.azimuth,
            self.tilt,
            self.pretension,
            self.payload
        );
        let scenario = Scenario::parse("ways down", &text).unwrap();
        let rig = RigFile::load(Some(self.rig.as_ref())).unwrap();
        let simulation = Simulation::new(&scenario, &rig).ok()?;
        let summary = simulation.run(&mut InProcess::new(), watch).unwrap();
        assert_eq!(summary.stopped, None, "{}:\n{text}", self.rig);
        require_shadow(&summary, &format!("{}:\n{text}", self.rig));
        Some(summary)
    }
}

/// What a measure of a summary gave.
fn measured(summary: &Summary, name: &str) -> f64 {
    let found = summary.measurements.iter().find(|one| one.name == name);
    found.unwrap().value
}

/// A leg is paid out at the speed of the ramp, whether it was led down before or not: the farthest tendon at 5 mm/s, and no faster
/// for a moment than the servo needs to begin.
#[test]
fn tendons_are_paid_out_no_faster_than_is_said() {
    // Over 2 ms, so that single counts do not matter.
    const SHORT: usize = 16;
    // Over 50 ms, in which the play of the gear is taken up.
    const LONG: usize = 400;
    const FASTEST_MM_PER_S: [f64; 2] = [7.5, 5.3];
    let words = format!(
        "up to {} mm/s for a moment as it begins",
        FASTEST_MM_PER_S[0]
    );
    require_said("firmware/SAFETY.md", &[words]);
    let led_down =
        format!(r#"{ARM} "disarm", {{ await = {{ state = "disarmed", timeout_s = 20 }} }},"#);
    // A fault that does not touch the lengths: the disarm does not lead the leg down.
    let paid_out = format!(
        r#"{ARM} {{ fault = {{ cell_stale = 2 }} }}, {{ await = {{ state = "held", timeout_s = 1 }} }}, {{ wait_s = 0.3 }},
        "disarm", {{ await = {{ state = "disarmed", timeout_s = 20 }} }},"#
    );
    let mut runs = 0;
    let mut fastest_mm_per_s = [0.0_f64; 2];
    for rig in READY_RIGS {
        for (azimuth, tilt, payload) in [(60, 25, 2.0), (200, 10, 0.0)] {
            for (steps, expected) in [(&led_down, ""), (&paid_out, "\"cell_stale\"")] {
                let course = Course {
                    rig: rig.name,
                    azimuth,
                    tilt,
                    payload,
                    pretension: 70.0,
                    steps,
                    expected,
                    control: "",
                };
                let mut pulled_m: Vec<[f32; 3]> = Vec::new();
                let ran = course.run(&mut |tick| {
                    if tick.telemetry.state == State::RampingDown {
                        pulled_m.push(tick.telemetry.pulled_m);
                    }
                });
                if ran.is_none() {
                    continue;
                }
                runs += 1;
                assert!(pulled_m.len() > LONG, "{}", rig.name);
                for (fastest, span) in fastest_mm_per_s.iter_mut().zip([SHORT, LONG]) {
                    *fastest = fastest.max(fastest_out_mm_per_s(&pulled_m, span));
                }
            }
        }
    }
    assert!(runs >= 20, "{runs} runs");
    for (fastest, bar) in fastest_mm_per_s.into_iter().zip(FASTEST_MM_PER_S) {
        assert!(
            (0.9 * 5.0..bar).contains(&fastest),
            "{fastest_mm_per_s:?} mm/s"
        );
    }
}

/// The fastest that a tendon is paid out over a span of ticks, mm/s.
fn fastest_out_mm_per_s(pulled_m: &[[f32; 3]], span: usize) -> f64 {
    let span_s = span as f64 / f64::from(TICK_HZ);
    let pairs = pulled_m.iter().zip(&pulled_m[span..]);
    let out = pairs.flat_map(|(before, now)| before.iter().zip(now).map(|(a, b)| a - b));
    f64::from(out.fold(0.0, f32::max)) * 1e3 / span_s
}

/// Whoever disarms or clears a leg while it brakes waits until it stands: stopped at once from full speed it would swing with its
/// payload, and double what braking adds to the tension.
#[test]
fn a_leg_that_is_disarmed_or_cleared_while_it_brakes_brakes_first() {
    const SWINGS_N: f64 = 2.0;
    let tension_n = |rig: &str, wait: &str, then: &str| {
        let steps = format!(
            r#"{ARM} {{ move = {{ azimuth_deg = 220, tilt_deg = 25 }} }}, {{ wait_s = 0.45 }}, "mark", "stop", {wait} {then} {{ wait_s = 0.5 }},
            {{ measure = {{ name = "tension", quantity = "tension_max_n", between = [0, 1000] }} }},"#
        );
        let course = Course {
            rig,
            azimuth: 40,
            tilt: 25,
            payload: 2.0,
            pretension: 70.0,
            steps: &steps,
            expected: "",
            control: "",
        };
        let summary = course.run(&mut |_| ())?;
        Some(measured(&summary, "tension"))
    };
    let mut runs = 0;
    for rig in READY_RIGS {
        let Some(stopped_n) = tension_n(rig.name, "", "") else {
            continue;
        };
        for then in ["\"disarm\",", "\"clear\","] {
            for wait in ["", "{ wait_s = 0.02 },", "{ wait_s = 0.1 },"] {
                let highest_n = tension_n(rig.name, wait, then).unwrap();
                assert!(
                    highest_n < stopped_n + SWINGS_N,
                    "{}, {wait} {then} {highest_n} N, {stopped_n} N where it only stops",
                    rig.name
                );
                runs += 1;
            }
        }
    }
    assert!(runs >= 18, "{runs} runs");
}

/// A tendon beyond the maximum tension ends homing by its name: nothing is known yet of what the lengths say.
#[test]
fn a_tension_beyond_the_maximum_ends_homing_by_that_name() {
    let course = Course {
        rig: "table1",
        azimuth: 0,
        tilt: 0,
        payload: 0.0,
        pretension: 120.0,
        steps: r#"{ push = { azimuth_deg = 180, force_n = 8, for_s = 3 } }, { wait_s = 1.5 }, "home", { wait_s = 0.3 },"#,
        expected: "\"over_tension\"",
        control: "[control.limits]\njump_n = 1000\n",
    };
    let summary = course.run(&mut |_| ()).unwrap();
    let named: Vec<Fault> = summary.faults.iter().map(|(fault, _)| *fault).collect();
    assert_eq!(named.first(), Some(&Fault::OverTension), "{named:?}");
    assert!(summary.unexpected.is_empty(), "{named:?}");
}

/// A dead band that a user has raised ends no way: homing goes on, and a leg that is disarmed arrives.
#[test]
fn a_wide_dead_band_stops_no_move_from_arriving() {
    for dead_band_m in ["5e-5", "1.2e-4"] {
        let control = format!("[control.servo]\ndead_band_m = {dead_band_m}\n");
        let mut ramp_ticks = 0_u64;
        let course = Course {
            rig: "table1",
            azimuth: 0,
            tilt: 0,
            payload: 0.0,
            pretension: 20.0,
            steps: r#""home", { await = { state = "active", timeout_s = 30 } }, { wait_s = 0.1 }, "disarm", { await = { state = "disarmed", timeout_s = 20 } },"#,
            expected: "",
            control: &control,
        };
        course
            .run(&mut |tick| ramp_ticks += u64::from(tick.telemetry.state == State::RampingDown))
            .unwrap();
        // 5 mm at 5 mm/s; without an arrival it would be waited for twice that and half a second.
        assert!(
            ramp_ticks < 3 * u64::from(TICK_HZ) / 2,
            "{dead_band_m}: {ramp_ticks} ticks"
        );
    }
}

/// A motor that stays behind at full speed is held by that name: what it coasts on is no motor that runs away.
#[test]
fn a_motor_that_coasts_after_it_stayed_behind_does_not_run_away() {
    let mut coasted_m = 0.0_f32;
    for duty_max in ["0.2", "0.5", "0.7"] {
        let steps =
            format!("{ARM} {{ move = {{ azimuth_deg = 220, tilt_deg = 30 }} }}, {{ wait_s = 2 }},");
        let control = format!(
            "[control.servo]\nduty_max = {duty_max}\nspeed_m_per_s = 0.06\n\
             [control.motion]\nspeed_rad_per_s = 3.0\nacceleration_rad_per_s2 = 20.0\njerk_rad_per_s3 = 500.0\n"
        );
        let course = Course {
            rig: "table1",
            azimuth: 40,
            tilt: 30,
            payload: 1.0,
            pretension: 70.0,
            steps: &steps,
            expected: "\"following\"",
            control: &control,
        };
        let mut held_m: Option<[f32; 3]> = None;
        let summary = course.run(&mut |tick| {
            if tick.telemetry.faults.has(Fault::Following) {
                let now_m = tick.telemetry.pulled_m;
                for (held, now) in held_m.get_or_insert(now_m).iter().zip(now_m) {
                    coasted_m = coasted_m.max((held - now).abs());
                }
            }
        });
        let summary = summary.unwrap();
        assert!(held_m.is_some(), "{duty_max}");
        assert!(summary.unexpected.is_empty(), "{:?}", summary.unexpected);
    }
    // Three quarters of 0.6 mm is a motor that runs away.
    assert!((5e-5..1.8e-4).contains(&coasted_m), "{coasted_m} m");
}

/// An encoder that counts the wrong way near the maximum tension, at rest and in each of the ways in which a leg moves.
#[test]
fn a_reversed_encoder_near_the_maximum_tension_pulls_no_harder_than_is_said() {
    // That of the strikes, 10 % beyond the maximum, is 165 N.
    const HIGHEST_N: f64 = 155.0;
    let ways = [
        r#"{ fault = { encoder_reversed = T } }, { wait_s = 1 },"#,
        r#"{ fault = { encoder_reversed = T } }, { push = { azimuth_deg = 120, force_n = 4, for_s = 0.3 } }, { wait_s = 1 },"#,
        r#"{ move = { azimuth_deg = 200, tilt_deg = 10 } }, { wait_s = W }, { fault = { encoder_reversed = T } }, { wait_s = 1 },"#,
        r#""stop", { wait_s = 0.3 }, { fault = { encoder_reversed = T } }, "clear", "disarm", { wait_s = 2 },"#,
        r#""disarm", { wait_s = W }, { fault = { encoder_reversed = T } }, { wait_s = 2 },"#,
        r#"{ pretension_n = 60 }, { wait_s = W }, { fault = { encoder_reversed = T } }, { wait_s = 1 },"#,
        r#"{ pretension_n = 60 }, { wait_s = 1 }, { pretension_n = 145 }, { wait_s = 0.6 }, { fault = { encoder_reversed = T } }, { wait_s = 1 },"#,
    ];
    let mut highest_n = 0.0_f64;
    let mut runs = 0;
    for way in ways {
        for tendon in ["1", "2", "3"] {
            for (azimuth, tilt, payload, pretension) in [
                (0, 1, 0.0, 143.0),
                (40, 20, 1.0, 115.0),
                (240, 25, 0.0, 120.0),
            ] {
                for wait in ["0.15", "0.4"] {
                    if !way.contains('W') && wait != "0.15" {
                        continue;
                    }
                    let steps = format!("{ARM} {}", way.replace('T', tendon).replace('W', wait));
                    let course = Course {
                        rig: "table1",
                        azimuth,
                        tilt,
                        payload,
                        pretension,
                        steps: &steps,
                        expected: "\"encoder_reversed\", \"runs_away\", \"residual\", \"following\", \"encoder_jump\", \"current_disagrees\", \"over_tension\", \"slack\", \"tension_jump\"",
                        control: "",
                    };
                    let Some(summary) = course.run(&mut |_| ()) else {
                        continue;
                    };
                    runs += 1;
                    let [_, n] = summary.tension_range_n;
                    highest_n = highest_n.max(n);
                }
            }
        }
    }
    assert!(runs > 60, "{runs} runs");
    assert!(highest_n < HIGHEST_N, "{highest_n} N");
}
