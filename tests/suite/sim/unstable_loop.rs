//! A leg whose feedback is unstable: what its load cells show comes late and its brake drives the swing, its load is followed far too fast, or
//! it is far heavier than its settings say.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::{faults, paper, ticks};
use crate::common::require_said;
use leg_base::angles;
use leg_bench::stand::{Stand, move_to};
use leg_firmware::command::Command;
use leg_firmware::control::{MOVING_SWINGING_M, SWINGING_M};
use leg_firmware::sensors::{Sensors, TICK_HZ};
use leg_firmware::set_point::{SetPoint, StreamPart};
use leg_firmware::supervisor::{Fault, FaultSet, State};
use leg_rig::plant_settings::PlantSettings;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::SignalChange;
use leg_sim::plant::Start;
use nalgebra::Vector3;
use std::collections::VecDeque;

/// Load cells that show what was so many ticks ago.
#[derive(Clone, Default)]
struct LateCells {
    ticks: usize,
    codes: VecDeque<[u16; 3]>,
}

/// As many codes are kept.
const KEPT: usize = 2_000;

impl SignalChange for LateCells {
    fn sensors(&mut self, sensors: &mut Sensors) {
        self.codes.push_front(sensors.cell_codes);
        self.codes.truncate(KEPT);
        sensors.cell_codes = self.codes[self.ticks.min(self.codes.len() - 1)];
    }
}

/// What a leg does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Activity {
    Resting,
    KeepingStation,
    /// It follows a stream of points that all lie where it is.
    Streaming,
}

/// Poses, azimuth and tilt in degrees, and payloads, kg.
const POSES: [([f64; 2], f64); 3] = [([233.0, 20.0], 1.3), ([30.0, 10.0], 0.5), ([0.0, 0.0], 2.0)];

const SEED: u64 = 5;

/// The push by which a swing begins: a brake that rests leaves what is below its dead band as it is.
const PUSH_N: f64 = 2.0;

/// Ticks between two set-points, and from one to its time.
const POINT_TICKS: u64 = 160;
const AHEAD_TICKS: u32 = 4_000;

/// A leg at rest.
#[derive(Clone)]
struct Leg {
    stand: Stand,
    cells: LateCells,
    pose_deg: [f64; 2],
    streams: bool,
    ticks: u64,
}

/// What becomes of its swing.
#[derive(Clone, Copy, Debug)]
struct Swing {
    /// When it was no longer let do what it did, s.
    after_s: Option<f64>,
    /// From farthest to farthest until then, and in the last second of that, mm.
    largest_mm: f64,
    last_mm: f64,
    /// What it does a second after that, and its faults.
    state: State,
    faults: FaultSet,
}

/// From farthest to farthest, mm: the one that is farthest from the first, and the one that is farthest from that.
fn spread_mm(tips_m: &[Vector3<f64>]) -> f64 {
    let farthest = |from: Vector3<f64>| {
        let away = tips_m.iter().map(|tip_m| (tip_m - from, *tip_m));
        let by = |a: &(Vector3<f64>, _), b: &(Vector3<f64>, _)| a.0.norm().total_cmp(&b.0.norm());
        away.max_by(by).unwrap()
    };
    let (_, one) = farthest(tips_m[0]);
    farthest(one).0.norm() * 1e3
}

impl Leg {
    /// A leg with these settings, which is another one.
    fn new(rig: &RigFile, plant: &PlantSettings, pose: ([f64; 2], f64)) -> Self {
        let (pose_deg @ [azimuth_deg, tilt_deg], payload_kg) = pose;
        let start = Start::Held {
            azimuth_deg,
            tilt_deg,
            pretension_n: rig.pretension_n,
            payload_kg,
        };
        // At the limit of a fault the control law in f64 comes to it a little sooner or later.
        let stand = Stand::unjudged(rig, plant, start, SEED).unwrap();
        let mut leg = Self {
            stand,
            cells: LateCells::default(),
            pose_deg,
            streams: false,
            ticks: 0,
        };
        leg.pass(0.1);
        leg.stand.command(&Command::Arm).unwrap();
        leg.pass(0.4);
        leg.stand.command(&move_to(pose_deg)).unwrap();
        leg.pass(2.5);
        assert_eq!(leg.stand.state(), State::Active);
        leg
    }

