//! A leg that answers its host otherwise than the control law in f64 beside it.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::ready_runs::{run, scenario};
use super::station_stand::paper;
use leg_firmware::command::Command;
use leg_firmware::set_point::{SetPoint, StreamPart};
use leg_firmware::supervisor::State;
use leg_sim::emulated_leg::EmulatedLeg;
use leg_sim::hosted_leg::HostedLeg;
use leg_sim::link::InProcess;
use leg_sim::plant::Start;
use leg_sim::shadow::{Divergence, Shadow};

/// What becomes of a leg that does what it is asked for while its shadow, in the same tick, is asked for another thing under the same
/// number: neither changes state or faults.
fn asked(leg: &Command, shadow: &Command) -> Divergence {
    let rig = paper();
    let start = Start::hanging(rig.pretension_n);
    let (emulated, mut beside) = EmulatedLeg::start_shadowed(&rig, &rig.plant, start, 1).unwrap();
    let mut hosted: HostedLeg = HostedLeg::new(emulated, &rig, [0.0; 2], 1);
    let pass = |hosted: &mut HostedLeg, beside: &mut Shadow, ticks: u32| {
        for _ in 0..ticks {
            let (taken, reply) = hosted.tick().unwrap();
            beside.tick(&taken.sensors, &taken.link, &reply);
        }
    };
    pass(&mut hosted, &mut beside, 800);
    hosted.send(&Command::Arm).unwrap();
    pass(&mut hosted, &mut beside, 4_000);
    assert_eq!(hosted.state(), State::Active);
    assert!(beside.divergence.stays());
    let mut other = hosted.clone();
    let numbers = [hosted.send(leg).unwrap(), other.send(shadow).unwrap()];
    assert_eq!(numbers[0], numbers[1]);
    let (taken, reply) = hosted.tick().unwrap();
    let (other, _) = other.tick().unwrap();
    beside.tick(&taken.sensors, &other.link, &reply);
    pass(&mut hosted, &mut beside, 800);
    assert_eq!(hosted.state(), State::Active);
    beside.divergence
}

/// A set-point that is refused, for no stream has begun.
const REFUSED: Command = Command::Follow(SetPoint {
    part: StreamPart::Next,
    tick: 0,
    direction: [0.0; 2],
    rate: [0.0; 2],
    acceleration: None,
    tension: None,
});

/// State and faults alone do not show it: where one of the two is led on by a set-point that the other refuses, both may stay active.
#[test]
fn a_shadow_that_answers_otherwise_is_left() {
    for (leg, shadow, others) in [
        (Command::KeepAlive, Command::KeepAlive, 0),
        (REFUSED, REFUSED, 0),
        (Command::KeepAlive, REFUSED, 1),
        (REFUSED, Command::KeepAlive, 1),
    ] {
        let divergence = asked(&leg, &shadow);
        let what = format!("{leg:?}, {shadow:?}: {divergence:?}");
        assert_eq!(divergence.other_state, 0, "{what}");
        assert_eq!(divergence.other_answers, others, "{what}");
        assert_eq!(divergence.stays(), others == 0, "{what}");
        assert!(divergence.states_stay_within(0), "{what}");
    }
}

/// A run that is good but for that fails.
#[test]
fn a_run_whose_shadow_answers_otherwise_does_not_pass() {
    let mut summary = run(&scenario("hold"), &mut InProcess::new()).summary;
    assert!(summary.passes());
    summary.divergence.other_answers = 1;
    assert!(!summary.passes());
}
