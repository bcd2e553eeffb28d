//! A leg that leaves its load out.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::{armed, pass};
use crate::common::require_said;
use leg_bench::stand::{Stand, move_to};
use leg_firmware::command::{Command, Compensation};
use leg_firmware::supervisor::{Fault, State};
use leg_rig::rig_file::RigFile;

fn rig(name: &str) -> RigFile {
    RigFile::load(Some(name.as_ref())).unwrap()
}

/// How far the tip goes at most in a time, s, and the highest tension, mm and N.
fn excursion(stand: &mut Stand, time_s: f64) -> [f64; 2] {
    let (home_m, mut largest) = (stand.truth.tip_m, [0.0_f64; 2]);
    let end_s = stand.time_s() + time_s;
    while stand.time_s() < end_s {
        pass(stand, 1.3e-4);
        let tip_mm = (stand.truth.tip_m - home_m).norm() * 1e3;
        let highest_n = stand.truth.tensions_n.into_iter().fold(0.0, f64::max);
        largest = [largest[0].max(tip_mm), largest[1].max(highest_n)];
    }
    largest
}

/// It sags by millimetres. If its target began where it points, it would sag by as much once more, and swing. One rig for each
/// kind of support.
#[test]
fn a_leg_that_leaves_its_load_out_stays_where_it_is_when_it_goes_on() {
    for name in ["table1", "spherical", "universal", "leaf_spring_universal"] {
        let mut stand = armed(&rig(name), [50.0, 22.0], 1.0, 3);
        let held_mm = stand.truth.tip_m;
        stand
            .command(&Command::Compensation(Compensation::Off))
            .unwrap();
        stand.wait(2.0).unwrap();
        let sag_mm = (stand.truth.tip_m - held_mm).norm() * 1e3;
        assert!(sag_mm > 1.5, "{name}: it cannot fail, {sag_mm} mm");
        stand.command(&Command::Stop).unwrap();
        stand.wait(0.3).unwrap();
        assert_eq!(stand.state(), State::Held);
        let before_n = stand.truth.tensions_n.into_iter().fold(0.0, f64::max);
        stand.command(&Command::Clear).unwrap();
        let [tip_mm, highest_n] = excursion(&mut stand, 1.0);
        assert_eq!(stand.state(), State::Active);
        assert!(stand.faults() == leg_firmware::supervisor::FaultSet::NONE);
        assert!(tip_mm < 0.15, "{name}: {tip_mm} mm");
        assert!(highest_n < before_n + 3.0, "{name}: {highest_n} N");
    }
}

/// The same, but a payload that was hung on it took a tendon's tension. Cleared, it sags where that hardly pulls: there is no pose of a leg without its
/// load that has such lengths.
#[test]
fn a_held_leg_with_a_slack_tendon_that_leaves_its_load_out_sags() {
    const SAGS_MM: f64 = 15.0;
    require_said(
        "firmware/SAFETY.md",
        &[format!(
            "With its load left out it may sag by up to {SAGS_MM} mm"
        )],
    );
    let mut farthest_mm = 0.0_f64;
    for ([pretension_n, tilt_deg], sags) in [([20.0, 15.0], true), ([40.0, 28.0], false)] {
        for payload_kg in [1.7, 2.0] {
            let mut stand = armed(&rig("table1"), [40.0, tilt_deg], 1.0, 82);
            for command in [
                Command::Pretension(pretension_n as f32),
                Command::Compensation(Compensation::Off),
                Command::Stop,
            ] {
                stand.command(&command).unwrap();
                pass(&mut stand, 2.0);
            }
            stand.plant().set_payload(payload_kg, 1.0);
            pass(&mut stand, 3.0);
            assert_eq!(stand.state(), State::Held);
            stand.command(&Command::Clear).unwrap();
            let [tip_mm, highest_n] = excursion(&mut stand, 4.0);
            println!(
                "{pretension_n} N, {tilt_deg}°, {payload_kg} kg: {tip_mm:.2} mm, {highest_n:.0} N"
            );
            assert!(highest_n < 150.0, "{highest_n} N");
            if sags {
                assert!(stand.state() == State::Held && stand.faults().has(Fault::Slack));
            } else {
                assert!(
                    stand.state() == State::Active && tip_mm < 0.3,
                    "{tip_mm} mm"
                );
            }
            farthest_mm = farthest_mm.max(tip_mm);
        }
    }
    let range_mm = 0.5 * SAGS_MM..SAGS_MM;
    assert!(range_mm.contains(&farthest_mm), "{farthest_mm} mm");
}

