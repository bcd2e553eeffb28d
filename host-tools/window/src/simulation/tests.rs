#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::Simulation;
use leg_firmware::command::{Command, Compensation};
use leg_firmware::supervisor::{Fault, State};
use leg_sim::plant::Defect;

fn wait(simulation: &mut Simulation, time_s: f64) {
    for _ in 0..(time_s * 20.0) as u32 {
        simulation.advance(0.05);
    }
}

fn error_mm(simulation: &Simulation) -> f64 {
    simulation.leg().comparison().commanded_error_mm()
}

#[test]
fn it_sags_under_2_kg_and_rises_when_compensated() {
    let mut simulation = Simulation::new().unwrap();
    assert_eq!(simulation.state(), State::Active);
    assert!(!simulation.compensated());
    simulation.hang(2.0);
    wait(&mut simulation, 3.0);
    let sag_mm = error_mm(&simulation);
    assert!((6.5..8.5).contains(&sag_mm), "{sag_mm}");
    let on = Command::Compensation(Compensation::Estimated);
    simulation.command(on, "compensation on");
    wait(&mut simulation, 4.0);
    assert!(simulation.compensated());
    assert!(error_mm(&simulation) < 0.2, "{}", error_mm(&simulation));
}

#[test]
fn a_cut_tendon_holds_the_leg_and_a_command_is_refused_with_the_remedy() {
    let mut simulation = Simulation::new().unwrap();
    simulation.set_defect(Defect::TendonCut(0), true);
    wait(&mut simulation, 0.5);
    assert_eq!(simulation.state(), State::Held);
    assert!(simulation.faults().has(Fault::TensionJump));
    simulation.command(Command::Move { x: 0.0, y: 0.0 }, "move");
    wait(&mut simulation, 0.1);
    let refusal = simulation.refusal().unwrap();
    assert!(refusal.starts_with("move refused: "), "{refusal}");
    simulation.repair();
    assert!(simulation.defects().is_empty());
}

#[test]
fn every_number_of_every_signal_is_kept() {
    let mut simulation = Simulation::new().unwrap();
    wait(&mut simulation, 0.5);
    let tensions = simulation.history.named("tensions_n").unwrap();
    let last = simulation.history.last(tensions);
    let reported = simulation.telemetry().unwrap().tensions_n;
    assert_eq!(last.len(), 3);
    for (kept, reported) in last.iter().zip(reported) {
        assert!((kept - reported).abs() < 5.0, "{kept} {reported}");
    }
    assert!(simulation.history.line(tensions, 0, 0.0).count() > 50);
}
