//! How long moves of the simulated leg take.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::{armed, paper, pass};
use leg_bench::moves::longest_s;
use leg_bench::stand::move_to;
use leg_model::evaluate;
use leg_rig::rig_file::RigFile;
use nalgebra::Vector3;

/// By 20° from straight down, and by 40° through the vertical: tilt at the begin, degrees, and the time of the move, s, which is rounded to
/// two places, as it always was.
const MOVES: [(f64, f64); 2] = [(0.0, 0.86), (20.0, 1.71)];
const ROUNDED_S: f64 = 0.005;

/// The tilt at the end, degrees.
const END_DEG: f64 = 20.0;

/// How far the true tip is off the commanded point after that time, mm, of a leg that has shown nothing of its payload, straight down, and of
/// others. A tip may swing by so much after a move.
const HIDDEN_OFF_MM: f64 = 0.2;
const OFF_MM: f64 = 0.1;

/// In the middle of what the poses of a move allow, N.
fn pretension_n(rig: &RigFile, poses_deg: [[f64; 2]; 2], payload_kg: f64) -> f64 {
    let ranges = poses_deg.map(|[azimuth_deg, tilt_deg]| {
        let query = rig.query(azimuth_deg, tilt_deg, payload_kg);
        evaluate(&rig.parameters, &query)
            .unwrap()
            .pretension_range_n
    });
    let [[low_a, high_a], [low_b, high_b]] = ranges;
    0.5 * (low_a.max(low_b) + high_a.min(high_b))
}

/// The commanded tip, m.
fn tip_m(rig: &RigFile, [azimuth_deg, tilt_deg]: [f64; 2]) -> Vector3<f64> {
    let (sine, cosine) = tilt_deg.to_radians().sin_cos();
    let (y, x) = azimuth_deg.to_radians().sin_cos();
    let length_m = rig.parameters.joint_length_m + rig.parameters.leg_length_m;
    Vector3::new(sine * x, sine * y, -cosine) * length_m
}

/// Makes a move; the time until the leg says that it is over, s, and how far its tip is off the end then, mm.
fn made(mut rig: RigFile, poses_deg: [[f64; 2]; 2], payload_kg: f64, seed: u64) -> (f64, f64) {
    rig.pretension_n = pretension_n(&rig, poses_deg, payload_kg);
    // As after homing.
    rig.plant.cell_offset_n = [0.0; 3];
    let [begin_deg, end_deg] = poses_deg;
    let mut stand = armed(&rig, begin_deg, payload_kg, seed);
    let began_s = stand.time_s();
    stand.command(&move_to(end_deg)).unwrap();
    pass(&mut stand, 0.05);
    assert!(stand.moving());
    stand
        .tick_until(5.0, "the end of the move", |stand| !stand.moving())
        .unwrap();
    let off_m = (stand.truth.tip_m - tip_m(&rig, end_deg)).norm();
    (stand.time_s() - began_s, off_m * 1e3)
}

/// On any azimuth and with any payload that the leg is not given.
#[test]
fn a_move_of_the_simulated_leg_takes_no_longer_than_it_did() {
    let mut seed = 60;
    for (begin_tilt_deg, time_s) in MOVES {
        for payload_kg in [0.0, 1.0, 2.0] {
            for azimuth_deg in (0..360).step_by(40).map(f64::from) {
                seed += 1;
                let begin_deg = [azimuth_deg + 180.0, begin_tilt_deg];
                let end_deg = [azimuth_deg, END_DEG];
                let (found_s, off_mm) = made(paper(), [begin_deg, end_deg], payload_kg, seed);
                let what = format!(
                    "seed {seed}: {begin_deg:?} to {end_deg:?}, {payload_kg} kg: {found_s:.4} s, {off_mm:.3} mm"
                );
                let longest_s = longest_s(&paper().gains.motion, begin_deg, end_deg);
                println!("{what}; at most {longest_s:.4} s");
                // What the limits on its motion allow is no more than it took.
                assert!(
                    found_s <= longest_s && longest_s < time_s + ROUNDED_S,
                    "{what}"
                );
                let bar_mm = if begin_tilt_deg == 0.0 {
                    HIDDEN_OFF_MM
                } else {
                    OFF_MM
                };
                assert!(found_s < time_s + ROUNDED_S, "{what}");
                assert!(off_mm <= bar_mm, "{what}");
            }
        }
    }
}

/// One that is led by a hundredth more slowly than it may takes too long: the bound that follows from the limits can fail.
#[test]
fn a_move_that_is_led_more_slowly_than_its_limits_allow_takes_too_long() {
    let poses_deg @ [begin_deg, end_deg] = [[180.0, END_DEG], [0.0, END_DEG]];
    let mut slow = paper();
    slow.gains.motion.speed_rad_per_s *= 0.99;
    let (found_s, _) = made(slow, poses_deg, 1.0, 59);
    let longest_s = longest_s(&paper().gains.motion, begin_deg, end_deg);
    println!("seed 59: {found_s:.4} s, at most {longest_s:.4} s");
    assert!(found_s > longest_s);
}