/// Its load keeps a tendon below the minimum tension: while the leg waited for that, it was held by "slack tendon" 5 s after it went on.
#[test]
fn a_tendon_that_its_load_keeps_below_the_minimum_is_not_slack() {
    let rig = rig("table1");
    let mut stand = armed(&rig, [50.0, 22.0], 0.7, 3);
    let compensation = Command::Compensation(Compensation::Off);
    stand.command(&compensation).unwrap();
    let lowest_n = |stand: &Stand| stand.truth.tensions_n.into_iter().fold(f64::MAX, f64::min);
    let mut pretension_n = rig.pretension_n;
    while lowest_n(&stand) > 0.8 * rig.f_min_n {
        pretension_n -= 2.0;
        let pretension = Command::Pretension(pretension_n as f32);
        stand.command(&pretension).unwrap();
        stand.wait(0.6).unwrap();
    }
    stand.command(&Command::Stop).unwrap();
    stand.wait(0.3).unwrap();
    stand.command(&Command::Clear).unwrap();
    stand.wait(6.0).unwrap();
    let lowest_n = lowest_n(&stand);
    assert!(
        (0.5 * rig.f_min_n..rig.f_min_n).contains(&lowest_n),
        "{lowest_n}"
    );
    assert_eq!(stand.state(), State::Active);
    stand.require_no_fault().unwrap();
}

/// A command that comes at once is not lost: it goes on from where the leg is.
#[test]
fn it_goes_where_it_is_led_at_once() {
    let mut stand = armed(&rig("table1"), [50.0, 22.0], 1.0, 3);
    stand
        .command(&Command::Compensation(Compensation::Off))
        .unwrap();
    stand.wait(1.5).unwrap();
    stand.command(&Command::Stop).unwrap();
    stand.wait(0.3).unwrap();
    stand.command(&Command::Clear).unwrap();
    stand.command(&move_to([50.0, 5.0])).unwrap();
    stand.wait(2.0).unwrap();
    let [x, y] = stand.telemetry.unwrap().target;
    let tilt_deg = x.hypot(y).asin().to_degrees();
    assert!((tilt_deg - 5.0).abs() < 0.01, "{tilt_deg}°");
}

/// A load that takes a tendon to the maximum tension: without an estimate the leg would sink the farther the more it pays out, and is held
/// by its name. With one it goes on: its tendons are led to other tensions.
#[test]
fn it_gives_way_to_the_maximum_tension_no_farther_than_it_says() {
    const FARTHEST_MM: f32 = 0.1;
    let words = format!(
        "by {FARTHEST_MM} mm of a tendon at the most until it is held: **motor stays behind**"
    );
    require_said("firmware/SAFETY.md", &[words]);
    // Each tendon is the one that comes to the maximum.
    for (compensation, azimuth_deg) in [
        (Compensation::Off, 90.0),
        (Compensation::Off, 210.0),
        (Compensation::Off, 330.0),
        (Compensation::Frozen, 90.0),
        (Compensation::Frozen, 210.0),
        (Compensation::Frozen, 330.0),
        (Compensation::Estimated, 90.0),
    ] {
        let mut rig = rig("table1");
        rig.pretension_n = 110.0;
        let mut stand = armed(&rig, [azimuth_deg, 25.0], 0.0, 3);
        stand.command(&Command::Compensation(compensation)).unwrap();
        stand.wait(1.0).unwrap();
        stand.plant().set_payload(2.0, 2.0);
        let pulled_m = stand.telemetry.unwrap().pulled_m;
        pass(&mut stand, 3.0);
        let now_m = stand.telemetry.unwrap().pulled_m;
        let paid_out_m = now_m.into_iter().zip(pulled_m);
        let farthest_m = paid_out_m.fold(0.0_f32, |most, (now, before)| most.max(before - now));
        let highest_n = stand.truth.tensions_n.into_iter().fold(0.0, f64::max);
        println!(
            "{compensation:?}: {:?}, {farthest_m} m, {highest_n} N",
            stand.state()
        );
        if compensation == Compensation::Estimated {
            assert_eq!(stand.state(), State::Active);
            assert!(!stand.faults().any());
        } else {
            assert_eq!(stand.state(), State::Held);
            assert!(stand.faults().has(Fault::Following));
            assert!(farthest_m < 1e-3 * FARTHEST_MM, "{farthest_m} m");
        }
    }
}

/// What trimmed the pretension stays: it was dropped at once, and the tensions stepped by newtons. Straight down there is no load to be left out.
#[test]
fn a_trim_stays_where_the_load_is_left_out() {
    for compensation in [Compensation::Off, Compensation::Frozen] {
        let mut rig = rig("table1");
        rig.plant.curve_error = 0.02;
        let mut stand = armed(&rig, [0.0, 0.0], 0.0, 3);
        let [asked_n, before_n] = [rig.pretension_n, stand.truth.tensions_n[0]];
        assert!((before_n - asked_n).abs() < 1.0, "{before_n} N");
        stand.command(&Command::Compensation(compensation)).unwrap();
        let mut changed_n = 0.0_f64;
        for _ in 0..1000 {
            pass(&mut stand, 1e-3);
            let tensions_n = stand.truth.tensions_n;
            changed_n = tensions_n
                .into_iter()
                .fold(changed_n, |most, n| most.max((n - before_n).abs()));
        }
        assert!(changed_n < 0.5, "{compensation:?}: {changed_n} N");
    }
}
