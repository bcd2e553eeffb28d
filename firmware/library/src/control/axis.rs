//! One motor: position and speed with feed-forward, inside what voltage, current and tension allow.

use super::{
    Applied, CYCLE_TICKS, Friction, TICK_S,
    bounds::{clamp_symmetric, max, min},
};
use crate::settings::Servo;
use leg_model::Scalar;

/// Part of the integral that is left after a tick at rest: it decays with a time constant of 100 ticks, 12.5 ms. A screw
/// holds without voltage; without the decay the motor would keep drawing the last current. Scenario `hold` holds it.
const RESTING_DECAY: f32 = 0.99;

/// A motor that turns by no more than this stands, m/s: without its voltage it goes on by some micrometres, a hundredth of what it does at
/// the speed of a ramp.
const STANDING_M_PER_S: f32 = 5e-4;

/// How far a motor that the maximum tension slows down may be behind its reference, m: a sixth of what would be a fault.
pub const LIMITED_AHEAD_M: f32 = 1e-4;

/// Where a motor shall be led.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisGoal<T> {
    /// How far the tendon shall be pulled in, m.
    pub pulled_m: T,
    /// No faster than this, m/s.
    pub speed_m_per_s: T,
}

/// What an axis shows beside its sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisView<T> {
    /// The tracked speed, m/s.
    pub speed_m_per_s: T,
    /// How far the motor is from where it is led, m.
    pub following_m: T,
    /// The voltage at the motor beyond what its speed induces, V.
    pub driving_v: T,
    /// The voltage at the motor, V.
    pub voltage_v: T,
    /// The mean of [`Self::voltage_v`] over a cycle, V: at low tension the voltage changes its sign from tick to tick.
    pub mean_voltage_v: T,
}

/// The controller of one axis.
#[derive(Clone, Copy, Debug)]
pub struct Axis<T> {
    gains: ServoGains<T>,
    /// Where the axis shall be now, m, and how that changes in a tick, m.
    reference_m: T,
    step_m: T,
    /// The tracked position and speed.
    tracked_m: T,
    speed_m_per_s: T,
    integral_v: T,
    /// The part of the integral that is fed against friction, V.
    fed_v: T,
    voltage_v: T,
    /// The voltages since the last view.
    voltage_sum_v: T,
}

/// Gains in the units in which they are applied.
#[derive(Clone, Copy, Debug)]
struct ServoGains<T> {
    position: T,
    speed: T,
    integral: T,
    back_emf: T,
    current_v: T,
    duty_max: T,
    speed_max: T,
    dead_band_m: T,
    still_step_m: T,
    track_position: T,
    track_speed: T,
    /// Speed for each newton that is left to the maximum tension, m/(s N).
    m_per_s_per_n: T,
    tick_s: T,
    per_tick: T,
}

/// What one axis measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisInput<T> {
    /// How far the tendon is pulled in, m.
    pub pulled_m: T,
    /// Its tension, N.
    pub tension_n: T,
    /// The highest tension that is allowed now, N.
    pub f_max_n: T,
    /// The supply, V.
    pub supply_v: T,
    /// Duty of a volt, 1/V: the inverse of the supply, or 0 at one that drives nothing.
    pub duty_per_v: T,
    /// The tendon is not paid out beyond this, m, whatever its load cell says.
    pub lowest_m: T,
}

impl<T: Scalar> Axis<T> {
    /// At rest.
    pub fn new(servo: &Servo) -> Self {
        let tracking = servo.tracking;
        let gains = ServoGains {
            position: servo.position_gain_per_s.into(),
            speed: servo.speed_gain_v_s_per_m.into(),
            integral: T::from(servo.speed_gain_v_s_per_m * TICK_S / servo.integral_time_s),
            back_emf: servo.back_emf_v_s_per_m.into(),
            current_v: T::from(servo.current_a * servo.resistance_ohm),
            duty_max: servo.duty_max.into(),
            speed_max: servo.speed_m_per_s.into(),
            dead_band_m: servo.dead_band_m.into(),
            // A goal that moves by less than this in a tick stands still; it takes 100 ticks to cross the dead band.
            still_step_m: T::from(0.01 * servo.dead_band_m),
            track_position: tracking.into(),
            // Both poles of the tracking filter in one place: critically damped.
            track_speed: T::from(0.25 * tracking * tracking / TICK_S),
            m_per_s_per_n: T::from(servo.speed_m_per_s / servo.f_max_band_n),
            tick_s: T::from(TICK_S),
            per_tick: T::from(1.0 / TICK_S),
        };
        Self {
            gains,
            reference_m: T::zero(),
            step_m: T::zero(),
            tracked_m: T::zero(),
            speed_m_per_s: T::zero(),
            integral_v: T::zero(),
            fed_v: T::zero(),
            voltage_v: T::zero(),
            voltage_sum_v: T::zero(),
        }
    }

