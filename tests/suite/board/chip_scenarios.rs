//! The ready scenarios under the image that is flashed, on an emulated chip.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::bits_under_qemu::NOT_COMPARED;
use super::chip_latency::driven_latency;
use crate::common::homed_chip::{HomedChip, Homings};
use leg_boards::chip::LATENCY_CYCLES_MAX;
use leg_boards::image::FirmwareImage;
use leg_boards::setup;
use leg_rig::rig_file::RigFile;
use leg_sim::link::{InProcess, Link};
use leg_sim::ready_scenarios::READY_SCENARIOS;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::{Simulation, Summary};
use rustix::time::{ClockId, clock_gettime};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// At most: a machine has two cores.
const THREADS: usize = 2;

/// A second of homing, and the emergency stop in it.
const EMERGENCY_STOP: &str = r#"
title = "The emergency stop is pressed while the leg homes"
steps = [
    { await = { state = "disarmed", timeout_s = 1 } },
    "home",
    { wait_s = 1 },
    "mark",
    { emergency_stop = true },
    { reaction = { fault = "emergency_stop", state = "off", within_ms = 1 } },
    { wait_s = 0.05 },
    "arm",
    { wait_s = 0.05 },
    { await = { state = "off", timeout_s = 0.01 } },
]
[start.slack]
slack_mm = 1
"#;

/// The motor supply sags while the leg homes.
const SUPPLY: &str = r#"
title = "The motor supply sags while the leg homes"
steps = [
    { await = { state = "disarmed", timeout_s = 1 } },
    "home",
    { wait_s = 0.3 },
    { fault = "supply_sag" },
    { reaction = { fault = "supply_low", state = "held", within_ms = 2 } },
    { wait_s = 0.05 },
    "arm",
    { wait_s = 0.05 },
    { await = { state = "held", timeout_s = 0.01 } },
]
[start.slack]
slack_mm = 1
"#;

/// Bytes that are no frames come in while the leg homes.
const GARBAGE: &str = r#"
title = "Damaged bytes while the leg homes"
steps = [
    { await = { state = "disarmed", timeout_s = 1 } },
    "home",
    { wait_s = 0.3 },
    { garbage = 4000 },
    { reaction = { fault = "bad_frame", state = "homing", within_ms = 60 } },
    { wait_s = 0.1 },
    "disarm",
    { await = { state = "disarmed", timeout_s = 2 } },
]
[start.slack]
slack_mm = 1
"#;

/// Motors that get so little voltage that homing fails: what a chip can show of `fault_following`.
const FOLLOWING: &str = r#"
title = "Motors that get too little voltage lag behind in homing"
steps = [
    { await = { state = "disarmed", timeout_s = 1 } },
    "home",
    { reaction = { fault = "following", state = "held", within_ms = 1500 } },
    { wait_s = 0.1 },
    "arm",
    { wait_s = 0.1 },
    { await = { state = "held", timeout_s = 0.01 } },
]
[start.slack]
slack_mm = 1
[control.servo]
duty_max = 0.05
"#;

fn image() -> PathBuf {
    setup::ensure_target(&mut |_| {}).unwrap();
    FirmwareImage::Stm32g474.build().unwrap()
}

fn run(scenario: &Scenario, link: &mut dyn Link) -> Result<Summary, String> {
    let rig = RigFile::load(Some(Path::new(&scenario.rig))).unwrap();
    let simulation = Simulation::new(scenario, &rig).unwrap();
    simulation.run(link, &mut |_| ()).map_err(|e| e.to_string())
}

/// Why a scenario does not pass; none if it does.
fn failure(run: &Result<Summary, String>) -> Option<String> {
    match run {
        Ok(summary) if summary.passes() => None,
        Ok(summary) => {
            let measured = summary.measurements.iter().filter(|found| !found.passes());
            let failed: Vec<_> = measured.map(|found| (&found.name, found.value)).collect();
            Some(format!(
                "{:?}, failed: {failed:?}, not expected: {:?}",
                summary.stopped, summary.unexpected
            ))
        }
        Err(error) => Some(error.clone()),
    }
}

/// Time of the processor that this thread has taken, s.
fn cpu_s() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// Runs a scenario in process and on the chip, and prints how it went; why it does not pass on both.
fn compare(name: &str, scenario: &Scenario, image: &Path, homings: &Homings) -> Option<String> {
    let here = failure(&run(scenario, &mut InProcess::new()));
    let start_s = cpu_s();
    let mut chip = HomedChip::new(image, homings);
    let on_chip = run(scenario, &mut chip);
    let took_s = cpu_s() - start_s;
    let ticks = on_chip.as_ref().map_or(0, |summary| summary.ticks);
    let on_chip = failure(&on_chip);
    eprintln!(
        "{name}: {}, {ticks} ticks in {took_s:.0} s of the processor, {} of them repeated from another's homing",
        on_chip.as_deref().unwrap_or("passes"),
        chip.repeated,
    );
    match (here, on_chip) {
        (None, None) => None,
        (here, on_chip) => Some(format!(
            "{name}: in process {here:?}, on the chip {on_chip:?}"
        )),
    }
}

