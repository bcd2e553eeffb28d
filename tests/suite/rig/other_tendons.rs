//! Legs whose tendons stretch far less or far more than the paper's: what is derived from that.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::other_legs::with_stiffness;
use leg_bench::stand::Stand;
use leg_firmware::command::Command;
use leg_firmware::supervisor::State;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_sim::plant::Start;

/// The paper's rig with tendons of one stiffness, N/m.
fn rig(n_per_m: f64) -> RigFile {
    RigFile::parse("tendons", &with_stiffness(READY_RIGS[0].text, n_per_m)).unwrap()
}

/// Waits for a state, and gives the highest true tension until then, N.
fn highest_until(stand: &mut Stand, state: State, longest_s: f64) -> f64 {
    let until_s = stand.time_s() + longest_s;
    let mut highest_n = 0.0_f64;
    while stand.state() != state {
        stand.tick().unwrap();
        highest_n = stand.truth.tensions_n.into_iter().fold(highest_n, f64::max);
        assert!(
            stand.time_s() < until_s,
            "{:?}, {:?}",
            stand.state(),
            stand.faults()
        );
    }
    highest_n
}

#[test]
fn stiff_tendons_are_homed_below_the_ceiling() {
    for n_per_m in [1e5, 3e5, 6e5, 1e6] {
        let rig = rig(n_per_m);
        let homing = &rig.gains.homing;
        let mut stand = Stand::new(&rig, &rig.plant, Start::Slack { slack_mm: 2.0 }, 1).unwrap();
        stand.wait(0.2).unwrap();
        stand.command(&Command::Home).unwrap();
        stand.wait(0.1).unwrap();
        let highest_n = highest_until(&mut stand, State::Active, 40.0);
        println!(
            "{n_per_m} N/m: {} m/s, {highest_n:.1} N",
            homing.speed_m_per_s
        );
        assert!(
            highest_n < f64::from(homing.f_max_n),
            "{n_per_m} N/m: {highest_n} N"
        );
        assert!(!stand.faults().any(), "{:?}", stand.faults());
    }
}

/// A leg whose drivers are off has no taut tendon, however far it stretched.
#[test]
fn soft_tendons_are_slack_after_a_disarm() {
    for n_per_m in [9_945.0, 2e4] {
        let rig = rig(n_per_m);
        let start = Start::hanging(rig.f_max_n - 5.0);
        let mut stand = Stand::new(&rig, &rig.plant, start, 1).unwrap();
        stand.wait(0.2).unwrap();
        stand.command(&Command::Arm).unwrap();
        stand.wait(0.5).unwrap();
        stand
            .command(&Command::Pretension(rig.f_max_n as f32 - 5.0))
            .unwrap();
        stand.wait(3.0).unwrap();
        stand.command(&Command::Disarm).unwrap();
        stand.wait(0.1).unwrap();
        let _ = highest_until(&mut stand, State::Disarmed, 20.0);
        stand.wait(0.2).unwrap();
        let [a, b, c] = stand.truth.tensions_n;
        assert!(
            a.max(b).max(c) < 1.0,
            "{n_per_m} N/m: {:?}",
            stand.truth.tensions_n
        );
    }
}