    /// Where the axis shall be now, m.
    #[inline(always)]
    pub fn reference_m(&self) -> T {
        self.reference_m
    }

    /// What the last tick has put at the motor.
    #[inline(always)]
    pub fn applied(&self) -> Applied<T> {
        Applied {
            voltage_v: self.voltage_v,
            driving_v: self.voltage_v - self.gains.back_emf * self.speed_m_per_s,
        }
    }

    /// What the monitors check once a cycle; `pulled_m` is how far the tendon is pulled in.
    #[inline(always)]
    pub fn view(&mut self, pulled_m: T) -> AxisView<T> {
        AxisView {
            speed_m_per_s: self.speed_m_per_s,
            following_m: self.reference_m - pulled_m,
            driving_v: self.applied().driving_v,
            voltage_v: self.voltage_v,
            mean_voltage_v: core::mem::replace(&mut self.voltage_sum_v, T::SUM_START)
                * T::from(1.0 / CYCLE_TICKS as f32),
        }
    }

    /// Stays where it is, m.
    pub fn rest(&mut self, pulled_m: T) {
        self.reference_m = pulled_m;
        self.step_m = T::zero();
        self.integral_v = T::zero();
        self.fed_v = T::zero();
        self.voltage_v = T::zero();
    }

    /// Stays where it was tracked to.
    pub fn rest_here(&mut self) {
        self.rest(self.tracked_m);
    }

    /// Leads the axis to a goal by `share` of the way in each tick from now or, if that is too fast, more slowly.
    #[inline(always)]
    pub fn lead(&mut self, goal: &AxisGoal<T>, share: T) {
        let fastest = min(goal.speed_m_per_s, self.gains.speed_max);
        self.lead_within(goal.pulled_m, fastest * self.gains.tick_s, share);
    }

    /// Leads the axis to where its tendon shall be pulled in, m, by `share` of the way in each tick, but by no more than `step_max_m`.
    #[inline(always)]
    pub fn lead_within(&mut self, pulled_m: T, step_max_m: T, share: T) {
        self.step_m = clamp_symmetric((pulled_m - self.reference_m) * share, step_max_m);
    }

    /// What the motor leaves of its way, m.
    pub fn dead_band_m(&self) -> T {
        self.gains.dead_band_m
    }

    /// Whether the motor stands.
    pub fn stands(&self) -> bool {
        self.speed_m_per_s.abs() <= T::from(STANDING_M_PER_S)
    }

    /// How far the motor is led in a tick, m.
    pub fn led_m(&self) -> T {
        self.step_m
    }

    /// How far the motor goes in a tick, m, but no farther than it is led: at the maximum tension it stays behind.
    pub fn moved_m(&self) -> T {
        clamp_symmetric(self.speed_m_per_s * self.gains.tick_s, self.step_m.abs())
    }

    /// Leads the axis by so much in each tick from now, m.
    #[inline(always)]
    pub fn lead_by(&mut self, step_m: T) {
        self.step_m = step_m;
    }

    /// Feeds the voltage against friction at a tension that is asked for, N. The integral takes it, so that a tick of the servo costs no
    /// more. A motor that is ahead of its reference gets less, down to nothing: it would go on.
    #[inline(always)]
    pub fn feed_friction(&mut self, friction: &Friction<T>, tension_n: T) {
        let fed_v = friction.voltage_v(self.step_to_go_m(), tension_n);
        self.integral_v += fed_v - self.fed_v;
        self.fed_v = fed_v;
    }

