//! How far, how hard and how long a motor may be jogged.

use super::bounds::max;
use super::{Applied, SHOWN_PART};
use crate::jog::{JOG_TRAVEL_MAX_M, JogDemand, JogDrive, JogRefusal, SINE_PERIOD_TICKS};
use crate::settings::{Servo, Settings};
use leg_model::Scalar;

/// Time in which the voltage of a jog comes up, s: at once, the motor would draw more than any tension of a jog asks for.
pub const JOG_RISE_S: f32 = 0.1;

/// Slowest jog that is waited for, m/s. At ten times as much, the time ends jogs of a motor whose resistance is 1.8 times what is configured (`tests/suite/host/tune.rs`).
const SLOWEST_M_PER_S: f32 = 2e-4;

/// What a servo may drive by the highest current: the rest accelerates the rotor.
const SERVO_PART: f32 = 2.0;

/// The time for all that is beside the way, s: twenty times what the speed takes to become steady.
const GRACE_S: f32 = 1.0;

/// The longest time of any jog, s.
pub const JOG_TIME_MAX_S: f32 = longest_s(JOG_TRAVEL_MAX_M / SLOWEST_M_PER_S);

/// The longest time of a jog whose way takes `way_s` at the most that it may draw: twice that.
const fn longest_s(way_s: f32) -> f32 {
    JOG_RISE_S + GRACE_S + 2.0 * way_s
}

/// The shortest and the farthest step of the reference of a motor with this servo, m: 5 % of the shortest is its dead band, and the
/// farthest is half of what would be a fault.
#[must_use]
pub fn step_range_m(settings: &Settings, servo: &Servo) -> [f32; 2] {
    [20.0 * servo.dead_band_m, 0.5 * settings.limits.following_m]
}

/// The bounds of every jog of a motor, from the settings.
#[derive(Clone, Copy, Debug)]
pub struct JogBounds<T> {
    /// Voltage from which the monitors take a motor for driven, V.
    voltage_max_v: f32,
    /// Highest current: what the motor draws at the highest tension of homing, A. It is that of homing, too.
    pub current_max_a: T,
    /// Voltage that this current takes, V, and what the speed induces, V·s/m.
    dropped_v: f32,
    back_emf_v_s_per_m: f32,
    /// The shortest and the farthest step of a reference, m.
    step_range_m: [f32; 2],
}

impl<T: Scalar> JogBounds<T> {
    /// Those of the settings for a motor with this servo.
    pub fn new(settings: &Settings, servo: &Servo) -> Self {
        // With half more friction than the settings know.
        let current_max_a = 1.5 * servo.friction_a + servo.pull_a_per_n * settings.homing.f_max_n;
        Self {
            voltage_max_v: settings.limits.driven_part * servo.current_a * servo.resistance_ohm,
            current_max_a: current_max_a.into(),
            dropped_v: servo.resistance_ohm * current_max_a,
            back_emf_v_s_per_m: servo.back_emf_v_s_per_m,
            step_range_m: step_range_m(settings, servo),
        }
    }

    /// What a servo may put at the motor beyond what its speed induces, V: so a tendon is pulled by less than 80 N, however often a jog is
    /// repeated and whatever its load cell shows.
    pub fn driving_max_v(&self) -> f32 {
        SERVO_PART * self.dropped_v
    }

    /// The current that is compared with the highest one, A, at an output that does not show short pulses: below the shortest that it shows,
    /// what the voltage drives by resistance and counts where that is more than it reads.
    pub fn ceiling_a(&self, measured_a: T, applied: &Applied<T>, supply_v: T) -> T {
        if applied.voltage_v.abs() >= T::from(SHOWN_PART) * supply_v {
            return measured_a;
        }
        let a_per_v = self.current_max_a / T::from(self.dropped_v);
        max(measured_a.abs(), applied.driving_v.abs() * a_per_v)
    }

    /// Those of the motor that a demand is for, if its jog may begin.
    pub fn select(motors: &[Self; 3], demand: &JogDemand) -> Result<Self, JogRefusal> {
        let numbered = (1..).zip(motors);
        let mut own = numbered.filter(|(motor, _)| *motor == demand.motor);
        let (_, bounds) = own.next().ok_or(JogRefusal::Motor)?;
        bounds.check(demand)?;
        Ok(*bounds)
    }

    fn check(&self, demand: &JogDemand) -> Result<(), JogRefusal> {
        let travel_m = demand.travel_m.abs();
        let [shortest_m, farthest_m] = self.step_range_m;
        match demand.drive {
            JogDrive::ServoStep if !(travel_m >= shortest_m && travel_m <= farthest_m) => {
                Err(JogRefusal::Step)
            }
            JogDrive::ServoStep => Ok(()),
            _ if !(travel_m > 0.0 && travel_m <= JOG_TRAVEL_MAX_M) => Err(JogRefusal::Travel),
            JogDrive::Voltage(voltage_v)
                if !(voltage_v > 0.0 && voltage_v <= self.voltage_max_v) =>
            {
                Err(JogRefusal::Voltage)
            }
            JogDrive::Voltage(_) => Ok(()),
            JogDrive::ServoSine {
                speed_m_per_s,
                amplitude_v,
                period_ticks,
            } => {
                let [shortest, longest] = SINE_PERIOD_TICKS;
                let highest_v = amplitude_v + speed_m_per_s * self.back_emf_v_s_per_m;
                if !(speed_m_per_s > 0.0) {
                    Err(JogRefusal::Speed)
                } else if !(amplitude_v > 0.0 && highest_v <= self.voltage_max_v) {
                    Err(JogRefusal::Amplitude)
                } else if !(shortest..=longest).contains(&period_ticks) {
                    Err(JogRefusal::Period)
                } else {
                    Ok(())
                }
            }
        }
    }

    /// The longest time of a jog, s.
    pub fn time_max_s(&self, demand: &JogDemand) -> f32 {
        let speed_m_per_s = match demand.drive {
            JogDrive::Voltage(voltage_v) => (voltage_v - self.dropped_v) / self.back_emf_v_s_per_m,
            JogDrive::ServoStep => 0.0,
            JogDrive::ServoSine { speed_m_per_s, .. } => speed_m_per_s,
        };
        let slowest = SLOWEST_M_PER_S;
        let speed_m_per_s = if speed_m_per_s > slowest {
            speed_m_per_s
        } else {
            slowest
        };
        longest_s(demand.travel_m.abs() / speed_m_per_s)
    }
}
