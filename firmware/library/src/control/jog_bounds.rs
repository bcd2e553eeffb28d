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
    /// What of that the tension asks for, A: the rest is friction.
    pub pull_max_a: T,
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
        let pull_max_a = servo.pull_a_per_n * settings.homing.f_max_n;
        let current_max_a = 1.5 * servo.friction_a + pull_max_a;
        Self {
            voltage_max_v: settings.limits.driven_part * servo.current_a * servo.resistance_ohm,
            current_max_a: current_max_a.into(),
            pull_max_a: pull_max_a.into(),
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

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{JOG_TIME_MAX_S, JogBounds};
    use crate::control::Applied;
    use crate::jog::{JOG_TRAVEL_MAX_M, JogDemand, JogDrive, JogRefusal, SINE_PERIOD_TICKS};
    use crate::settings::Settings;

    fn motors() -> [JogBounds<f64>; 3] {
        let settings = Settings::table_1().unwrap();
        settings
            .servos
            .each_ref()
            .map(|servo| JogBounds::new(&settings, servo))
    }

    /// What becomes of a demand on the second motor.
    fn asked(travel_m: f32, drive: JogDrive) -> Result<(), JogRefusal> {
        let demand = JogDemand {
            motor: 2,
            travel_m,
            drive,
        };
        JogBounds::select(&motors(), &demand).map(|_| ())
    }

    fn just_more(value: f32) -> f32 {
        value * 1.0001
    }

    #[test]
    fn a_motor_is_one_of_three() {
        for motor in 0..=5 {
            let demand = JogDemand {
                motor,
                travel_m: 1e-3,
                drive: JogDrive::Voltage(0.1),
            };
            let selected = JogBounds::select(&motors(), &demand).map(|_| ());
            let expected = if (1..=3).contains(&motor) {
                Ok(())
            } else {
                Err(JogRefusal::Motor)
            };
            assert_eq!(selected, expected, "{motor}");
        }
    }

    /// A travel of no more than 10 mm either way, and a voltage of which the monitors do not take the motor for driven.
    #[test]
    fn travel_and_voltage_have_bounds() {
        let highest_v = motors()[1].voltage_max_v;
        for (voltage_v, expected) in [
            (highest_v, Ok(())),
            (0.01 * highest_v, Ok(())),
            (just_more(highest_v), Err(JogRefusal::Voltage)),
            (0.0, Err(JogRefusal::Voltage)),
            (-0.1, Err(JogRefusal::Voltage)),
            (f32::NAN, Err(JogRefusal::Voltage)),
        ] {
            let found = asked(1e-3, JogDrive::Voltage(voltage_v));
            assert_eq!(found, expected, "{voltage_v} V");
        }
        for (travel_m, expected) in [
            (JOG_TRAVEL_MAX_M, Ok(())),
            (-JOG_TRAVEL_MAX_M, Ok(())),
            (just_more(JOG_TRAVEL_MAX_M), Err(JogRefusal::Travel)),
            (-just_more(JOG_TRAVEL_MAX_M), Err(JogRefusal::Travel)),
            (0.0, Err(JogRefusal::Travel)),
            (f32::NAN, Err(JogRefusal::Travel)),
        ] {
            let found = asked(travel_m, JogDrive::Voltage(highest_v));
            assert_eq!(found, expected, "{travel_m} m");
        }
    }

    /// A step of the reference is no more than half of what would be a fault, and not hidden by the dead band.
    #[test]
    fn a_step_has_bounds_of_its_own() {
        let settings = Settings::table_1().unwrap();
        let highest_m = 0.5 * settings.limits.following_m;
        let lowest_m = 20.0 * settings.servos[1].dead_band_m;
        for (travel_m, expected) in [
            (highest_m, Ok(())),
            (-highest_m, Ok(())),
            (just_more(highest_m), Err(JogRefusal::Step)),
            (-just_more(highest_m), Err(JogRefusal::Step)),
            (lowest_m, Ok(())),
            (0.999 * lowest_m, Err(JogRefusal::Step)),
            (0.0, Err(JogRefusal::Step)),
        ] {
            assert_eq!(asked(travel_m, JogDrive::ServoStep), expected);
        }
    }

    /// The sine and what the speed induces are together no more than any voltage.
    #[test]
    fn a_sine_has_bounds() {
        let bounds = motors()[1];
        let [shortest, longest] = SINE_PERIOD_TICKS;
        let speed_m_per_s = 1e-3;
        let highest_v = bounds.voltage_max_v - speed_m_per_s * bounds.back_emf_v_s_per_m;
        let fine = (speed_m_per_s, 0.5 * highest_v, shortest);
        for ((speed_m_per_s, amplitude_v, period_ticks), expected) in [
            (fine, Ok(())),
            ((fine.0, 0.999 * highest_v, longest), Ok(())),
            ((0.0, fine.1, fine.2), Err(JogRefusal::Speed)),
            ((-fine.0, fine.1, fine.2), Err(JogRefusal::Speed)),
            ((fine.0, 0.0, fine.2), Err(JogRefusal::Amplitude)),
            (
                (fine.0, 1.001 * highest_v, fine.2),
                Err(JogRefusal::Amplitude),
            ),
            ((fine.0, fine.1, shortest - 1), Err(JogRefusal::Period)),
            ((fine.0, fine.1, longest + 1), Err(JogRefusal::Period)),
        ] {
            let drive = JogDrive::ServoSine {
                speed_m_per_s,
                amplitude_v,
                period_ticks,
            };
            assert_eq!(asked(1e-3, drive), expected, "{drive:?}");
        }
    }

    /// Twice the time of the way at its speed, with 1.1 s for all else. No way is slower than 0.2 mm/s: 10 mm take 101.1 s at the most.
    #[test]
    fn a_jog_has_time_for_twice_its_way() {
        let bounds = motors()[1];
        let time_s = |travel_m, drive| {
            bounds.time_max_s(&JogDemand {
                motor: 2,
                travel_m,
                drive,
            })
        };
        let sine = |speed_m_per_s| JogDrive::ServoSine {
            speed_m_per_s,
            amplitude_v: 0.1,
            period_ticks: 100,
        };
        let turning_v = bounds.dropped_v + 2e-3 * bounds.back_emf_v_s_per_m;
        for (travel_m, drive, expected_s) in [
            (4e-3, sine(1e-3), 1.1 + 8.0),
            (-4e-3, sine(1e-3), 1.1 + 8.0),
            (4e-3, sine(1e-5), 1.1 + 40.0),
            (4e-3, JogDrive::Voltage(turning_v), 1.1 + 4.0),
            (4e-3, JogDrive::Voltage(0.1 * bounds.dropped_v), 1.1 + 40.0),
            (1e-4, JogDrive::ServoStep, 1.1 + 1.0),
            (JOG_TRAVEL_MAX_M, sine(1e-5), JOG_TIME_MAX_S),
        ] {
            let found_s = time_s(travel_m, drive);
            assert!(
                (found_s - expected_s).abs() < 1e-2,
                "{drive:?}: {found_s} s"
            );
        }
        assert!((JOG_TIME_MAX_S - 101.1).abs() < 1e-3);
    }

    /// A short pulse does not show: what the voltage drives counts there, if it is more. A long one shows what it is.
    #[test]
    fn a_current_that_does_not_show_is_what_the_voltage_drives() {
        let bounds = motors()[1];
        let (most_a, dropped_v) = (bounds.current_max_a, f64::from(bounds.dropped_v));
        for (voltage_v, driving_v, measured_a, expected_a) in [
            (1.0, dropped_v, 0.0, most_a),
            (-1.0, -dropped_v, 0.0, most_a),
            (1.0, 0.5 * dropped_v, -0.8 * most_a, 0.8 * most_a),
            (2.5, dropped_v, 0.1, 0.1),
            (-2.5, -dropped_v, -0.1, -0.1),
        ] {
            let applied = Applied {
                voltage_v,
                driving_v,
            };
            let found_a = bounds.ceiling_a(measured_a, &applied, 24.0);
            assert!((found_a - expected_a).abs() < 1e-6, "{voltage_v} V");
        }
    }
}
