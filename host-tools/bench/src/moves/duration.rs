//! How long a move may take by the limits on its motion.

use leg_base::angles;
use leg_firmware::control::CYCLE_S;
use leg_firmware::settings::Motion;

/// Part of each limit that the planner uses. A half-tangent changes by at least half of the angle.
const USED: f64 = 0.5 * 0.98;

/// The greatest rate, acceleration and jerk of a path of fifth degree from rest to rest, by its length and its time.
const RATE: f64 = 15.0 / 8.0;
const ACCELERATION: f64 = 5.773_502_691_896_258;
const JERK: f64 = 60.0;

/// The planner begins with this rate, so that rounding does not decide, or with this time, s; and each time that it tries is longer than the
/// last one by this.
const FIRST_RATE: f64 = 1.89;
const SHORTEST_S: f64 = 0.02;
const LONGER: f64 = 1.15;

/// Cycles in which a path that is too fast is found to be so: one for its jerk is so in its first place, one for its acceleration in its
/// fourth. Those in which one is checked to its end, and those from the command to the planner and from the end to the telemetry.
const REFUSED_CYCLES: f64 = 4.0;
const CHECKED_CYCLES: f64 = 10.0;
const TOLD_CYCLES: f64 = 4.0;

/// The longest that a move from rest to rest between two poses, azimuth and tilt in degrees, may take with these limits from its command to
/// its end, s: no longer than the first time of those that are tried in which it keeps them.
#[must_use]
pub fn longest_s(motion: &Motion, begin_deg: [f64; 2], end_deg: [f64; 2]) -> f64 {
    let [[begin_x, begin_y], [end_x, end_y]] = [begin_deg, end_deg].map(half_tangent);
    let length = (end_x - begin_x).hypot(end_y - begin_y);
    let rate = USED * f64::from(motion.speed_rad_per_s);
    let acceleration = USED * f64::from(motion.acceleration_rad_per_s2);
    let jerk = USED * f64::from(motion.jerk_rad_per_s3);
    let needed_s = [
        RATE * length / rate,
        (ACCELERATION * length / acceleration).sqrt(),
        (JERK * length / jerk).cbrt(),
    ];
    let needed_s = needed_s.into_iter().fold(0.0, f64::max);
    let mut tried_s = (FIRST_RATE * length / rate).max(SHORTEST_S);
    let mut refused = 0.0;
    while tried_s < needed_s {
        tried_s *= LONGER;
        refused += REFUSED_CYCLES;
    }
    let cycle_s = f64::from(CYCLE_S);
    let moving_cycles = (tried_s / cycle_s).ceil();
    (refused + CHECKED_CYCLES + TOLD_CYCLES + moving_cycles) * cycle_s
}

/// The half-tangents of a pose.
fn half_tangent([azimuth_deg, tilt_deg]: [f64; 2]) -> [f64; 2] {
    let tangent = (0.5 * tilt_deg.to_radians()).tan();
    angles::unit_vector(azimuth_deg).map(|part| part * tangent)
}