/// The duties at the pins are compared with those in process in every tick, and what the chip reports of itself every
/// 25 ms: see [`ChipSession`].
#[test]
fn a_chip_homes_and_its_emergency_stop_ends_the_pulses() {
    let scenario = Scenario::parse("stop", EMERGENCY_STOP).unwrap();
    assert_eq!(
        compare("stop", &scenario, &image(), &Homings::default()),
        None
    );
}

#[test]
fn a_sag_of_the_motor_supply_is_seen_and_held() {
    let scenario = Scenario::parse("supply", SUPPLY).unwrap();
    assert_eq!(
        compare("supply", &scenario, &image(), &Homings::default()),
        None
    );
}

/// The frames are longer than the bytes that a tick records.
#[test]
fn damaged_bytes_are_found_by_a_chip_and_its_shadow_in_the_same_tick() {
    let scenario = Scenario::parse("garbage", GARBAGE).unwrap();
    assert_eq!(
        compare("garbage", &scenario, &image(), &Homings::default()),
        None
    );
}

/// It takes minutes, and does on a chip what `tour` does.
const LEFT_OUT: &str = "workspace";

/// Long ones, in a test of their own: what they do beyond the others is the control law's alone, and `bits_under_qemu` compares its
/// bits in them. No other drives one motor with two at rest, as `jog` does.
const LONG: [&str; 15] = [
    "fault_homing_failed",
    "fault_infeasible_load",
    "fault_not_taut",
    "fault_off_station",
    "fault_point_missing",
    "fig9",
    "hold",
    "homing",
    "homing_again",
    "jog",
    "other_tendons",
    "payload",
    "stiffness",
    "stiffness_lean",
    "trim",
];

/// The ready scenarios, as they are run on a board; those that are long, or the others.
fn ready(long: bool) -> Vec<(&'static str, Scenario)> {
    let mut found = Vec::new();
    for ready in READY_SCENARIOS {
        if ready.name == LEFT_OUT || LONG.contains(&ready.name) != long {
            continue;
        }
        let scenario = Scenario::parse(ready.name, ready.text).unwrap();
        match scenario.board_variant() {
            Ok(scenario) => found.push((ready.name, scenario)),
            Err(why) => eprintln!("{}: not run: {why}", ready.name),
        }
    }
    found
}

/// The homings of the chips that passed.
fn require_passed(mut left: Vec<(&str, Scenario)>) -> Homings {
    let image = image();
    // The longest first.
    left.sort_by_key(|(_, scenario)| scenario.steps.len());
    let homings = Homings::default();
    let (left, failed) = (Mutex::new(left), Mutex::new(Vec::new()));
    let next = || left.lock().unwrap().pop();
    std::thread::scope(|scope| {
        for _ in 0..THREADS {
            scope.spawn(|| {
                while let Some((name, scenario)) = next() {
                    let found = compare(name, &scenario, &image, &homings);
                    failed.lock().unwrap().extend(found);
                }
            });
        }
    });
    assert_eq!(failed.into_inner().unwrap(), [""; 0]);
    homings
}

/// All of them but the long ones, homed first: `cargo test --test suite -- --ignored --nocapture chip_scenarios` runs all, and prints each as it
/// ends. The samples above are run always.
#[test]
#[ignore = "takes minutes on two cores: run with --ignored"]
fn the_ready_scenarios_pass_on_the_chip_as_in_process() {
    let following = Scenario::parse("following", FOLLOWING).unwrap();
    let mut scenarios = ready(false);
    scenarios.push(("following", following));
    let mut active = require_passed(scenarios).active().unwrap();
    let (cycles, place) = driven_latency(active.chip().unwrap());
    eprintln!("latest control interrupt of a leg that is driven: {cycles} cycles, at {place:#x}");
    assert!(cycles <= LATENCY_CYCLES_MAX, "{cycles} at {place:#x}");
}

/// The long ones, each of which runs under QEMU, too.
#[test]
#[ignore = "takes minutes on two cores: run with --ignored"]
fn the_long_scenarios_pass_on_the_chip_as_in_process() {
    let long = ready(true);
    assert_eq!(long.len(), LONG.len());
    assert!(long.iter().all(|(name, _)| !NOT_COMPARED.contains(name)));
    require_passed(long);
}