    fn paper(pose: ([f64; 2], f64)) -> Self {
        Self::new(&paper(), &paper().plant, pose)
    }

    fn tick(&mut self) {
        if self.streams && self.ticks.is_multiple_of(POINT_TICKS) {
            self.send_point(StreamPart::Next);
        }
        self.ticks += 1;
        self.stand.tick_through(&mut self.cells).unwrap();
    }

    fn pass(&mut self, time_s: f64) {
        for _ in 0..ticks(time_s) {
            self.tick();
        }
    }

    /// Sends a point where it is.
    fn send_point(&mut self, part: StreamPart) {
        let [azimuth_deg, tilt_deg] = self.pose_deg;
        let point = SetPoint {
            part,
            tick: self.stand.telemetry.unwrap().tick + AHEAD_TICKS,
            direction: angles::direction(azimuth_deg, tilt_deg).map(|along| along as f32),
            rate: [0.0; 2],
            acceleration: Some([0.0; 2]),
            tension: None,
        };
        self.stand.command(&Command::Follow(point)).unwrap();
    }

    fn begin(&mut self, activity: Activity) {
        match activity {
            Activity::Resting => {}
            Activity::KeepingStation => {
                self.stand.command(&Command::KeepStation).unwrap();
                self.pass(0.01);
                self.stand.silence();
                self.pass(0.5);
                assert_eq!(self.stand.state(), State::KeepingStation);
            }
            Activity::Streaming => {
                self.send_point(StreamPart::First);
                self.ticks = 1;
                self.streams = true;
                self.pass(0.6);
                assert!(self.stand.moving());
            }
        }
    }

    /// Pushes the leg, whose cells are so many ticks late from then on.
    fn push(&mut self, late_ticks: usize) {
        self.cells.ticks = late_ticks;
        let plant = self.stand.plant();
        plant.push(plant.transverse(60.0) * PUSH_N, 0.1, 0.0);
    }

    /// Watches it for a time, or until it is no longer let do what it does.
    fn watch(&mut self, time_s: f64) -> Swing {
        let (state, mut tips_m) = (self.stand.state(), Vec::new());
        let mut after_s = None;
        for tick in 0..ticks(time_s) {
            self.tick();
            tips_m.push(self.stand.truth.tip_m);
            if self.stand.state() != state {
                after_s = Some(tick as f64 / f64::from(TICK_HZ));
                self.pass(1.0);
                break;
            }
        }
        let last = tips_m.len().saturating_sub(ticks(1.0) as usize);
        Swing {
            after_s,
            largest_mm: spread_mm(&tips_m),
            last_mm: spread_mm(&tips_m[last..]),
            state: self.stand.state(),
            faults: faults(&self.stand),
        }
    }

    /// What becomes of it once its cells are late and it is pushed.
    fn swung(mut self, activity: Activity, late_ticks: usize, time_s: f64) -> Swing {
        self.begin(activity);
        self.push(late_ticks);
        self.watch(time_s)
    }
}

/// Named for its swing and for nothing else, in hold, within 2 s of when it begins, or sooner where it grows; at what the tip swings by then, mm,
/// from farthest to farthest.
fn require_held(what: &str, swing: &Swing) {
    require_held_by(what, swing, Fault::Swings);
}

/// The same, by this name.
fn require_held_by(what: &str, swing: &Swing, name: Fault) {
    const WITHIN_S: f64 = 2.0;
    const LARGEST_MM: f64 = 20.0;
    let said =
        format!("with **leg swings** within {WITHIN_S} s, with up to {LARGEST_MM} mm at the tip");
    require_said("firmware/SAFETY.md", &[said]);
    println!("{what}: {swing:.3?}");
    assert!(
        swing.after_s.is_some_and(|after_s| after_s < WITHIN_S),
        "{what}: {swing:?}"
    );
    assert_eq!(swing.state, State::Held, "{what}");
    assert_eq!(swing.faults, FaultSet::single(name), "{what}");
    assert!(swing.largest_mm < LARGEST_MM, "{what}: {swing:?}");
}

