//! Set-points as any host may send them.

use leg_base::angles;
use leg_firmware::set_point::{PointRefusal, SetPoint, StreamPart, StreamTension};

/// A point at which a leg rests.
pub fn point(part: StreamPart, tick: u32, [azimuth_deg, tilt_deg]: [f64; 2]) -> SetPoint {
    SetPoint {
        part,
        tick,
        direction: angles::direction(azimuth_deg, tilt_deg).map(|component| component as f32),
        rate: [0.0; 2],
        acceleration: Some([0.0; 2]),
        tension: None,
    }
}

/// What [`wild`] points are refused for, among others.
pub const WILD_REFUSALS: [PointRefusal; 7] = [
    PointRefusal::Number,
    PointRefusal::OutOfReach,
    PointRefusal::Order,
    PointRefusal::Late,
    PointRefusal::Early,
    PointRefusal::Following,
    PointRefusal::NoStream,
];

/// A point as [`likely`], or one in seven that is wrong: out of order, in the past, too far ahead, another first or a next without a first, with
/// what is no number.
pub fn wild(rng: &mut fastrand::Rng, last: &SetPoint, streamed: bool, now: u32) -> SetPoint {
    let mut next = likely(rng, last, streamed, now);
    let ticks = rng.u32(1..8_000);
    match rng.u8(..42) {
        0 => next.tick = last.tick.wrapping_sub(ticks),
        1 => next.tick = now.wrapping_sub(ticks),
        2 => next.tick = now.wrapping_add(80_000 + ticks),
        3 => next.part = StreamPart::First,
        4 => next.part = StreamPart::Next,
        5 => {
            let no_number = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
            let place = usize::from(rng.bool());
            let number = match rng.u8(..3) {
                0 => &mut next.direction[place],
                1 => &mut next.rate[place],
                _ => &mut next.acceleration.get_or_insert_default()[place],
            };
            *number = no_number[rng.usize(..3)];
        }
        _ => {}
    }
    next
}

/// A point that follows from the last one by a jerk that is drawn, or is anywhere.
fn likely(rng: &mut fastrand::Rng, last: &SetPoint, streamed: bool, now: u32) -> SetPoint {
    let ticks = 10.0_f64.powf(1.61 + 1.2 * rng.f64().powi(2));
    let time_s = ticks / 8000.0;
    let anywhere = rng.u8(..10) == 0;
    let mut motion = [[0.0; 3]; 2];
    for (i, [place, rate, acceleration]) in motion.iter_mut().enumerate() {
        let number = |values: [f32; 2]| f64::from(values[i]);
        let mut drawn = |scale: f64| scale * (2.0 * rng.f64() - 1.0);
        let (p, v) = (number(last.direction), number(last.rate));
        let a = number(last.acceleration.unwrap_or_default());
        // Jerks that lead back to the vertical, more or less.
        let j = drawn(40.0) - 9.0 * a - 25.0 * v - 25.0 * p;
        *place = p + time_s * (v + time_s * (a / 2.0 + time_s * j / 6.0));
        *rate = v + time_s * (a + time_s * j / 2.0);
        *acceleration = a + time_s * j;
        if anywhere {
            *place += drawn(0.1);
            *rate += drawn(0.5);
        }
    }
    let pair = |order: usize| motion.map(|derivatives| derivatives[order] as f32);
    let (from, part) = match (streamed, rng.u8(..50)) {
        (false, _) => (now, StreamPart::First),
        (true, 0) => (last.tick, StreamPart::Last),
        (true, _) => (last.tick, StreamPart::Next),
    };
    SetPoint {
        part,
        tick: from.wrapping_add(ticks as u32),
        direction: pair(0),
        rate: pair(1),
        acceleration: (rng.u8(..20) > 0).then(|| pair(2)),
        tension: wild_tension(rng),
    }
}

/// Now and then a pretension or a stiffness, also one that no leg has.
fn wild_tension(rng: &mut fastrand::Rng) -> Option<StreamTension> {
    let value = 300.0 * rng.f32() - 20.0;
    match rng.u8(..40) {
        0 => Some(StreamTension::Pretension(value)),
        1 => Some(StreamTension::Stiffness(value)),
        _ => None,
    }
}
