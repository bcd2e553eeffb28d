//! Set-points that ask for a pretension or a stiffness on the way.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_base::angles;
use leg_base::timed_path::{PathRow, TimedPath, TimedPoint};
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

/// A leg at rest where a path begins, and the points of that path.
struct Streaming {
    leg: HostedLeg,
    shadow: Shadow,
    /// The last one first.
    points: Vec<TimedPoint>,
    part: StreamPart,
    /// The tick in which the path begins.
    begin: u32,
}

impl Streaming {
    fn new(path: &TimedPath) -> Self {
        let mut rig = RigFile::load(None).unwrap();
        // Homing has tared the cells.
        rig.plant.cell_offset_n = [0.0; 3];
        let settings = control_settings::settings(&rig, &rig.gains, None);
        let mut points = path.streamed(&settings).unwrap();
        points.reverse();
        let first = *points.last().unwrap();
        let [azimuth_deg, tilt_deg] = angles::angles_deg(first.motion.position);
        let start = Start::Held {
            azimuth_deg,
            tilt_deg,
            pretension_n: rig.pretension_n,
            payload_kg: 1.0,
        };
        let (leg, shadow) = EmulatedLeg::start_shadowed(&rig, &rig.plant, start, 1).unwrap();
        let mut streaming = Self {
            leg: HostedLeg::new(leg, &rig, [0.0; 2], 1),
            shadow,
            points,
            part: StreamPart::First,
            begin: 0,
        };
        while streaming.leg.state() != State::Disarmed {
            streaming.step();
        }
        streaming.leg.send(&Command::Arm).unwrap();
        for _ in 0..8_000 {
            streaming.step();
        }
        let now = streaming.leg.telemetry().unwrap().tick;
        streaming.begin = now + LEAD_TICKS + (-first.time_s * 8000.0) as u32;
        streaming
    }

    /// A tick of the leg, and of its control law in f64.
    fn step(&mut self) {
        let (taken, reply) = self.leg.tick().unwrap();
        self.shadow.tick(&taken.sensors, &taken.link, &reply);
    }

    /// Sends what is due, and a tick. The time on the path, s; none at its end.
    fn follow(&mut self) -> Option<f64> {
        let tick = self.leg.telemetry().unwrap().tick;
        while let Some(point) = self.points.last() {
            let part = match (self.part, self.points.len()) {
                (StreamPart::Next, 1) => StreamPart::Last,
                (part, _) => part,
            };
            let set_point = point.set_point(self.begin, part);
            if set_point.tick.wrapping_sub(tick).cast_signed() > LEAD_TICKS.cast_signed() {
                break;
            }
            self.leg.send(&Command::Follow(set_point)).unwrap();
            self.part = StreamPart::Next;
            self.points.pop();
        }
        self.step();
        let refused = self.leg.answers().iter().find(|one| one.result.is_err());
        assert!(refused.is_none(), "{refused:?}");
        let telemetry = self.leg.telemetry().unwrap();
        assert_eq!(telemetry.state, State::Active, "{:?}", telemetry.faults);
        if self.points.is_empty() && !telemetry.moving {
            return None;
        }
        let ticks = telemetry.tick.wrapping_sub(self.begin).cast_signed();
        Some(f64::from(ticks) / 8000.0)
    }
}

/// Where the leg is before a change, and at the end, what was asked for is there; the tip is on its circle all the time.
#[test]
fn a_stream_changes_the_pretension_on_the_way() {
    let mut streaming = Streaming::new(&circle());
    let mut farthest_mm = 0.0_f64;
    let mut seen = Vec::new();
    while let Some(time_s) = streaming.follow() {
        let comparison = streaming.leg.comparison();
        farthest_mm = farthest_mm.max(comparison.reference_error_mm());
        let telemetry = streaming.leg.telemetry().unwrap();
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
    }
    let divergence = &streaming.shadow.divergence;
    println!("{farthest_mm} mm; {seen:?}, {divergence:?}");
    assert!(divergence.stays(), "{divergence:?}");
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

/// What is asked for at once is reached at the rate of a command, and no tension is beyond its limits: from 70 N to 150 N, to 0 N, to a stiffness
/// that no pretension gives, and back.
#[test]
fn a_stream_changes_the_pretension_at_its_rate_and_between_the_limits() {
    const SPAN: usize = 400;
    let rig = RigFile::load(None).unwrap();
    let rate_n_per_s = rig.gains.motion.pretension_rate_n_per_s;
    let row = |i: u32| {
        let time_s = f64::from(i) * 0.01;
        let tension = match i {
            100 => Some(StreamTension::Pretension(rig.f_max_n as f32)),
            250 => Some(StreamTension::Pretension(0.0)),
            450 => Some(StreamTension::Stiffness(500.0)),
            600 => Some(StreamTension::Pretension(70.0)),
            _ => None,
        };
        PathRow {
            tension,
            ..PathRow::from_angles(time_s, 45.0 * time_s, 20.0)
        }
    };
    let path = TimedPath::new(&(0..=800).map(row).collect::<Vec<_>>());
    let mut streaming = Streaming::new(&path);
    let mut pretensions_n = Vec::new();
    let mut range_n = [f64::INFINITY, 0.0_f64];
    while streaming.follow().is_some() {
        pretensions_n.push(streaming.leg.telemetry().unwrap().pretension_n);
        for tension_n in streaming.leg.truth().tensions_n {
            range_n = [range_n[0].min(tension_n), range_n[1].max(tension_n)];
        }
    }
    let spans = pretensions_n.iter().zip(&pretensions_n[SPAN..]);
    let changes_n = spans.map(|(before, now)| (now - before).abs());
    let fastest = changes_n.fold(0.0, f32::max) * 8000.0 / SPAN as f32;
    println!("{fastest} N/s, tensions {range_n:?} N");
    assert!(
        fastest > 0.95 * rate_n_per_s && fastest < 1.02 * rate_n_per_s,
        "{fastest} N/s"
    );
    assert!(
        range_n[0] > rig.f_min_n - 0.5 && range_n[0] < rig.f_min_n + 5.0,
        "{range_n:?}"
    );
    assert!(
        range_n[1] < rig.f_max_n + 0.5 && range_n[1] > rig.f_max_n - 5.0,
        "{range_n:?}"
    );
}
