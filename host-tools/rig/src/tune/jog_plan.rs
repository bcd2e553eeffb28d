//! The jogs of one motor that are planned: their voltages and travels.

use super::error::TuneError;
use super::servo::ServoPlan;
use leg_firmware::board::timing::PWM_TOP;
use leg_firmware::control::{SHOWN_PART, step_range_m};
use leg_firmware::jog::JogDrive;
use leg_firmware::settings::{CurrentOutput, Servo, Settings};

/// How far a tendon is reeled in at the most until it pulls, beyond where the measurement began, m.
pub(super) const REEL_MAX_M: f32 = 0.012;

/// Travel between two readings of the tension, m.
pub(super) const STEP_M: f32 = 1e-3;

/// Travels of the jogs, m: a shorter one does not come up to speed.
pub(super) const TRAVEL_MIN_M: f32 = 4e-4;
const TRAVEL_MAX_M: f32 = 4e-3;

/// Travel of a jog against a tension, m.
pub(super) const LOADED_TRAVEL_M: f32 = 2e-3;

/// How far a tendon is paid out at the most until it is slack, m: as far as a measurement that was stopped may have reeled it in.
pub(super) const PAY_OUT_MAX_M: f32 = REEL_MAX_M + LOADED_TRAVEL_M;

/// Part of the highest tension of a jog from which on the loaded jogs begin: half of it is left to them.
pub(super) const LOADED_PART: f32 = 0.4;

/// Slowest jog, m/s: a screw sticks and slips where it is slower.
const SLOWEST_M_PER_S: f32 = 8e-4;

/// Fastest jog of a tendon that pulls, m/s: it goes through its tensions in a second.
const LOADED_M_PER_S: f32 = 2.5e-3;

/// Part of the highest voltage of a jog that is used: the rest is for a resistance that is greater than configured.
const VOLTAGE_PART: f32 = 0.9;

/// Part of the shortest pulse that a current output shows by which the lowest voltage is above it, where it does not show shorter ones.
const SHOWN_MARGIN: f32 = 0.05;

/// Voltages without a tension.
const FREE_VOLTAGES: u16 = 5;

/// Time for which a jog turns on when it is up to speed, s: current and speed are means over that time.
const STEADY_S: f32 = 0.4;

/// Time before that in which it goes half of its speed, on the mean, s: the rise of the voltage, and a half more.
const RISE_S: f32 = 0.1;

/// The voltages and travels of the jogs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JogPlan {
    /// The motor, from 1.
    pub motor: u8,
    /// Lowest and highest voltage, V.
    pub voltages_v: [f32; 2],
    /// Voltage against a tension, V.
    pub loaded_v: f32,
    /// Farthest that one jog turns, m.
    pub travel_m: f32,
    /// Highest tension, N.
    pub tension_max_n: f32,
    /// The jogs by the servo.
    pub(super) servo: ServoPlan,
    back_emf_v_s_per_m: f32,
    /// What a step of the timer changes, V.
    step_v: f32,
}

impl JogPlan {
    /// For a motor, from 1, with the settings of its board and its supply, V. A board gives its motors whole steps of its timer, so
    /// every voltage is one of those: else the motor would not get what it is taken to get.
    #[must_use]
    pub fn new(motor: u8, settings: &Settings, supply_v: f32) -> Self {
        let own = usize::from(motor).saturating_sub(1);
        let servo = settings.servos.get(own).unwrap_or(&Servo::DEFAULT);
        let friction_v = servo.resistance_ohm * servo.friction_a;
        let at = |speed: f32| friction_v + servo.back_emf_v_s_per_m * speed;
        let bound_v = settings.limits.driven_part * servo.current_a * servo.resistance_ohm;
        let highest_v = (VOLTAGE_PART * bound_v).min(at(TRAVEL_MAX_M / (STEADY_S + RISE_S)));
        let shown_v = match settings.current_outputs.each().get(own) {
            Some(CurrentOutput::MagnitudeWhenDriven) => {
                (1.0 + SHOWN_MARGIN) * SHOWN_PART * supply_v
            }
            _ => 0.0,
        };
        let mut plan = Self {
            motor,
            voltages_v: [
                at(SLOWEST_M_PER_S).min(0.5 * highest_v).max(shown_v),
                highest_v,
            ],
            loaded_v: at(LOADED_M_PER_S).max(shown_v).min(highest_v),
            step_v: supply_v / f32::from(PWM_TOP),
            travel_m: 0.0,
            servo: ServoPlan::default(),
            tension_max_n: settings.homing.f_max_n,
            back_emf_v_s_per_m: servo.back_emf_v_s_per_m,
        };
        plan.voltages_v = plan
            .voltages_v
            .map(|voltage_v| plan.whole_steps_v(voltage_v));
        plan.loaded_v = plan.whole_steps_v(plan.loaded_v);
        plan.travel_m = plan.travel_m(highest_v);
        plan.servo = ServoPlan::new(
            servo,
            highest_v,
            plan.travel_m,
            step_range_m(settings, servo),
        );
        plan
    }

