//! Set-points that ask for a pretension or a stiffness on the way.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_base::angles;
use leg_base::timed_path::{PathRow, TimedPath};
use leg_firmware::command::Command;
use leg_firmware::set_point::{StreamPart, StreamTension};
use leg_firmware::supervisor::State;
use leg_rig::control_settings;
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::EmulatedLeg;
use leg_sim::hosted_leg::HostedLeg;
use leg_sim::plant::Start;
use leg_sim::shadow::Shadow;

/// How soon before its time a point is sent, ticks.
const LEAD_TICKS: u32 = 1_200;

/// A circle of 20° in 5 s at 100 Hz, on which the leg is asked for 85 N from 1 s, for 80 N·m/rad from 3 s, and for 70 N from 5 s on.
fn circle() -> TimedPath {
    let row = |i: u32| {
        let time_s = f64::from(i) * 0.01;
        let tension = match i {
            100 => Some(StreamTension::Pretension(85.0)),
            300 => Some(StreamTension::Stiffness(80.0)),
            500 => Some(StreamTension::Pretension(70.0)),
            _ => None,
        };
        PathRow {
            tension,
            ..PathRow::from_angles(time_s, 72.0 * time_s, 20.0)
        }
    };
    TimedPath::new(&(0..=700).map(row).collect::<Vec<_>>())
}

/// A tick of the leg, and of its control law in f64.
fn step(leg: &mut HostedLeg, shadow: &mut Shadow) {
    let (taken, reply) = leg.tick().unwrap();
    shadow.tick(&taken.sensors, &taken.link, &reply);
}

/// Where the leg is before a change, and at the end, what was asked for is there; the tip is on its circle all the time.
#[test]
fn a_stream_changes_the_pretension_on_the_way() {
    let rig = RigFile::load(None).unwrap();
    let settings = control_settings::settings(&rig, &rig.gains, None);
    let mut points = circle().streamed(&settings).unwrap();
    points.reverse();
    let first = *points.last().unwrap();
    let [azimuth_deg, tilt_deg] = angles::angles_deg(first.motion.position);
    let start = Start::Held {
        azimuth_deg,
        tilt_deg,
        pretension_n: rig.pretension_n,
        payload_kg: 1.0,
    };
    let (leg, mut shadow) = EmulatedLeg::start_shadowed(&rig, &rig.plant, start, 1).unwrap();
    let mut leg = HostedLeg::new(leg, &rig, [0.0; 2], 1);
    while leg.state() != State::Disarmed {
        step(&mut leg, &mut shadow);
    }
    leg.send(&Command::Arm).unwrap();
    for _ in 0..8_000 {
        step(&mut leg, &mut shadow);
    }
    let now = leg.telemetry().unwrap().tick;
    let begin = now + LEAD_TICKS + (-first.time_s * 8000.0) as u32;
    let mut part = StreamPart::First;
    let mut farthest_mm = 0.0_f64;
    let mut seen = Vec::new();
    loop {
        let tick = leg.telemetry().unwrap().tick;
        while let Some(point) = points.last() {
            let is_last = points.len() == 1;
            let next = match (part, is_last) {
                (StreamPart::Next, true) => StreamPart::Last,
                (part, _) => part,
            };
            let set_point = point.set_point(begin, next);
            if set_point.tick.wrapping_sub(tick).cast_signed() > LEAD_TICKS.cast_signed() {
                break;
            }
            leg.send(&Command::Follow(set_point)).unwrap();
            part = StreamPart::Next;
            points.pop();
        }
        step(&mut leg, &mut shadow);
        let refused = leg.answers().iter().find(|answer| answer.result.is_err());
        assert!(refused.is_none(), "{refused:?}");
        let telemetry = *leg.telemetry().unwrap();
        assert_eq!(telemetry.state, State::Active, "{:?}", telemetry.faults);
        let time_s = f64::from(telemetry.tick.wrapping_sub(begin).cast_signed()) / 8000.0;
        farthest_mm = farthest_mm.max(leg.comparison().reference_error_mm());
        for at_s in [0.98, 2.98, 4.98, 6.98] {
            if (time_s - at_s).abs() < 0.5 / 8000.0 {
                let asked = (
                    telemetry.pretension_commanded_n,
                    telemetry.stiffness_commanded_nm_per_rad,
                );
                seen.push((
                    asked,
                    telemetry.pretension_n,
                    telemetry.stiffness_nm_per_rad,
                ));
            }
        }
        if points.is_empty() && !telemetry.moving {
            break;
        }
    }
    println!("{farthest_mm} mm; {seen:?}, {:?}", shadow.divergence);
    assert!(shadow.divergence.stays(), "{:?}", shadow.divergence);
    let [before, pulled, stiff, after] = seen[..] else {
        panic!("{seen:?}");
    };
    for ((asked, pretension_n, _), expected_n) in [(before, 70.0), (pulled, 85.0), (after, 70.0)] {
        assert_eq!(asked, (Some(expected_n), None));
        assert!((pretension_n - expected_n).abs() < 0.5, "{pretension_n} N");
    }
    let (asked, _, stiffness) = stiff;
    assert_eq!(asked, (None, Some(80.0)));
    assert!((stiffness - 80.0).abs() < 1.0, "{stiffness} N·m/rad");
    assert!(farthest_mm < 0.3, "{farthest_mm} mm off its reference");
}
