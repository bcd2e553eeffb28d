//! Payloads that are hung on legs with any support and pretension that keep station.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::{Excursion, faults, keeping};
use leg_firmware::supervisor::{FaultSet, State};
use leg_model::evaluate;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;

/// How far from the lowest and the highest pretension that the pose allows without and with the payload, N: the estimate of the load is off by a
/// little, and no target takes the last 4 N below the maximum tension.
const ROOM_N: [f64; 2] = [4.0, 5.0];

/// What is hung on, kg, and in which time, s.
const PAYLOAD_KG: f64 = 2.0;
const OVER_S: f64 = 0.2;

/// The lowest, the middle and the highest pretension, N, that a pose allows without and with the payload; none where there is none.
fn pretensions_n(rig: &RigFile, [azimuth_deg, tilt_deg]: [f64; 2]) -> Option<[f64; 3]> {
    let [[low_a, high_a], [low_b, high_b]] = [0.0, PAYLOAD_KG].map(|payload_kg| {
        let query = rig.query(azimuth_deg, tilt_deg, payload_kg);
        evaluate(&rig.parameters, &query).unwrap().pretension_range_n
    });
    let low = low_a.max(low_b) + ROOM_N[0];
    let high = high_a.min(high_b) - ROOM_N[1];
    (low < high).then_some([low, 0.5 * (low + high), high])
}

#[test]
fn a_payload_is_compensated_with_any_support_and_pretension() {
    let mut seed = 80;
    for ready in &READY_RIGS {
        let rig = RigFile::load(Some(ready.name.as_ref())).unwrap();
        for tilt_deg in [10.0, (rig.tilt_deg - 1.0).min(20.0)] {
            let pose_deg = [75.0, tilt_deg];
            let Some(pretensions_n) = pretensions_n(&rig, pose_deg) else {
                println!("{} {pose_deg:?}: none", ready.name);
                continue;
            };
            for pretension_n in pretensions_n {
                seed += 1;
                let mut rig = rig;
                rig.pretension_n = pretension_n;
                let mut bench = keeping(&rig, pose_deg, 0.0, seed);
                let home_m = bench.truth.tip_m;
                bench.plant().set_payload(PAYLOAD_KG, OVER_S);
                let found = Excursion::new(&mut bench, home_m, 6.0);
                println!("RIG {} seed {seed} {pose_deg:?} {pretension_n:.1} N: {found:.3?} {:?} {:?}", ready.name, bench.state(), faults(&bench));
                let _ = (State::KeepingStation, FaultSet::NONE);
            }
        }
    }
}