    /// How far the axis is led in a tick, m, less what the servo takes back of that where the motor is ahead.
    #[inline(always)]
    fn step_to_go_m(&self) -> T {
        let behind_m = self.reference_m - self.tracked_m;
        let wanted_m = self.step_m + self.gains.position * self.gains.tick_s * behind_m;
        if self.step_m > T::zero() {
            min(self.step_m, max(wanted_m, T::zero()))
        } else {
            max(self.step_m, min(wanted_m, T::zero()))
        }
    }

    /// Follows the motor without driving it.
    #[inline(always)]
    pub fn track(&mut self, pulled_m: T) {
        let predicted = self.tracked_m + self.speed_m_per_s * self.gains.tick_s;
        let off = pulled_m - predicted;
        self.tracked_m = predicted + self.gains.track_position * off;
        self.speed_m_per_s += self.gains.track_speed * off;
    }

    /// Turns at a voltage, V, and is led nowhere.
    pub fn apply_voltage(&mut self, voltage_v: T, pulled_m: T) {
        self.rest(pulled_m);
        self.voltage_v = voltage_v;
        self.voltage_sum_v += voltage_v;
    }

    /// Adds to the voltage of this tick, V, without the servo's knowledge.
    pub fn add_voltage(&mut self, added_v: T) {
        self.voltage_v += added_v;
        self.voltage_sum_v += added_v;
    }

    /// Goes on from the voltage that another controller of the same motor has applied: the integral becomes what it had to be.
    pub fn adopt_voltage(&mut self, applied_v: T) {
        self.integral_v += applied_v - self.voltage_v;
        self.voltage_v = applied_v;
    }

    /// One tick: the duty. Call [`Self::track`] first.
    #[inline(always)]
    pub fn drive(&mut self, input: &AxisInput<T>) -> T {
        let gains = &self.gains;
        self.reference_m += self.step_m;
        let error = self.reference_m - input.pulled_m;
        let resting = self.step_m.abs() <= gains.still_step_m && error.abs() <= gains.dead_band_m;
        let wanted = if resting {
            T::zero()
        } else {
            self.step_m * gains.per_tick + gains.position * error
        };
        let wanted = clamp_symmetric(wanted, gains.speed_max);
        // The nearer to the maximum tension, the slower the pull; above it the tendon is paid out.
        let room_n = input.f_max_n - input.tension_n;
        let fastest = clamp_symmetric(room_n * gains.m_per_s_per_n, gains.speed_max);
        if wanted > fastest {
            // The reference stays near the motor: what the tension does not allow does not add up.
            let ahead = T::from(LIMITED_AHEAD_M);
            self.reference_m = min(self.reference_m, input.pulled_m + ahead);
            // A motor that is held back so gets no voltage against friction.
            self.integral_v -= self.fed_v;
            self.fed_v = T::zero();
        }
        let wanted = min(wanted, fastest);
        let wanted = if input.pulled_m <= input.lowest_m {
            max(wanted, T::zero())
        } else {
            wanted
        };
        let missing = wanted - self.speed_m_per_s;
        let proportional = gains.back_emf * wanted + gains.speed * missing;
        let asked = proportional + self.integral_v;
        let induced = gains.back_emf * self.speed_m_per_s;
        // The current's bounds first: an encoder that jumps shows a speed whose induced voltage is beyond any supply.
        let low = induced - gains.current_v;
        let high = induced + gains.current_v;
        let voltage = clamp_symmetric(min(max(asked, low), high), gains.duty_max * input.supply_v);
        // Anti-windup: the integral does not grow further into a limit of the voltage.
        let saturated =
            (asked > voltage && missing > T::zero()) || (asked < voltage && missing < T::zero());
        if resting {
            // The screw holds by itself.
            self.integral_v *= T::from(RESTING_DECAY);
            self.fed_v *= T::from(RESTING_DECAY);
        } else if !saturated {
            self.integral_v += gains.integral * missing;
        }
        self.voltage_v = voltage;
        self.voltage_sum_v += voltage;
        voltage * input.duty_per_v
    }
}

#[cfg(test)]
mod tests;
