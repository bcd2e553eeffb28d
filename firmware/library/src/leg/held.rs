//! Held: the motors brake to a stop, and rest on their screws from then on.

use super::shared::Shared;
use crate::control::{Axis, TICK_S, bounds, ticks};
use leg_model::Scalar;

/// Time in which a moving leg is braked, s: stopped at once, it would swing on with its payload, and double the tension of a
/// tendon. About a period of that swing; at the greatest speed the tip goes on by 13 mm.
const BRAKE_S: f32 = 0.15;

/// The same of a leg that is asked for nearly its maximum tension, s: slower, it adds less to that. Another leg swings the farther the
/// slower it is braked.
const GENTLE_BRAKE_S: f32 = 0.2;

/// The same where a motor does not obey, or something may hold the leg, s: meanwhile the motors pull against it. No leg on its way is braked
/// in less.
const SHORT_BRAKE_S: f32 = 0.06;

/// The same of a leg at rest, s: its motors brake its swing, and go on by less than 0.1 mm.
const REST_BRAKE_S: f32 = 0.04;

/// Part of the maximum tension from which on the tension that is asked of a tendon is near it: a brake adds up to a quarter.
const NEAR_PART: f32 = 0.8;

/// How far a tendon at the maximum tension is paid out beyond its way, m: 1 mm at the tip.
const GIVEN_M: f32 = 1e-4;

/// A motor that is led by less than this in a tick stands, m: 0.1 mm/s.
const STILL_STEP_M: f32 = 1e-4 * TICK_S;

/// One that is led and goes by less than this in a tick does not turn, or is not counted, m: 0.01 mm/s.
const STANDING_STEP_M: f32 = 1e-5 * TICK_S;

/// Part of the speed of the fastest motor up to which the others do not wait for one that does not obey: they go on by 0.3 mm of its tendon at the
/// most, at 20 mm/s in 0.2 s.
const SLOW_PART: f32 = 0.15;

/// Part of its speed by which a motor goes on that obeys. On its way, and where the maximum tension does not slow it down, it goes by nearly all of it; one
/// whose half bridge is open has lost a tenth before that is named.
const OBEYED_PART: f32 = 0.9;

/// What motors do that are braked.
#[derive(Clone, Copy, Debug)]
pub struct Momentum<T> {
    /// How far each goes in a tick, m.
    pub steps_m: [T; 3],
    /// Ticks in which the path would have ended, if there is one: braked more slowly, the leg would go beyond its end. None are left of a
    /// leg at rest; one of a leg that homes, which is braked as shortly as any that moves.
    pub ticks_to_end: Option<u32>,
}

/// The leg stays where it is. While it brakes, a tendon at the maximum tension is paid out a little, unless a load cell is in
/// doubt; at rest no load cell is used.
#[derive(Clone, Copy, Debug)]
pub struct Held<T> {
    /// How far each motor went in a tick at first, m.
    steps_m: [T; 3],
    ticks_left: u32,
    /// Inverse of the ticks of the whole brake.
    per_tick: f32,
}

impl<T: Scalar> Held<T> {
    /// From what the motors do now; `hindered`: whether a motor does not obey, or something may hold
    /// the leg.
    pub fn braking(shared: &Shared<T>, momentum: Momentum<T>, hindered: bool) -> Self {
        let steps_m = momentum
            .steps_m
            .map(|step| if is_still(step) { T::zero() } else { step });
        let still = steps_m.iter().all(|&step| step == T::zero());
        let brake_s = match (hindered, is_near_max(shared)) {
            (true, _) => SHORT_BRAKE_S,
            (false, true) => GENTLE_BRAKE_S,
            (false, false) => BRAKE_S,
        };
        let [ticks, short, rest] = [brake_s, SHORT_BRAKE_S, REST_BRAKE_S].map(ticks);
        let to_end = match momentum.ticks_to_end {
            None => ticks,
            Some(0) => rest,
            Some(left) => left.max(short),
        };
        let ticks = ticks.min(to_end);
        Self {
            steps_m,
            ticks_left: if still { 0 } else { ticks },
            per_tick: 1.0 / ticks as f32,
        }
    }

    /// How far each tendon may be paid out while it is braked, from where it is pulled in, m.
    pub fn lowest_m(&self, pulled_m: &[T; 3]) -> [T; 3] {
        let mut lowest_m = *pulled_m;
        for (lowest, &step_m) in lowest_m.iter_mut().zip(&self.steps_m) {
            let way_m = step_m * T::from(0.5 * self.ticks_left as f32);
            *lowest += bounds::min(way_m, T::zero()) - T::from(GIVEN_M);
        }
        lowest_m
    }

    /// At rest.
    pub fn resting() -> Self {
        Self {
            steps_m: [T::zero(); 3],
            ticks_left: 0,
            per_tick: 0.0,
        }
    }

    /// Whether the motors still turn.
    #[inline(always)]
    pub const fn brakes(&self) -> bool {
        self.ticks_left > 0
    }

    /// One tick.
    #[inline(always)]
    pub fn step(&mut self, shared: &mut Shared<T>) {
        if !self.brakes() {
            return;
        }
        self.ticks_left -= 1;
        let part = T::from(self.ticks_left as f32 * self.per_tick);
        for (axis, step_m) in shared.axes.iter_mut().zip(&mut self.steps_m) {
            let led_m = *step_m * part;
            // One that stands where it is led on rests: it may be turning without being counted, or not turn at all.
            let standing_m = T::from(STANDING_STEP_M);
            if !is_still(led_m) && axis.moved_m().abs() <= standing_m {
                *step_m = T::zero();
            }
            axis.lead_by(led_m);
            if *step_m == T::zero() {
                axis.rest_here();
            } else if self.ticks_left == 0 {
                axis.rest(axis.reference_m());
            }
        }
    }
}

/// Whether a motor that is led so far in a tick, m, is as good as at rest.
fn is_still<T: Scalar>(step_m: T) -> bool {
    step_m.abs() <= T::from(STILL_STEP_M)
}

/// Whether each motor that is led fast goes on nearly as it is led. One that the maximum tension slows down does not, either.
pub fn is_obeyed<T: Scalar>(shared: &Shared<T>) -> bool {
    let led_m = shared.axes.each_ref().map(Axis::led_m);
    let fastest_m = led_m.map(T::abs).into_iter().fold(T::zero(), bounds::max);
    let mut led = shared.axes.iter().zip(led_m);
    led.all(|(axis, led_m)| {
        led_m.abs() <= fastest_m * T::from(SLOW_PART)
            || axis.moved_m() * led_m >= led_m * led_m * T::from(OBEYED_PART)
    })
}

/// Whether a tendon should pull nearly by the maximum tension. What its load cell shows may be the fault.
fn is_near_max<T: Scalar>(shared: &Shared<T>) -> bool {
    let near_n = shared.mechanism.f_max_n * T::from(NEAR_PART);
    let tensions_n = shared.target.as_ref().map(|target| target.tensions_n);
    tensions_n.is_some_and(|tensions_n| tensions_n.iter().any(|&tension| tension > near_n))
}

#[cfg(test)]
mod tests;
