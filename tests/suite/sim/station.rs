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

/// Two kilograms are hung on the leg and taken off again: it comes back within 3 s where it sags by up to 4.5 mm, and goes no faster than
/// it may. At the edge of the workspace it sags farther, and takes as much longer.
#[test]
fn a_payload_is_compensated_slowly_and_without_a_host() {
    const OVER_S: f64 = 0.2;
    for (seed, pose_deg, sag_mm, within_s) in [
        (11, [0.0, 5.0], [0.5, 1.0], 1.0),
        (12, [0.0, 15.0], [2.0, 3.0], 2.0),
        (13, [60.0, 20.0], [3.5, 4.7], 3.0),
        (14, [200.0, 20.0], [3.5, 4.5], 3.0),
        (15, [30.0, 30.0], [5.0, 7.5], 6.0),
    ] {
        let mut bench = Bench::keeping(&paper(), pose_deg, 0.0, seed);
        let home_m = bench.tip_m();
        for payload_kg in [2.0, 0.0] {
            bench.leg.plant_mut().set_payload(payload_kg, OVER_S);
            let found = bench.excursion(home_m, within_s + 1.0);
            let what = format!("seed {seed}, {pose_deg:?}, {payload_kg} kg: {found:?}");
            assert_eq!(bench.state(), State::KeepingStation, "{what}");
            assert_eq!(bench.faults(), FaultSet::NONE, "{what}");
            assert!(
                found.largest_mm > sag_mm[0] && found.largest_mm < sag_mm[1],
                "{what}"
            );
            assert!(found.back_s <= within_s + OVER_S, "{what}");
            assert!(found.mm_per_s < 2.1, "{what}");
            let estimated_kg = f64::from(bench.telemetry.unwrap().payload_kg);
            assert!(
                (estimated_kg - payload_kg).abs() < 0.25,
                "{what}: {estimated_kg} kg"
            );
        }
        // The motors rest on their screws.
        let [duty, part] = bench.driven(2.0);
        assert!(duty < 0.02 && part < 0.6, "{pose_deg:?}: {duty}, {part}");
    }
}

/// One sensor that lies while the leg keeps station: the tip stays where it is, and most are found.
#[test]
fn a_sensor_that_lies_ends_it_in_hold_or_moves_nothing() {
    let found_always: [fn(usize) -> Defect; 15] = [
        Defect::CellStuck,
        Defect::CellSaturated,
        Defect::CellDead,
        Defect::CellStale,
        Defect::CellDrifting,
        Defect::CellExcitationLost,
        Defect::CellFades,
        Defect::CellWanders,
        Defect::CellHum,
        Defect::CellGainStep,
        Defect::CellGainStepDown,
        Defect::CellOffsetStep,
        Defect::CellOffsetStepDown,
        Defect::CellReversed,
        Defect::CellCrosstalk,
    ];
    let found_sometimes: [fn(usize) -> Defect; 6] = [
        Defect::CellGainDrift,
        Defect::CellGainDriftDown,
        Defect::CellFollows,
        Defect::CellSticks,
        Defect::CellLate,
        Defect::CellPwmNoise,
    ];
    let both = found_always.map(|defect| (defect, true)).into_iter();
    let both = both.chain(found_sometimes.map(|defect| (defect, false)));
    let sound = Bench::keeping(&paper(), [30.0, 20.0], 1.0, 21);
    let home_m = sound.tip_m();
    for (number, (defect, always)) in both.enumerate() {
        let defect = defect(number % 3);
        let mut bench = sound.clone();
        bench.leg.plant_mut().set_defect(defect, true);
        let found = bench.excursion(home_m, if always { 2.5 } else { 5.0 });
        assert!(found.largest_mm < 0.5, "{defect:?}: {found:?}");
        let held = bench.state() == State::Held;
        assert!(
            held || !always && bench.state() == State::KeepingStation,
            "{defect:?}"
        );
        assert_eq!(held, bench.faults().without_limits().any(), "{defect:?}");
    }
    for (defect, fault) in [
        (Defect::ExcitationLost, None),
        (Defect::ExcitationSags, Some(Fault::Residual)),
        (Defect::SupplySag, Some(Fault::SupplyLow)),
        (Defect::SupplySurge, Some(Fault::SupplyHigh)),
        (Defect::LateTicks, Some(Fault::LateTick)),
    ] {
        let mut bench = sound.clone();
        bench.leg.plant_mut().set_defect(defect, true);
        let found = bench.excursion(home_m, 1.0);
        assert!(found.largest_mm < 0.5, "{defect:?}: {found:?}");
        assert_eq!(bench.state(), State::Held, "{defect:?}");
        assert!(
            fault.is_none_or(|fault| bench.faults().has(fault)),
            "{defect:?}"
        );
    }
}

