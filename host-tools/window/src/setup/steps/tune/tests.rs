#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{Outcome, Rigs, Tune, TuneStep};
use crate::live_leg::tests::leg;
use crate::setup::editor::Editor;
use crate::shown_leg::ShownLeg;
use crate::simulation::Simulation;
use leg_firmware::command::Command;
use leg_firmware::supervisor::State;
use leg_rig::actuator::ACTUATOR;
use leg_sim::plant::Defect;

/// A disarmed leg, and the measurement of a motor that has begun.
fn begun(swings: bool) -> (ShownLeg, Tune) {
    begun_with(swings, &[])
}

/// The same beside settings in which some are changed.
fn begun_with(swings: bool, changes: &[(&str, &str)]) -> (ShownLeg, Tune) {
    let mut leg = ShownLeg::Simulated(Box::new(Simulation::new().unwrap()));
    leg.command(Command::Disarm, "disarm");
    while leg.state() != State::Disarmed {
        leg.advance(0.02, 0.0);
    }
    for _ in 0..50 {
        leg.advance(0.02, 0.0);
    }
    let mut tune = Tune {
        motor: 2,
        swings,
        ..Tune::default()
    };
    while tune.plan(&leg).is_none() {
        tune.ask_supply(&mut leg);
        leg.advance(0.02, 0.0);
    }
    let mut editor = Editor::new(leg.source()).unwrap();
    for (key, value) in changes {
        assert!(editor.set(ACTUATOR, key, value), "{:?}", editor.refused());
    }
    tune.start(&leg, editor.rig());
    (leg, tune)
}

/// Goes on for some seconds of the leg, or until it is measured.
fn go_on(leg: &mut ShownLeg, tune: &mut Tune, for_s: f64) -> Option<Outcome> {
    let until_s = leg.time_s() + for_s;
    while leg.time_s() < until_s {
        leg.advance_watched(0.02, 0.0, &mut |leg| tune.look(leg));
        if let TuneStep::Done(outcome) = tune.step() {
            return Some(outcome.clone());
        }
    }
    None
}

#[test]
fn a_motor_and_the_swing_are_what_the_simulated_leg_has() {
    let (mut leg, mut tune) = begun(true);
    let outcome = go_on(&mut leg, &mut tune, 400.0).unwrap();
    println!(
        "{:.1} s; {}",
        leg.time_s(),
        leg_rig::tune::table(&outcome.rows)
    );
    assert_eq!((outcome.failure, outcome.servo_finding), (None, None));
    for (name, within) in [
        ("resistance_ohm", 0.05),
        ("servo, phase margin", 0.05),
        ("backlash_rad, motor 1", 0.3),
        ("leg_transverse_inertia_kg_m2", 0.1),
    ] {
        let row = outcome.rows.iter().find(|row| row.name == name).unwrap();
        let off = row.measured.value / row.configured.unwrap() - 1.0;
        assert!(off.abs() < within, "{row:?}");
        assert!(row.measured.uncertainty > 0.0, "{row:?}");
    }
    for _ in 0..20 {
        leg.advance(0.02, 0.0);
    }
    assert_eq!(leg.state(), State::Held);
}

/// Settings of the page that the simulated leg does not run with change no result.
#[test]
fn a_simulated_leg_is_compared_with_what_it_runs_with() {
    let measured = |changes: &[(&str, &str)]| {
        let (mut leg, mut tune) = begun_with(false, changes);
        let outcome = go_on(&mut leg, &mut tune, 400.0).unwrap();
        assert_eq!(outcome.failure, None);
        outcome.rows
    };
    assert_eq!(measured(&[]), measured(&[("gear_ratio", "8.8")]));
}

#[test]
fn a_live_leg_is_compared_with_the_motor_of_the_page_and_its_own_gains() {
    let (live, _server) = leg();
    let live = ShownLeg::Live(Box::new(live));
    let mut editor = Editor::new(live.source()).unwrap();
    assert!(editor.set(ACTUATOR, "gear_ratio", "8.8"));
    assert!(
        editor.set("control.servo", "position_gain_per_s", "100"),
        "{:?}",
        editor.refused()
    );
    let rigs = Rigs::new(&live, editor.rig());
    assert_eq!(rigs.of_leg, *live.rig());
    assert_eq!(rigs.compared.actuators, editor.rig().actuators);
    assert_ne!(rigs.compared.actuators, rigs.of_leg.actuators);
    assert_eq!(rigs.compared.gains, rigs.of_leg.gains);
    assert_ne!(rigs.compared.gains, editor.rig().gains);
}

#[test]
fn a_fault_ends_it_and_is_named() {
    let (mut leg, mut tune) = begun(false);
    assert_eq!(go_on(&mut leg, &mut tune, 2.0), None);
    let simulation = leg.simulated_mut().unwrap();
    simulation.set_defect(Defect::SupplySag, true);
    let outcome = go_on(&mut leg, &mut tune, 30.0).unwrap();
    let words = outcome.failure.unwrap();
    assert!(
        words.contains("supply") && words.contains("help: "),
        "{words}"
    );
    assert!(outcome.rows.is_empty() && !leg.state().driven());
}

#[test]
fn a_stop_ends_it_at_any_time() {
    let (mut leg, mut tune) = begun(false);
    assert_eq!(go_on(&mut leg, &mut tune, 2.0), None);
    leg.command(Command::Stop, "stop");
    let outcome = go_on(&mut leg, &mut tune, 5.0).unwrap();
    let words = outcome.failure.unwrap();
    assert!(words.contains("stopped"), "{words}");
    assert!(!leg.state().driven());
}