/// Cells that show what was 20 to 40 ms ago: the loop of the brake is beyond its phase margin, and the swing grows or stays. In one of these legs
/// late cells and counters disagree on the pose before the swing is named: both names are right.
#[test]
fn a_swing_that_late_load_cells_drive_ends_in_hold() {
    require_said(
        "firmware/SAFETY.md",
        &["with **sensors disagree on the pose** where late cells show that sooner".into()],
    );
    for (pose, late_ms) in POSES.into_iter().zip([
        [(20, Fault::Swings), (25, Fault::Residual)],
        [(25, Fault::Swings), (30, Fault::Swings)],
        [(37, Fault::Swings), (40, Fault::Swings)],
    ]) {
        let sound = Leg::paper(pose);
        for (ms, name) in late_ms {
            let swing = sound.clone().swung(Activity::Resting, 8 * ms, 4.0);
            require_held_by(&format!("{ms} ms late, {pose:?}"), &swing, name);
        }
        // With sound cells it rings down.
        let swing = sound.swung(Activity::Resting, 0, 3.0);
        assert!(swing.after_s.is_none() && swing.last_mm < 0.02, "{swing:?}");
    }
}

#[test]
fn a_swing_of_a_leg_that_keeps_station_ends_in_hold() {
    for (pose, ms) in POSES.into_iter().zip([20, 30, 40]) {
        let swing = Leg::paper(pose).swung(Activity::KeepingStation, 8 * ms, 4.0);
        require_held(&format!("{ms} ms late at station, {pose:?}"), &swing);
    }
}

/// A load that is followed two to four times as fast as it should be, without the brake; and a leg with eighteen times its inertia.
#[test]
fn a_swing_of_a_leg_with_wrong_settings_ends_in_hold() {
    for (pose, load_time_s) in POSES.into_iter().zip([0.08, 0.04, 0.08]) {
        let mut rig = paper();
        rig.gains.estimation.load_time_s = load_time_s;
        rig.gains.motion.damping_ratio = 0.0;
        let swing = Leg::new(&rig, &rig.plant, pose).swung(Activity::Resting, 0, 4.0);
        require_held(&format!("load time {load_time_s} s, {pose:?}"), &swing);
    }
    for pose in &POSES[..2] {
        let mut plant = paper().plant;
        plant.leg_transverse_inertia_kg_m2 = Some(0.3);
        let swing = Leg::new(&paper(), &plant, *pose).swung(Activity::Resting, 0, 4.0);
        require_held(&format!("0.3 kg·m², {pose:?}"), &swing);
    }
}

/// A swing that grows faster takes a tendon to the maximum tension before it is named: **too much tension** ramps the leg down, which is no
/// hold.
#[test]
fn a_swing_that_grows_faster_ends_by_the_maximum_tension() {
    const LATE_MS: usize = 60;
    const LARGEST_MM: f64 = 25.0;
    let said = format!("ramps the leg down within 1 s, with up to {LARGEST_MM} mm");
    require_said("firmware/SAFETY.md", &[said]);
    let mut ramped_down = 0;
    for pose in POSES {
        for activity in [
            Activity::Resting,
            Activity::KeepingStation,
            Activity::Streaming,
        ] {
            let swing = Leg::paper(pose).swung(activity, 8 * LATE_MS, 4.0);
            println!("{LATE_MS} ms late, {activity:?}, {pose:?}: {swing:.3?}");
            assert!(
                swing.after_s.is_some_and(|after_s| after_s < 1.0),
                "{swing:?}"
            );
            if swing.faults.has(Fault::OverTension) {
                assert!(matches!(swing.state, State::RampingDown | State::Disarmed));
                ramped_down += 1;
            } else {
                assert!(swing.faults.has(Fault::Swings), "{swing:?}");
                assert_eq!(swing.state, State::Held, "{swing:?}");
            }
            assert!(swing.largest_mm < LARGEST_MM, "{swing:?}");
        }
    }
    assert!(ramped_down > 0, "every leg was held");
}

