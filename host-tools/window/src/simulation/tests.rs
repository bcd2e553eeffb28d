#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{Simulation, refused};
use crate::history::SAMPLE_HZ;
use leg_firmware::command::{Command, CommandRefusal, Compensation};
use leg_firmware::host_link::HostRefusal;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::supervisor::{Fault, State};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigText;
use leg_sim::emulated_leg::EmulationError;
use leg_sim::plant::Defect;
use leg_sim::signals::{REPORT_SIGNALS, SIMULATED_SIGNALS};

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
    assert!((7.0..7.5).contains(&sag_mm), "{sag_mm}");
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
}

#[test]
fn a_repair_ends_every_defect_of_the_simulated_leg() {
    let mut simulation = Simulation::new().unwrap();
    for defect in [
        Defect::TendonCut(0),
        Defect::EncoderLost(2),
        Defect::SupplySag,
    ] {
        simulation.set_defect(defect, true);
        let plant = simulation.leg().leg().plant();
        assert!(plant.defects().any(|other| other == defect));
    }
    simulation.set_defect(Defect::EncoderLost(2), false);
    assert!(!simulation.has(Defect::EncoderLost(2)));
    assert!(simulation.has(Defect::SupplySag));
    simulation.repair();
    assert_eq!(simulation.leg().leg().plant().defects().count(), 0);
}

/// Ticks until a sample has just been taken.
fn wait_for_sample(simulation: &mut Simulation) {
    let every = u64::from(u32::from(TICK_HZ) / SAMPLE_HZ);
    loop {
        simulation.tick();
        if simulation.leg().ticks().is_multiple_of(every) {
            return;
        }
    }
}

#[test]
fn every_number_of_every_signal_is_kept() {
    let mut simulation = Simulation::new().unwrap();
    simulation.hang(1.0);
    wait(&mut simulation, 0.5);
    wait_for_sample(&mut simulation);
    let snapshot = simulation.snapshot().unwrap();
    let mut expected = Vec::new();
    for signal in REPORT_SIGNALS {
        signal.numbers(&snapshot.report, &mut expected);
    }
    for signal in SIMULATED_SIGNALS {
        signal.numbers(snapshot.simulated.as_ref().unwrap(), &mut expected);
    }
    let history = &simulation.history;
    let mut expected = expected.into_iter();
    for column in history.columns() {
        let kept = history.last(*column);
        assert_eq!(kept.len(), column.width, "{}", column.name());
        for number in kept {
            let expected = expected.next().unwrap() as f32;
            assert_eq!(number.to_bits(), expected.to_bits(), "{}", column.name());
        }
    }
    assert_eq!(expected.next(), None);
    let tensions = history.named("tensions_n").unwrap();
    assert!(history.line(tensions, 0, 0.0).count() > 50);
}

fn is_near(a: [f64; 2], b: [f64; 2]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6)
}

/// A drag of the target and of a slider, one command of each in a frame.
fn drag(simulation: &mut Simulation, frames: u32) {
    for frame in 1..=frames {
        let x = 0.3 * frame as f32 / frames as f32;
        simulation.command(Command::Move { x, y: 0.1 }, "move");
        let pretension_n = 60.0 + frame as f32 / frames as f32;
        simulation.command(Command::Pretension(pretension_n), "pretension");
        simulation.advance(0.016);
    }
}

#[test]
fn a_drag_in_slow_time_ends_where_it_was_left() {
    for rate in [0.0, 0.001, 0.01, 0.1] {
        let mut simulation = Simulation::new().unwrap();
        simulation.pace.rate = rate;
        drag(&mut simulation, 100);
        let newest = [f64::from(0.3_f32), f64::from(0.1_f32)];
        assert!(is_near(simulation.target(), newest), "{rate}");
        simulation.pace.rate = 1.0;
        wait(&mut simulation, 0.1);
        assert_eq!(simulation.refusal(), None, "{rate}");
        assert_eq!(simulation.telemetry().unwrap().pretension_n, 61.0, "{rate}");
        wait(&mut simulation, 4.0);
        let reached = simulation.telemetry().unwrap().target.map(f64::from);
        assert!(is_near(reached, newest), "{rate}: {reached:?}");
    }
}

/// Sends a move behind so many other commands. Whether the board was too busy for it at first.
fn is_busy_for_a_move(simulation: &mut Simulation, others: u32) -> bool {
    let mut last = 0;
    for _ in 0..others {
        last = simulation.leg.send(&Command::Pretension(60.0)).unwrap();
    }
    simulation.command(Command::Move { x: 0.2, y: 0.0 }, "move");
    let mut busy = false;
    for _ in 0..TICK_HZ / 10 {
        simulation.tick();
        let mut answers = simulation.leg.answers().iter();
        busy |= answers
            .any(|answer| answer.number == last + 1 && answer.result == Err(HostRefusal::Busy));
    }
    busy
}

