//! A leg whose feedback is unstable: what its load cells show comes late, and its brake drives the swing.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::{faults, paper, ticks};
use leg_bench::stand::{Stand, move_to};
use leg_base::angles;
use leg_firmware::command::Command;
use leg_firmware::sensors::Sensors;
use leg_firmware::set_point::{SetPoint, StreamPart};
use leg_firmware::supervisor::{FaultSet, State};
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

#[derive(Clone)]
struct Swinging {
    stand: Stand,
    cells: LateCells,
    pose_deg: [f64; 2],
}

struct Found {
    after_s: Option<f64>,
    /// From farthest to farthest, mm: before the fault, and in the last second.
    largest_mm: f64,
    last_mm: f64,
    faults: FaultSet,
    state: State,
    moved_mm: f64,
}

fn spread_mm(tips_m: &[Vector3<f64>]) -> f64 {
    let Some(first) = tips_m.first() else { return 0.0; };
    let far = |from: &Vector3<f64>| {
        let by = |a: &&Vector3<f64>, b: &&Vector3<f64>| (*a - from).norm().total_cmp(&(*b - from).norm());
        *tips_m.iter().max_by(by).unwrap()
    };
    let one = far(first);
    (far(&one) - one).norm() * 1e3
}

impl Swinging {
    fn new(rig: &RigFile, plant: &leg_rig::plant_settings::PlantSettings, pose_deg: [f64; 2], payload_kg: f64, seed: u64) -> Self {
        let [azimuth_deg, tilt_deg] = pose_deg;
        let start = Start::Held { azimuth_deg, tilt_deg, pretension_n: rig.pretension_n, payload_kg };
        let stand = Stand::unjudged(rig, plant, start, seed).unwrap();
        let mut swinging = Self { stand, cells: LateCells::default(), pose_deg };
        swinging.pass(0.1);
        swinging.stand.command(&Command::Arm).unwrap();
        swinging.pass(0.4);
        swinging.stand.command(&move_to(pose_deg)).unwrap();
        swinging.pass(2.5);
        swinging
    }

    fn tick(&mut self) {
        let Self { stand, cells, .. } = self;
        stand.tick_through(cells).unwrap();
    }

    fn pass(&mut self, time_s: f64) {
        for _ in 0..ticks(time_s) {
            self.tick();
        }
    }

    fn point(&self, part: StreamPart, ahead: u32) -> Command {
        let [azimuth, tilt] = self.pose_deg;
        Command::Follow(SetPoint {
            part,
            tick: self.stand.telemetry.unwrap().tick + ahead,
            direction: angles::direction(azimuth, tilt).map(|c| c as f32),
            rate: [0.0; 2],
            acceleration: Some([0.0; 2]),
            tension: None,
        })
    }

    fn watch(&mut self, activity: Activity, late_ticks: usize, push_n: f64, time_s: f64) -> Found {
        let state = match activity {
            Activity::KeepingStation => {
                self.stand.command(&Command::KeepStation).unwrap();
                self.pass(0.01);
                self.stand.silence();
                self.pass(0.5);
                State::KeepingStation
            }
            _ => State::Active,
        };
        let began = self.stand.state();
        self.cells.ticks = late_ticks;
        if push_n > 0.0 {
            let plant = self.stand.plant();
            plant.push(plant.transverse(60.0) * push_n, 0.1, 0.0);
        }
        let home_m = self.stand.truth.tip_m;
        let mut tips_m = Vec::new();
        let mut after_s = None;
        let mut moved_mm = 0.0_f64;
        for tick in 0..ticks(time_s) {
            if activity == Activity::Streaming && tick % 160 == 0 {
                let part = if tick == 0 { StreamPart::First } else { StreamPart::Next };
                let point = self.point(part, if tick == 0 { 4_000 } else { 4_000 });
                self.stand.command(&point).unwrap();
            }
            self.tick();
            moved_mm = moved_mm.max((self.stand.truth.tip_m - home_m).norm() * 1e3);
            if self.stand.state() != state && after_s.is_none() {
                after_s = Some(tick as f64 / 8000.0);
                break;
            }
            tips_m.push(self.stand.truth.tip_m);
        }
        if after_s.is_some() { self.pass(1.0); }
        let last = tips_m.len().saturating_sub(8_000);
        let _ = began;
        Found {
            after_s,
            largest_mm: spread_mm(&tips_m[tips_m.len().min(1600)..]),
            last_mm: spread_mm(&tips_m[last..]),
            faults: faults(&self.stand),
            state: self.stand.state(),
            moved_mm,
        }
    }
}

fn show(name: &str, found: &Found) {
    println!(
        "EXP {name}: after {:?} s, largest {:.3} mm, last {:.3} mm, moved {:.2}, {:?} {:?}",
        found.after_s, found.largest_mm, found.last_mm, found.moved_mm, found.state, found.faults
    );
}

const POSES: [([f64; 2], f64); 3] = [([233.0, 20.0], 1.3), ([30.0, 10.0], 0.5), ([0.0, 0.0], 2.0)];

#[test]
fn experiment_delays() {
    for (pose, kg) in POSES {
        let sound = Swinging::new(&paper(), &paper().plant, pose, kg, 5);
        for ms in [2, 5, 8, 11, 14, 17, 20, 25, 30, 40, 60, 80] {
            let found = sound.clone().watch(Activity::Resting, ms * 8, 2.0, 6.0);
            show(&format!("delay {ms} ms {pose:?} {kg} kg rest"), &found);
        }
        for ms in [14, 20, 30, 40, 60] {
            let found = sound.clone().watch(Activity::KeepingStation, ms * 8, 2.0, 6.0);
            show(&format!("delay {ms} ms {pose:?} {kg} kg station"), &found);
            let found = sound.clone().watch(Activity::Streaming, ms * 8, 2.0, 6.0);
            show(&format!("delay {ms} ms {pose:?} {kg} kg stream"), &found);
        }
    }
}

#[test]
fn experiment_settings() {
    for (pose, kg) in POSES {
        let mut rigs = Vec::new();
        for load_time_s in [0.08, 0.04, 0.02, 0.01, 0.003] {
            let mut rig = paper();
            rig.gains.estimation.load_time_s = load_time_s;
            rigs.push((format!("load time {load_time_s}"), rig, rig.plant));
            rig.gains.motion.damping_ratio = 0.0;
            rigs.push((format!("load time {load_time_s} no brake"), rig, rig.plant));
        }
        for ratio in [0.35, 0.5] {
            let mut rig = paper();
            rig.gains.motion.damping_ratio = ratio;
            rigs.push((format!("ratio {ratio}"), rig, rig.plant));
        }
        for gain in [10.0, 20.0, 40.0, 300.0, 600.0] {
            let mut rig = paper();
            for servo in &mut rig.gains.servos { servo.position_gain_per_s = gain; }
            rigs.push((format!("position gain {gain}"), rig, rig.plant));
        }
        for inertia in [0.002, 0.005, 0.06, 0.15] {
            let mut rig = paper();
            rig.plant.leg_transverse_inertia_kg_m2 = Some(inertia);
            rigs.push((format!("inertia {inertia}"), paper(), rig.plant));
        }
        for (name, rig, plant) in rigs {
            let mut swinging = Swinging::new(&rig, &plant, pose, kg, 5);
            let name = format!("{name} {pose:?} {kg} kg");
            if swinging.stand.state() != State::Active {
                println!("EXP {name}: {:?} {:?} before", swinging.stand.state(), faults(&swinging.stand));
                continue;
            }
            let found = swinging.watch(Activity::Resting, 0, 2.0, 6.0);
            show(&name, &found);
        }
    }
}