/// At the edge a swing rings down slowly, or stays small: the largest that lasts and is never named is one of 0.33 mm from farthest to farthest, of a
/// load that is followed seven times as fast as it should be. What is named is held.
#[test]
fn a_swing_that_is_never_named_stays_small() {
    const UNNAMED_MM: f64 = 0.6;
    require_said(
        "firmware/SAFETY.md",
        &[format!("a swing of less than {UNNAMED_MM} mm may last")],
    );
    const WATCHED_S: f64 = 10.0;
    let mut largest_mm = 0.0_f64;
    let mut judge = |what: &str, swing: &Swing| {
        println!("{what}: {swing:.3?}");
        match swing.after_s {
            None => largest_mm = largest_mm.max(swing.last_mm),
            Some(_) => assert_eq!(swing.state, State::Held, "{what}: {swing:?}"),
        }
    };
    for (pose, late_ms) in POSES.into_iter().zip([[19, 20], [20, 21], [35, 37]]) {
        let sound = Leg::paper(pose);
        for ms in late_ms {
            let swing = sound.clone().swung(Activity::Resting, 8 * ms, WATCHED_S);
            judge(&format!("{ms} ms late, {pose:?}"), &swing);
        }
    }
    for (pose, load_times_s) in POSES
        .into_iter()
        .zip([[0.035, 0.03], [0.025, 0.02], [0.04, 0.035]])
    {
        for load_time_s in load_times_s {
            let mut rig = paper();
            rig.gains.estimation.load_time_s = load_time_s;
            let swing = Leg::new(&rig, &rig.plant, pose).swung(Activity::Resting, 0, WATCHED_S);
            judge(&format!("load time {load_time_s} s, {pose:?}"), &swing);
        }
    }
    assert!(largest_mm < UNNAMED_MM, "{largest_mm} mm");
}

/// How far the tip of a leg that hangs straight down is on each side of a swing which is taken for one, mm, on every ready rig: the tendon that
/// swings the most lies in its plane.
#[test]
fn a_swing_is_taken_for_one_from_what_is_said() {
    for (least_m, about_mm, words) in [
        (SWINGING_M, 0.3, "by about 0.3 mm to each side"),
        (MOVING_SWINGING_M, 1.0, "by about 1 mm to each side"),
    ] {
        require_said("firmware/SAFETY.md", &[words.into()]);
        for ready in READY_RIGS {
            let rig = RigFile::parse(ready.name, ready.text).unwrap().parameters;
            let tip_m = rig.joint_length_m + rig.leg_length_m;
            let lever_m = rig.leg_anchors_m.map(|[x, y]| x.hypot(y)).into_iter();
            let lever_m = lever_m.fold(0.0, f64::max);
            let tip_mm = 1e3 * f64::from(least_m) * tip_m / lever_m;
            assert!(
                (tip_mm / about_mm - 1.0_f64).abs() < 0.15,
                "{}: {tip_mm} mm",
                ready.name
            );
        }
    }
}

/// On its way a leg swings by its commands, too: a greater swing is named, and later.
#[test]
fn a_swing_of_a_leg_that_follows_points_ends_in_hold() {
    const WITHIN_S: f64 = 2.5;
    require_said("firmware/SAFETY.md", &[format!("held within {WITHIN_S} s")]);
    for (pose, ms) in [(POSES[0], 20), (POSES[2], 40)] {
        let swing = Leg::paper(pose).swung(Activity::Streaming, 8 * ms, 4.0);
        println!("{ms} ms late, streamed, {pose:?}: {swing:.3?}");
        let named = swing.after_s.is_some_and(|after_s| after_s < WITHIN_S);
        assert!(named && swing.state == State::Held, "{swing:?}");
        assert_eq!(swing.faults, FaultSet::single(Fault::Swings));
        assert!(swing.largest_mm < 5.0, "{swing:?}");
        // With sound cells it rings down, and the stream goes on.
        let swing = Leg::paper(pose).swung(Activity::Streaming, 0, 3.0);
        assert!(swing.after_s.is_none() && swing.last_mm < 0.02, "{swing:?}");
    }
}
