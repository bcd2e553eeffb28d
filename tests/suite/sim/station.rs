//! A leg that keeps station: it compensates its load slowly, without a host, and stays where it is at any doubt.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_base::angles;
use leg_firmware::command::{Command, Compensation};
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::supervisor::{Fault, FaultSet, State};
use leg_firmware::telemetry::Telemetry;
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::EmulatedLeg;
use leg_sim::host::Host;
use leg_sim::link::InProcess;
use leg_sim::plant::{Defect, Start};
use nalgebra::Vector3;

/// A leg with its host, which falls silent when it has left the leg to itself.
#[derive(Clone)]
struct Bench {
    leg: EmulatedLeg<InProcess>,
    host: Host,
    ticks: u64,
    telemetry: Option<Telemetry<f32>>,
    duties: [f32; 3],
}

impl Bench {
    /// At rest at a pose, armed, with a payload.
    fn armed(rig: &RigFile, [azimuth_deg, tilt_deg]: [f64; 2], payload_kg: f64, seed: u64) -> Self {
        let start = Start::Held {
            azimuth_deg,
            tilt_deg,
            pretension_n: rig.pretension_n,
            payload_kg,
        };
        let leg = EmulatedLeg::in_process(rig, &rig.plant, start, seed).unwrap();
        let mut bench = Self {
            leg,
            host: Host::new(seed),
            ticks: 0,
            telemetry: None,
            duties: [0.0; 3],
        };
        bench.wait(0.1);
        bench.command(&Command::Arm);
        bench.wait(0.4);
        let [x, y] = angles::direction(azimuth_deg, tilt_deg).map(|c| c as f32);
        bench.command(&Command::Move { x, y });
        bench.wait(3.0);
        assert_eq!(bench.state(), State::Active);
        bench
    }

    /// The same, left to itself: nothing is heard of its host from then on.
    fn keeping(rig: &RigFile, pose_deg: [f64; 2], payload_kg: f64, seed: u64) -> Self {
        let mut bench = Self::armed(rig, pose_deg, payload_kg, seed);
        bench.command(&Command::KeepStation);
        bench.wait(0.01);
        assert_eq!(bench.state(), State::KeepingStation);
        bench.host.silent = true;
        bench.wait(1.0);
        assert_eq!(bench.state(), State::KeepingStation);
        bench
    }

    fn command(&mut self, command: &Command) {
        self.host.send(command).unwrap();
    }

    fn tick(&mut self) {
        let bytes = self.host.outgoing(self.ticks);
        let (_, reply) = self.leg.advance(bytes).unwrap();
        self.ticks += 1;
        self.telemetry = Some(reply.telemetry);
        self.duties = reply.motors.duty;
    }

    fn wait(&mut self, time_s: f64) {
        for _ in 0..ticks(time_s) {
            self.tick();
        }
    }

    fn state(&self) -> State {
        self.telemetry.unwrap().state
    }

    fn faults(&self) -> FaultSet {
        self.telemetry.unwrap().faults
    }

    fn tip_m(&self) -> Vector3<f64> {
        self.leg.plant().truth().tip_m
    }
}

fn ticks(time_s: f64) -> u64 {
    (time_s * f64::from(TICK_HZ)) as u64
}

fn paper() -> RigFile {
    RigFile::load(None).unwrap()
}


/// How far the tip goes at most from where it was, and how far it is from there in the end, mm; the time after which it stays within
/// 0.1 mm, s; and the fastest mean speed over half a second once the leg has swung, mm/s.
#[derive(Clone, Copy, Debug)]
struct Excursion {
    largest_mm: f64,
    end_mm: f64,
    back_s: f64,
    mm_per_s: f64,
}

impl Bench {
    fn excursion(&mut self, home_m: Vector3<f64>, time_s: f64) -> Excursion {
        const SPAN_S: f64 = 0.5;
        const SWINGS_S: f64 = 0.8;
        let mut tips_m = Vec::new();
        let mut found = Excursion {
            largest_mm: 0.0,
            end_mm: 0.0,
            back_s: 0.0,
            mm_per_s: 0.0,
        };
        for tick in 1..=ticks(time_s) {
            self.tick();
            let tip_m = self.tip_m();
            tips_m.push(tip_m);
            found.end_mm = (tip_m - home_m).norm() * 1e3;
            found.largest_mm = found.largest_mm.max(found.end_mm);
            if found.end_mm > 0.1 {
                found.back_s = tick as f64 / f64::from(TICK_HZ);
            }
            if tick > ticks(SPAN_S + SWINGS_S) {
                let before_m = tips_m[(tick - 1 - ticks(SPAN_S)) as usize];
                let mm_per_s = (tip_m - before_m).norm() * 1e3 / SPAN_S;
                found.mm_per_s = found.mm_per_s.max(mm_per_s);
            }
        }
        found
    }

