//! A stiffness that is asked for below what the lowest tensions give: the pretension follows its bound.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::ready_runs::require_shadow;
use leg_firmware::supervisor::Fault;
use leg_rig::rig_file::RigFile;
use leg_sim::link::InProcess;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::Simulation;

/// While the load is left out, the bound moves with every cycle.
const SCENARIO: &str = r#"
title = "The compensation ends while the pretension is at its bound"
steps = [
    { await = { state = "disarmed", timeout_s = 1 } },
    "arm",
    { wait_s = 0.5 },
    { stiffness = { nm_per_rad = 12 } },
    { wait_s = 1.5 },
    { compensation = "off" },
    { wait_s = 0.6 },
]
[start.held]
azimuth_deg = 77
tilt_deg = 4
pretension_n = 60
payload_kg = 0.1
"#;

/// Ticks of a cycle of targets.
const CYCLE_TICKS: usize = 4;

/// A change of the way from one cycle to the next that is a turn, m: 0.6 mm/s.
const TURN_M: f32 = 3e-7;

/// Part of the cycles in which a tendon may turn: damping and the play of the gears take one in a hundred. Where the pretension
/// stood still in every second cycle it was most of them, and motors were driven to and fro until one counted as jammed.
const TURNS_PART_MAX: f64 = 0.05;

#[test]
fn tendons_do_not_go_to_and_fro_while_their_pretension_follows_its_bound() {
    let scenario = Scenario::parse("floor", SCENARIO).unwrap();
    let simulation = Simulation::new(&scenario, &RigFile::load(None).unwrap()).unwrap();
    let mut references = Vec::new();
    let run = simulation.run(&mut InProcess::new(), &mut |tick| {
        references.push(tick.telemetry.reference_m);
    });
    let summary = run.unwrap();
    require_shadow(&summary, "floor");
    let faults: Vec<_> = summary.faults.iter().map(|(fault, _)| *fault).collect();
    assert_eq!(faults, [Fault::Unreachable]);
    // The last 0.5 s.
    let late = &references[references.len() - 4_000..];
    let (mut turns, mut cycles) = (0, 0);
    for tendon in 0..3 {
        let ways: Vec<f32> = late
            .iter()
            .step_by(CYCLE_TICKS)
            .map(|reference| reference[tendon])
            .collect();
        for three in ways.windows(3) {
            let turn_m = three[2] - 2.0 * three[1] + three[0];
            turns += u32::from(turn_m.abs() > TURN_M);
            cycles += 1;
        }
    }
    let part = f64::from(turns) / f64::from(cycles);
    assert!(part < TURNS_PART_MAX, "{turns} turns in {cycles} cycles");
}