/// A cell that drifts by 0.2 N/s, less than a leg at rest takes for creep, is found before it has led the tip away.
#[test]
fn a_cell_that_drifts_slowly_does_not_lead_the_leg_away() {
    /// Ticks of 5 N/s in which it drifts for one.
    const EVERY: u32 = 25;
    let mut bench = Bench::keeping(&paper(), [30.0, 20.0], 0.5, 31);
    let home_m = bench.tip_m();
    let mut largest_mm = 0.0_f64;
    for _ in 0..60 * u32::from(TICK_HZ) / EVERY {
        let drifting = Defect::CellDrifting(0);
        bench.leg.plant_mut().set_defect(drifting, true);
        bench.tick();
        bench.leg.plant_mut().set_defect(drifting, false);
        for _ in 1..EVERY {
            bench.tick();
        }
        largest_mm = largest_mm.max((bench.tip_m() - home_m).norm() * 1e3);
    }
    assert_eq!(bench.state(), State::Held);
    assert_eq!(bench.faults(), FaultSet::single(Fault::Residual));
    assert!(largest_mm < 0.5, "{largest_mm}");
}

/// Any command that ends it, and what does not.
#[test]
fn every_command_does_what_is_said_from_station() {
    let sound = Bench::keeping(&paper(), [60.0, 15.0], 1.0, 41);
    for (command, state) in [
        (Command::Stop, State::Held),
        (Command::KeepStation, State::KeepingStation),
        (Command::Clear, State::KeepingStation),
        (Command::KeepAlive, State::KeepingStation),
        (Command::Hold, State::KeepingStation),
        (Command::Home, State::KeepingStation),
        (Command::Move { x: 0.1, y: 0.0 }, State::KeepingStation),
        (Command::Pretension(140.0), State::KeepingStation),
        (Command::Pretension(f32::NAN), State::KeepingStation),
        (
            Command::Stiffness {
                demand_nm_per_rad: 120.0,
                towards: None,
            },
            State::KeepingStation,
        ),
        (
            Command::Compensation(Compensation::Off),
            State::KeepingStation,
        ),
        (Command::Arm, State::Active),
        // It is led straight down first.
        (Command::Disarm, State::Active),
    ] {
        let mut bench = sound.clone();
        bench.command(&command);
        bench.wait(0.1);
        assert_eq!(bench.state(), state, "{command:?}");
        assert_eq!(bench.faults(), FaultSet::NONE, "{command:?}");
    }
    // What a leg that keeps station does is not changed by a command: the load is still compensated.
    let mut bench = sound.clone();
    bench.command(&Command::Compensation(Compensation::Off));
    bench.command(&Command::Pretension(140.0));
    let before_m = bench.tip_m();
    bench.wait(2.0);
    assert!((bench.tip_m() - before_m).norm() < 5e-5);
    let mut bench = sound.clone();
    bench.command(&Command::Disarm);
    bench.wait(5.0);
    assert_eq!(bench.state(), State::Disarmed);
    // A host that lets it follow commands again and dies leaves it in hold.
    let mut bench = sound;
    bench.command(&Command::Arm);
    bench.command(&Command::Move { x: 0.1, y: 0.0 });
    bench.wait(0.5);
    assert_eq!(bench.state(), State::Held);
    assert_eq!(bench.faults(), FaultSet::single(Fault::CommandTimeout));
}

/// Where the leg cannot be left to itself it is held, as it was always.
#[test]
fn a_leg_that_may_not_keep_station_is_held() {
    let keep = |bench: &mut Bench| {
        bench.command(&Command::KeepStation);
        bench.wait(0.5);
        assert_eq!(bench.state(), State::Held);
        assert_eq!(bench.faults(), FaultSet::NONE);
    };
    let mut off = paper();
    off.keeps_station = false;
    keep(&mut Bench::armed(&off, [0.0, 10.0], 0.5, 51));
    let sound = Bench::armed(&paper(), [0.0, 10.0], 0.5, 52);
    for compensation in [Compensation::Off, Compensation::Frozen] {
        let mut bench = sound.clone();
        bench.command(&Command::Compensation(compensation));
        bench.wait(0.1);
        keep(&mut bench);
    }
    let mut moving = sound;
    moving.command(&Command::Move { x: 0.0, y: 0.1 });
    moving.wait(0.1);
    keep(&mut moving);
}

/// A hand pushes for a minute: the leg comes back under it, and comes back when it is gone.
#[test]
fn a_push_for_a_minute_is_compensated() {
    let mut bench = Bench::keeping(&paper(), [30.0, 10.0], 0.5, 61);
    let home_m = bench.tip_m();
    let plant = bench.leg.plant_mut();
    plant.push(plant.across(100.0) * 6.0, 60.0, 0.3);
    for largest_mm in [4.0, 7.0] {
        let found = bench.excursion(home_m, 60.0);
        assert!(
            found.largest_mm < largest_mm && found.end_mm < 0.1,
            "{found:?}"
        );
        assert!(found.mm_per_s < 2.1, "{found:?}");
        assert_eq!(bench.state(), State::KeepingStation);
    }
}
