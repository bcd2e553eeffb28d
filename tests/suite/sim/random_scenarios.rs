//! Random scenarios: whatever comes, no number is lost, no tendon is pulled above the maximum tension, nothing re-arms, and the control law in
//! f64 beside the leg comes to the same states.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use fastrand::Rng;
use leg_firmware::supervisor::FaultSet;
use leg_rig::rig_file::RigFile;
use leg_sim::action::Action;
use leg_sim::link::InProcess;
use leg_sim::plant::Defect;
use leg_sim::scenario::{Scenario, Step};
use leg_sim::simulation::{Simulation, Tick};
use std::fmt::Write;
use std::path::Path;

/// How many are tried. Each is made from its number alone: `run(number)` replays it.
const SCENARIOS: u64 = 1000;

/// While the motors follow commands no tension goes beyond this, N: where too much tension is a fault, a tenth above the
/// maximum. So much a swing of the leg adds before a motor gives way. Where they are held, what acts from outside decides.
const F_MAX_N: f64 = 150.0 * 1.1;

/// The same where a worn motor or gear is switched off in motion, N: nothing brakes the leg then, and it swings.
const WORN_MAX_N: f64 = 150.0 * 1.15;

/// The same where a driver switches on fully by itself, N: it pulls until the motor is seen to run away.
const RUNAWAY_MAX_N: f64 = 150.0 * 2.6;

/// The faults of worn motors and gears.
const WORN: [&str; 3] = ["motor_intermittent", "screw_dry", "gear_play"];

/// What has to hold in every tick.
#[derive(Default)]
struct Watch {
    faulty: bool,
    complaint: Option<String>,
}

impl Watch {
    fn check(&mut self, tick: &Tick<'_>) {
        let telemetry = tick.telemetry;
        let sound = tick.drive.duty.iter().all(|duty| duty.abs() <= 1.0);
        let numbers = [telemetry.pose, telemetry.target].concat();
        if !sound || !numbers.iter().all(|number| number.is_finite()) {
            self.complain(tick, "a number is lost");
        }
        if self.faulty && telemetry.state.led() {
            self.complain(tick, "the leg re-armed by itself");
        }
        if !telemetry.state.driven() && tick.drive.enabled {
            self.complain(tick, "the drivers are on");
        }
        self.faulty |= telemetry.faults.stopping() != FaultSet::NONE;
    }

    fn complain(&mut self, tick: &Tick<'_>, what: &str) {
        if self.complaint.is_none() {
            self.complaint = Some(format!(
                "{what} in tick {}: {:?}",
                tick.telemetry.tick, tick.telemetry
            ));
        }
    }
}

/// A scenario as text, so that one that fails can be kept as a file. It has no `clear`.
fn text(seed: u64) -> String {
    let mut rng = Rng::with_seed(seed);
    let mut text = format!(
        "title = \"random scenario {seed}\"\nseed = {seed}\nsteps = [\n    {{ wait_s = 0.01 }},\n    \"arm\",\n"
    );
    for _ in 0..rng.u32(3..12) {
        writeln!(
            text,
            "    {},\n    {{ wait_s = {} }},",
            step(&mut rng),
            rng.f64() * 0.3
        )
        .unwrap();
    }
    let (azimuth, tilt, payload) = (360.0 * rng.f64(), 30.0 * rng.f64(), 2.0 * rng.f64());
    let noise = 0.3 * rng.f64();
    write!(
        text,
        "]\n\n[start.held]\nazimuth_deg = {azimuth}\ntilt_deg = {tilt}\npretension_n = 70\npayload_kg = {payload}\n\n[plant]\ncell_noise_n = {noise}\n"
    )
    .unwrap();
    text
}

