//! A motor that is measured again on the leg that a stop has left in the middle of a measurement.

use super::{deviation, jog, leg, ready_rig};
use fastrand::Rng;
use leg_firmware::jog::{JogDemand, JogDrive};
use leg_host::cancel_flag::CancelFlag;
use leg_host::jog_report::{findings, slow_voltage_v};
use leg_host::operator::{HostIdentity, Operator};
use leg_rig::tune::comparison;
use std::cell::Cell;

/// How often the leg is looked at until its tendon pulls, and until its last jogs against a tension, on any ready rig.
const LOADED: std::ops::Range<u32> = 2300..2850;

/// Turns a motor slowly, by the whole of the travel or until its tendons pull. No finding: nothing is wrong with the leg.
fn turn(operator: &mut Operator, motor: u8, travel_m: f32) {
    let settings = operator.settings().unwrap();
    let drive = JogDrive::Voltage(slow_voltage_v(motor, &settings));
    let (report, _) = operator
        .jog(&JogDemand {
            motor,
            travel_m,
            drive,
        })
        .unwrap();
    for finding in findings(&report, &settings) {
        let pulls = finding.what.contains("shows more than a jog may pull");
        assert!(pulls, "{finding:?}, {report:?}");
    }
}

/// The tendon holds the leg aside then, alone (0, 5) or against tendons that just pull (1, 22), and none of it is taken for a mistake of
/// the load cells; where another one pulls (16), that is said, with what to do.
#[test]
fn a_motor_is_measured_again_where_a_stop_left_its_tendon() {
    for (seed, refused) in [(0, false), (1, false), (5, false), (22, false), (16, true)] {
        let rig = ready_rig(seed);
        let motor = 1 + (seed % 3) as u8;
        let (line, mut operator, cancel) = leg(&rig, &rig, seed);
        let mut rng = Rng::with_seed(seed);
        for motor in 1..=3 {
            turn(&mut operator, motor, 3e-3 * rng.f32());
        }
        let left = Cell::new(rng.u32(LOADED));
        let stop = cancel.clone();
        operator.set_watcher(move |_| {
            left.set(left.get().saturating_sub(1));
            if left.get() == 1 {
                stop.set();
            }
        });
        let stopped = jog(&mut operator, motor, &mut |_| ()).unwrap_err();
        assert!(stopped.to_string().contains("Ctrl-C"), "{stopped}");
        cancel.clear();
        let tensions_n = line.with_plant(|plant| plant.truth().tensions_n);
        println!("seed {seed}: motor {motor}, {tensions_n:.1?} N");
        assert!(tensions_n[usize::from(motor) - 1] > 5.0);
        let again = jog(&mut operator, motor, &mut |_| ());
        if refused {
            let failure = again.unwrap_err().failure();
            let words = format!("{failure} {failure:?}");
            assert!(words.contains("pulls by 7 N before"), "{words}");
            assert!(words.contains("`leg jog`"), "{words}");
            continue;
        }
        let rows = comparison(&again.unwrap(), None, &rig);
        for name in ["resistance_ohm", "torque_constant_nm_per_a"] {
            let row = rows.iter().find(|row| row.name == name).unwrap();
            assert!(deviation(row) < 0.05, "seed {seed}");
        }
    }
}

/// Between two jogs the leg is disarmed, and another host may jog it or home it: what is measured then is of another leg.
#[test]
fn a_leg_that_another_host_uses_between_two_jogs_is_not_measured() {
    let rig = ready_rig(0);
    for other_motor in 1..=3 {
        let (line, mut operator, _) = leg(&rig, &rig, 7);
        let host = HostIdentity {
            id: 77,
            sequence: 7_000,
        };
        let mut other =
            Operator::open(Box::new(line.connect()), host, CancelFlag::default()).unwrap();
        let mut jogs = 0;
        let error = jog(&mut operator, 1, &mut |_| {
            jogs += 1;
            if jogs == 3 {
                turn(&mut other, other_motor, -2e-3);
            }
        })
        .unwrap_err();
        let words = format!("{:?}", error.failure());
        let expected = format!("motor {other_motor} was turned between two jogs");
        assert!(words.contains(&expected), "{words}");
    }
}