    /// Mean of the sums of the duties, and the part of the ticks in which a motor is driven.
    fn driven(&mut self, time_s: f64) -> [f64; 2] {
        let (mut sum, mut driven) = (0.0, 0.0);
        for _ in 0..ticks(time_s) {
            self.tick();
            let duty: f32 = self.duties.iter().map(|duty| duty.abs()).sum();
            sum += f64::from(duty);
            driven += f64::from(u8::from(duty > 0.0));
        }
        [sum, driven].map(|sum| sum / ticks(time_s) as f64)
    }
}

#[test]
fn measure_hang() {
    for pose in [[0.0, 15.0], [30.0, 30.0], [60.0, 30.0], [60.0, 20.0], [90.0, 22.0], [200.0, 20.0], [0.0, 30.0]] {
        for (from, to) in [(0.0, 2.0), (2.0, 0.0), (0.5, 1.5)] {
            let mut bench = Bench::keeping(&paper(), pose, from, 1);
            let home_m = bench.tip_m();
            bench.leg.plant_mut().set_payload(to, 0.2);
            let found = bench.excursion(home_m, 6.0);
            let driven = bench.driven(5.0);
            bench.wait(20.0);
            let later = bench.driven(5.0);
            eprintln!("{pose:?} {from} to {to} kg: {:?} {:?} {found:.3?}; payload {:.2}; driven {driven:.4?} {later:.4?}", bench.state(), bench.faults(), bench.telemetry.unwrap().payload_kg);
        }
    }
}

#[test]
fn measure_active() {
    for (pose, kg) in [([0.0, 30.0], 2.0), ([60.0, 20.0], 0.0)] {
        let mut bench = Bench::armed(&paper(), pose, kg, 1);
        bench.wait(20.0);
        eprintln!("active {pose:?} {kg}: {:.4?}", bench.driven(5.0));
    }
}

#[test]
fn measure_defects() {
    for (pose, kg) in [([30.0, 20.0], 1.0), ([200.0, 10.0], 0.0)] {
        let sound = Bench::keeping(&paper(), pose, kg, 2);
        for defect in Defect::all() {
            let mut bench = sound.clone();
            let home_m = bench.tip_m();
            bench.leg.plant_mut().set_defect(defect, true);
            let found = bench.excursion(home_m, 3.0);
            eprintln!("defect {pose:?} {kg} {defect:?}: {:?} {:?} largest {:.3}", bench.state(), bench.faults().faults().collect::<Vec<_>>(), found.largest_mm);
        }
    }
}

#[test]
fn measure_drift() {
    for every in [5, 25, 125, 500] {
        for pose in [[30.0, 20.0], [200.0, 5.0]] {
            for cell in 0..2 {
                let mut bench = Bench::keeping(&paper(), pose, 0.5, 2);
                let home_m = bench.tip_m();
                let mut time_s = 0.0;
                let mut largest = 0.0_f64;
                while bench.state() == State::KeepingStation && time_s < 120.0 {
                    bench.leg.plant_mut().set_defect(Defect::CellDrifting(cell), true);
                    bench.tick();
                    bench.leg.plant_mut().set_defect(Defect::CellDrifting(cell), false);
                    for _ in 1..every { bench.tick(); }
                    time_s = (bench.ticks as f64) / 8000.0;
                    largest = largest.max((bench.tip_m() - home_m).norm() * 1e3);
                }
                bench.wait(1.0);
                largest = largest.max((bench.tip_m() - home_m).norm() * 1e3);
                eprintln!("drift {:.3} N/s {pose:?} cell {cell}: {:?} {:?} after {time_s:.1} s, {largest:.3} mm", 5.0 / f64::from(every), bench.state(), bench.faults().faults().collect::<Vec<_>>());
            }
        }
    }
}

#[test]
fn measure_push() {
    for force_n in [1.0, 3.0, 6.0, 10.0] {
        let mut bench = Bench::keeping(&paper(), [30.0, 10.0], 0.5, 2);
        let home_m = bench.tip_m();
        let plant = bench.leg.plant_mut();
        plant.push(plant.across(100.0) * force_n, 60.0, 0.3);
        let found = bench.excursion(home_m, 60.0);
        let after = bench.excursion(home_m, 6.0);
        eprintln!("push {force_n}: {:?} {:?} {found:.3?} {after:.3?}", bench.state(), bench.faults().faults().collect::<Vec<_>>());
    }
}
