//! A leg that follows commands keeps its tensions between the minimum and the maximum, whatever pretension it is asked for.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::armed;
use leg_bench::stand::{Stand, move_to};
use leg_firmware::command::Command;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;

/// Farthest that the leg leans, degrees.
const TILT_DEG: f64 = 20.0;

/// How far a tension swings beyond a limit on the way, N.
const BEYOND_N: f64 = 0.5;

/// The least and the greatest true tension in a time, N.
fn range_n(stand: &mut Stand, time_s: f64, range_n: &mut [f64; 2]) {
    let end_s = stand.time_s() + time_s;
    while stand.time_s() < end_s {
        stand.tick().unwrap();
        stand.require_no_fault().unwrap();
        for tension_n in stand.truth.tensions_n {
            *range_n = [range_n[0].min(tension_n), range_n[1].max(tension_n)];
        }
    }
}

/// No pretension, and the maximum as pretension, are asked for at each end of three moves on every rig: what the leg takes is within its limits.
#[test]
fn a_leg_that_follows_keeps_its_tensions_within_their_limits() {
    let mut beyond_n = [0.0_f64; 2];
    for ready in READY_RIGS {
        let mut rig = RigFile::load(Some(ready.name.as_ref())).unwrap();
        // Homing has tared the cells.
        rig.plant.cell_offset_n = [0.0; 3];
        let tilt_deg = TILT_DEG.min(0.9 * rig.tilt_deg);
        for payload_kg in [0.0, 1.0] {
            let start = armed(&rig, [60.0, tilt_deg], payload_kg, 91);
            for asked_n in [0.0, rig.f_max_n] {
                let mut stand = start.clone();
                stand.command(&Command::Pretension(asked_n as f32)).unwrap();
                let mut found_n = [f64::INFINITY, 0.0];
                range_n(&mut stand, 2.0, &mut found_n);
                for pose_deg in [[200.0, tilt_deg], [320.0, 0.3 * tilt_deg], [60.0, tilt_deg]] {
                    stand.command(&move_to(pose_deg)).unwrap();
                    range_n(&mut stand, 2.5, &mut found_n);
                }
                println!(
                    "{}, {payload_kg} kg, {asked_n} N asked: {found_n:.2?} N",
                    ready.name
                );
                // It does take what it is allowed.
                if asked_n > 0.0 {
                    assert!(found_n[1] > rig.f_max_n - 5.0, "{found_n:?}");
                } else {
                    assert!(found_n[0] < rig.f_min_n + 5.0, "{found_n:?}");
                }
                beyond_n[0] = beyond_n[0].max(rig.f_min_n - found_n[0]);
                beyond_n[1] = beyond_n[1].max(found_n[1] - rig.f_max_n);
            }
        }
    }
    println!("{beyond_n:?} N beyond");
    assert!(beyond_n.iter().all(|n| *n < BEYOND_N), "{beyond_n:?} N");
}