fn step(rng: &mut Rng) -> String {
    match rng.u32(0..12) {
        0..=3 => format!(
            "{{ move = {{ azimuth_deg = {}, tilt_deg = {} }} }}",
            360.0 * rng.f64(),
            35.0 * rng.f64()
        ),
        4 => format!("{{ pretension_n = {} }}", 160.0 * rng.f64()),
        5 => format!(
            "{{ stiffness = {{ nm_per_rad = {} }} }}",
            300.0 * rng.f64() - 20.0
        ),
        6 => format!(
            "{{ payload = {{ kg = {}, over_s = {} }} }}",
            2.0 * rng.f64(),
            0.1 + 0.2 * rng.f64()
        ),
        7 => format!(
            "{{ compensation = \"{}\" }}",
            ["off", "estimated", "frozen"][rng.usize(0..3)]
        ),
        8 => format!("{{ garbage = {} }}", rng.u32(1..600)),
        9 => [
            "\"arm\"",
            "\"home\"",
            "\"hold\"",
            "\"stop\"",
            "\"disarm\"",
            "\"keep_station\"",
        ][rng.usize(0..6)]
        .into(),
        10 => format!(
            "{{ push = {{ azimuth_deg = {}, force_n = {}, for_s = 0.2 }} }}",
            360.0 * rng.f64(),
            1.5 * rng.f64()
        ),
        _ => {
            let all: Vec<Defect> = Defect::all().collect();
            format!("{{ fault = {} }}", toml_of(all[rng.usize(0..all.len())]))
        }
    }
}

/// A defect as the value of a key.
fn toml_of(defect: Defect) -> String {
    match serde_json::to_value(defect).unwrap() {
        serde_json::Value::Object(map) => {
            let (name, number) = map.into_iter().next().unwrap();
            format!("{{ {name} = {number} }}")
        }
        name => name.to_string(),
    }
}

/// Runs one. Whether it could start, or what is wrong with it.
fn run(seed: u64, rig: &RigFile) -> Result<bool, String> {
    let scenario = Scenario::parse("random", &text(seed)).map_err(|error| format!("{error:?}"))?;
    // A pose that its payload does not allow at the pretension is no start.
    let Ok(simulation) = Simulation::new(&scenario, rig) else {
        return Ok(false);
    };
    let mut watch = Watch::default();
    let summary = simulation
        .run(&mut InProcess::new(), &mut |tick| watch.check(tick))
        .map_err(|error| error.to_string())?;
    let any = |names: &[&str]| {
        scenario.steps.iter().any(|step| match step {
            Step::Action(Action::Fault(defect)) => names.contains(&defect.into()),
            _ => false,
        })
    };
    let max_n = if any(&["driver_full_on"]) {
        RUNAWAY_MAX_N
    } else if any(&WORN) {
        WORN_MAX_N
    } else {
        F_MAX_N
    };
    let highest = summary.driven_max_n;
    if let Some(words) = summary.stopped {
        return Err(words);
    }
    match watch.complaint {
        Some(complaint) => Err(complaint),
        None if !summary.divergence.stays() => {
            Err(format!("it left its shadow: {:?}", summary.divergence))
        }
        None if highest > max_n => Err(format!("a tension of {highest} N")),
        None => Ok(true),
    }
}

#[test]
fn whatever_comes_the_leg_stays_safe() {
    let rig = RigFile::load(Some(Path::new("table1"))).unwrap();
    let work = |thread: u64| {
        (thread..SCENARIOS)
            .step_by(2)
            .map(|seed| (seed, run(seed, &rig)))
            .collect::<Vec<_>>()
    };
    let results = std::thread::scope(|scope| {
        let other = scope.spawn(|| work(1));
        let mut results = work(0);
        results.extend(other.join().unwrap());
        results
    });
    let began = results.iter().filter(|(_, result)| *result == Ok(true));
    let began = began.count() as u64;
    assert!(10 * began > 9 * SCENARIOS, "only {began} could begin");
    let failures = results.into_iter();
    let failed: Vec<_> = failures
        .filter_map(|(seed, result)| result.err().map(|error| (seed, error)))
        .collect();
    for (seed, error) in &failed {
        println!("seed {seed}: {error}");
    }
    if let Some((seed, _)) = failed.first() {
        println!("\n{}", text(*seed));
    }
    assert!(
        failed.is_empty(),
        "{} of {SCENARIOS} failed; see above",
        failed.len()
    );
}
