//! A simulated leg whose numbers are lost says so.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::{armed, paper};
use nalgebra::Vector3;

/// What acts on it is no number, or without a bound: the leg does not stand still where its stop would hold it.
#[test]
fn a_push_that_is_no_number_ends_the_run() {
    let sound = armed(&paper(), [30.0, 10.0], 0.5, 5);
    for force_n in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
        for along in [Vector3::x(), Vector3::y(), Vector3::z()] {
            let mut stand = sound.clone();
            stand.plant().push(along * force_n, 1.0, 0.0);
            let lost = (0..80).find_map(|_| stand.tick().err());
            assert!(
                lost.is_some(),
                "{force_n} along {along:?}: {:?}",
                stand.truth
            );
        }
    }
    let mut stand = sound;
    let across = stand.plant().transverse(90.0);
    stand.plant().push(across * 5.0, 1.0, 0.0);
    for _ in 0..80 {
        stand.tick().unwrap();
    }
}
