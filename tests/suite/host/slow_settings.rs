//! A leg whose settings are slow is waited for until it is where it was commanded.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_host::cancel_flag::CancelFlag;
use leg_host::operator::{Goal, HostIdentity, Operator, Tensioning};
use leg_host::transport::emulated::EmulatedLine;
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::{EmulatedLeg, InitialState};
use leg_sim::link::InProcess;

/// A homed leg, with some gains of its own.
fn leg(gains: &str) -> Operator {
    let text = format!(
        "{}\n{gains}",
        include_str!("../../../host-tools/rigs/table1.toml")
    );
    let rig = RigFile::parse("slow.toml", &text).unwrap();
    let link = Box::new(InProcess::new());
    let leg = EmulatedLeg::new(&rig, InitialState::Homed, link).unwrap();
    let line = EmulatedLine::new(leg, "the leg");
    let host = Box::new(line.connect());
    Operator::open(host, HostIdentity::FIXED, CancelFlag::default()).unwrap()
}

fn goal(tilt_deg: f32, tensioning: Option<Tensioning>) -> Goal {
    Goal {
        tensioning,
        direction: Some([tilt_deg.to_radians().sin(), 0.0]),
    }
}

/// Its tensions follow a pretension that is on its way as close as one at rest.
#[test]
fn a_pretension_that_rises_slowly_is_waited_for() {
    for (rate_n_per_s, to_n) in [(5.0, 110.0), (1.0, 80.0), (0.1, 72.0)] {
        let mut operator = leg(&format!(
            "[control.motion]\npretension_rate_n_per_s = {rate_n_per_s}"
        ));
        let tensioning = Some(Tensioning::Pretension(to_n));
        let telemetry = operator.reach(&goal(10.0, tensioning)).unwrap();
        println!("{rate_n_per_s} N/s: {} N", telemetry.pretension_n);
        assert!((telemetry.pretension_n - to_n).abs() < 0.01);
    }
    let stiff = goal(
        0.0,
        Some(Tensioning::Stiffness {
            demand_nm_per_rad: 110.0,
            towards: None,
        }),
    );
    let slow = leg("[control.motion]\npretension_rate_n_per_s = 2").reach(&stiff);
    let [slow_n, fast_n] =
        [slow, leg("").reach(&stiff)].map(|telemetry| telemetry.unwrap().pretension_n);
    println!("{slow_n} N and {fast_n} N");
    assert!((slow_n - fast_n).abs() < 0.05);
}

/// From 20° on one side to 20° on the other takes 70 s at the lowest speed.
#[test]
fn a_move_and_a_homing_that_take_longer_than_usual_are_waited_for() {
    let mut operator = leg("[control.motion]\nspeed_rad_per_s = 0.01");
    operator.reach(&goal(20.0, None)).unwrap();
    let begun = operator.now();
    operator.reach(&goal(-20.0, None)).unwrap();
    assert!((operator.now() - begun).as_secs_f64() > 65.0);
    let mut operator = leg("[control.homing]\nsettle_time_s = 40\naverage_time_s = 40");
    let begun = operator.now();
    operator.home().unwrap();
    let homing_s = (operator.now() - begun).as_secs_f64();
    println!("homed in {homing_s} s");
    assert!(homing_s > 125.0);
}