    /// How far a jog at a voltage turns until it has been steady for long enough, m.
    pub(super) fn travel_m(&self, voltage_v: f32) -> f32 {
        // Without friction, so that it is long enough in any case.
        let speed = voltage_v / self.back_emf_v_s_per_m;
        (speed * (STEADY_S + RISE_S)).clamp(TRAVEL_MIN_M, TRAVEL_MAX_M)
    }

    pub(super) fn free_v(&self) -> impl Iterator<Item = f32> {
        let [low, high] = self.voltages_v;
        let step = (high - low) / f32::from(FREE_VOLTAGES - 1);
        (0..FREE_VOLTAGES).map(move |i| self.whole_steps_v(low + step * f32::from(i)))
    }

    fn whole_steps_v(&self, voltage_v: f32) -> f32 {
        (voltage_v / self.step_v).round() * self.step_v
    }

    /// What turns a motor that is only to come somewhere.
    pub(super) const fn slow(&self) -> JogDrive {
        JogDrive::Voltage(self.loaded_v)
    }

    /// How far the tendon is paid out and reeled in at the most beside where it began, m.
    #[must_use]
    pub fn reach_m(&self) -> [f32; 2] {
        let out_m = PAY_OUT_MAX_M + self.travel_m + self.servo.travel_m();
        [out_m, REEL_MAX_M + LOADED_TRAVEL_M]
    }

    /// Refuses a driver whose current output shows nothing at the voltages that a jog may have.
    pub(super) fn require_shown<E>(&self) -> Result<(), TuneError<E>> {
        let [low_v, high_v] = self.voltages_v;
        // The voltages are no numbers then.
        if self.step_v <= 0.0 {
            return Err(TuneError::undetermined(
                "the motors have no supply before a motor is jogged",
                "switch the supply of the motors on, and see that the emergency stop is released",
            ));
        }
        if low_v < high_v {
            return Ok(());
        }
        Err(TuneError::undetermined(
            format!(
                "the driver of motor {} shows a current from {low_v:.2} V on, and the jogs of its measurement have {high_v:.2} V at the most",
                self.motor
            ),
            "take the motor's constants from its data sheet: its `current_output` is \"magnitude_when_driven\", and shows no shorter pulses",
        ))
    }

    /// Refuses a leg whose other tendons pull: where one is paid out, they pull the leg to their side, and the more. Its own may pull by no
    /// more than a jog may, or it would not be reeled in again to where it was.
    pub(super) fn require_loose<E>(&self, tensions_n: &[f32; 3]) -> Result<(), TuneError<E>> {
        let most_n = |number| {
            if number == self.motor {
                self.tension_max_n
            } else {
                LOADED_PART * self.tension_max_n
            }
        };
        let mut tendons = (1_u8..).zip(tensions_n);
        match tendons.find(|&(number, &tension_n)| tension_n > most_n(number)) {
            Some((number, tension_n)) => Err(TuneError::undetermined(
                format!("tendon {number} pulls by {tension_n:.0} N before a motor is jogged"),
                "let the leg relax: `leg hold`, then `leg disarm`; before it is homed, pay its tendons out with `leg jog`",
            )),
            None => Ok(()),
        }
    }
}