#[test]
fn a_busy_board_is_asked_again() {
    let mut busy = 0;
    for others in (8..40).step_by(3) {
        let mut simulation = Simulation::new().unwrap();
        busy += u32::from(is_busy_for_a_move(&mut simulation, others));
        assert_eq!(simulation.refusal(), None);
        wait(&mut simulation, 4.0);
        let reached = simulation.telemetry().unwrap().target.map(f64::from);
        assert!(is_near(reached, [f64::from(0.2_f32), 0.0]), "{others}");
    }
    assert!(busy > 0);
}

#[test]
fn a_refusal_has_the_words_of_the_refusal() {
    let command = refused("move", &HostRefusal::Command(CommandRefusal::Faulted));
    assert_eq!(
        command,
        "move refused: a fault is latched; remove its cause, then clear it"
    );
    let other = refused("arm", &HostRefusal::OtherHost);
    assert_eq!(other, "arm refused: another host drives the leg");
}

#[test]
fn a_refused_move_leaves_the_target_where_the_leg_has_it() {
    let mut simulation = Simulation::new().unwrap();
    simulation.command(Command::Stop, "stop");
    wait(&mut simulation, 0.5);
    assert_eq!(simulation.state(), State::Held);
    let held = simulation.target();
    simulation.command(Command::Move { x: -0.3, y: 0.0 }, "move");
    assert!(!is_near(simulation.target(), held));
    wait(&mut simulation, 0.1);
    assert!(simulation.refusal().is_some());
    assert!(is_near(simulation.target(), held));
}

#[test]
fn a_leg_that_is_disarmed_and_armed_again_has_its_target_where_it_is() {
    let mut simulation = Simulation::new().unwrap();
    let before = simulation.target();
    simulation.command(Command::Disarm, "disarm");
    wait(&mut simulation, 3.0);
    assert_eq!(simulation.state(), State::Disarmed);
    simulation.command(Command::Arm, "arm");
    wait(&mut simulation, 3.0);
    assert_eq!(
        simulation.state(),
        State::Active,
        "{:?}",
        simulation.refusal()
    );
    let armed = simulation.telemetry().unwrap().target.map(f64::from);
    assert!(is_near(simulation.target(), armed));
    assert!(!is_near(armed, before), "{armed:?}");
}

#[test]
fn a_stop_is_obeyed_before_what_waits() {
    let mut simulation = Simulation::new().unwrap();
    simulation.pace.rate = 0.0;
    drag(&mut simulation, 10);
    simulation.command(Command::Stop, "stop");
    simulation.command(Command::Stop, "stop");
    simulation.pace.rate = 1.0;
    wait(&mut simulation, 0.5);
    assert_eq!(simulation.state(), State::Held);
    simulation.command(Command::Clear, "clear");
    wait(&mut simulation, 0.2);
    assert_eq!(simulation.state(), State::Active);
}

#[test]
fn a_tenth_of_the_rate_is_a_tenth_of_the_time() {
    let mut simulation = Simulation::new().unwrap();
    let start_s = simulation.leg().time_s();
    simulation.pace.rate = 0.1;
    wait(&mut simulation, 2.0);
    let passed_s = simulation.leg().time_s() - start_s;
    assert!((passed_s - 0.2).abs() < 1e-3, "{passed_s}");
}

#[test]
fn a_leg_whose_numbers_are_lost_stands_still_and_says_so() {
    let mut simulation = Simulation::new().unwrap();
    let failed_s = simulation.leg().time_s();
    simulation.take_tick(Err(EmulationError::NotFinite(failed_s)));
    let failure = simulation.failure().unwrap().to_string();
    assert!(failure.contains("no finite place"), "{failure}");
    drag(&mut simulation, 10);
    assert_eq!(simulation.leg().time_s(), failed_s);
}

#[test]
fn every_ready_rig_becomes_a_leg_that_follows_commands() {
    for rig in READY_RIGS {
        let source = RigText {
            name: rig.name.into(),
            text: rig.text.into(),
        };
        let simulation = Simulation::with_rig_file(source).unwrap();
        assert_eq!(simulation.state(), State::Active, "{}", rig.name);
        assert_eq!(simulation.refusal(), None, "{}", rig.name);
        // It sags under its own weight: compensation is off.
        assert!(
            error_mm(&simulation) < 5.0,
            "{}: {}",
            rig.name,
            error_mm(&simulation)
        );
        assert_eq!(simulation.rig().support_name, rig.support);
    }
}

#[test]
fn a_rig_that_is_refused_gives_no_leg_and_says_why() {
    let source = |text: String| RigText {
        name: "mine.toml".into(),
        text,
    };
    let bad = READY_RIGS[0].text.replace("tilt_deg = 30", "tilt_deg = 80");
    let words = Simulation::with_rig_file(source(bad))
        .err()
        .unwrap()
        .to_string();
    assert!(
        words.contains("mine.toml:") && words.contains("help: "),
        "{words}"
    );
    let small = READY_RIGS[0].text.replace("tilt_deg = 30", "tilt_deg = 10");
    let simulation = Simulation::with_rig_file(source(small)).unwrap();
    assert_eq!(
        (simulation.state(), simulation.refusal()),
        (State::Active, None)
    );
}
