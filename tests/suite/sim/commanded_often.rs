//! Commands as fast as the link takes them keep neither the load nor the brake of the swing waiting.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::{armed, paper};
use leg_firmware::command::Command;
use leg_firmware::sensors::TICK_HZ;

/// Time in which a payload is hung on the leg, and for which it is watched from then on, s.
const LOADING_S: f64 = 0.05;
const WATCHED_S: f64 = 0.6;

/// The payload, kg.
const PAYLOAD_KG: f64 = 0.5;

/// What the leg takes for its payload, kg, each tick from when one is hung on it, and how far its tip was moved, m, while a command comes
/// every so many ticks.
fn loaded(ticks_between: Option<u32>) -> (Vec<f64>, f64) {
    let rig = paper();
    let mut stand = armed(&rig, [30.0, 20.0], 0.0, 5);
    let before_m = stand.truth.tip_m;
    stand.plant().set_payload(PAYLOAD_KG, LOADING_S);
    let (mut found_kg, mut moved_m) = (Vec::new(), 0.0_f64);
    for tick in 0..(WATCHED_S * f64::from(TICK_HZ)) as u32 {
        if ticks_between.is_some_and(|ticks| tick % ticks == 0) {
            let command = Command::Pretension(rig.pretension_n as f32);
            stand.command(&command).unwrap();
        }
        stand.tick().unwrap();
        stand.require_no_fault().unwrap();
        found_kg.push(f64::from(stand.telemetry.unwrap().payload_kg));
        moved_m = moved_m.max((stand.truth.tip_m - before_m).norm());
    }
    (found_kg, moved_m)
}

#[test]
fn a_leg_with_a_command_in_every_cycle_takes_up_a_payload_as_fast() {
    let (alone_kg, alone_m) = loaded(None);
    let last_kg = alone_kg.last().unwrap();
    assert!((last_kg - PAYLOAD_KG).abs() < 0.1, "{last_kg}");
    for ticks_between in [4, 8, 16] {
        let (found_kg, moved_m) = loaded(Some(ticks_between));
        let pairs = alone_kg.iter().zip(&found_kg);
        let most_kg = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("{ticks_between} ticks: {most_kg} kg, tip {alone_m} m alone, {moved_m} m");
        assert!(most_kg < 0.02, "{ticks_between} ticks: {most_kg} kg");
        assert!(
            (moved_m - alone_m).abs() < 0.02 * alone_m,
            "{moved_m} {alone_m}"
        );
    }
}
