//! The rules by which gains and limits follow from the motors.

use super::{Basis, HOMING_MAX_N, MotorGains, ServoLoop, TOUCH_N, two_digits_below};
use leg_firmware::control::{FRICTION_ALLOWANCE, PULL_ALLOWANCE};
use leg_firmware::settings::{Field, POSITION_GAIN_MAX_PER_S, Servo};
use std::f64::consts::TAU;

/// How one gain is derived.
pub(crate) struct Rule {
    /// The section below `control`.
    pub section: &'static str,
    pub key: &'static str,
    /// What of the three motors it is.
    pub of_all: OfAll,
    /// The formula as a user reads it, by the keys that it uses.
    pub formula: &'static str,
    /// Whether the number stands as it comes out; else with two digits.
    pub exact: bool,
    pub formula_value: fn(&Basis, &MotorGains) -> f64,
}

/// What of the three motors a rule is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OfAll {
    /// Each motor has its own.
    Each,
    /// What the motor allows that allows the least.
    Least,
    /// What the motor asks that asks the most.
    Greatest,
}

impl OfAll {
    /// As a user reads it, where the motors differ.
    pub const fn words(self) -> Option<&'static str> {
        match self {
            Self::Each => None,
            Self::Least => Some("the least of the three motors"),
            Self::Greatest => Some("the greatest of the three motors"),
        }
    }
}

/// For a rule whose key is none, which a test excludes.
pub(super) const NO_FIELD: Field<f64> = Field::new("", "", "", [0.0, f64::MAX], 0.0);

/// Time for which a motor has to bear the highest current of its servo, s: twenty times what the monitors need to end it.
pub(crate) const BORNE_S: f64 = 1.0;

/// Time for which a tendon that is found taut is pulled on, s: the filter of its tension and the servo's brake.
const STOPPED_S: f64 = 0.004;

/// A usual move, rad: 15°.
const SET_OUT_RAD: f64 = 0.262;

/// Part of the phase in which a servo is not near to ringing, degrees.
pub(crate) const MARGIN_DEG: f64 = 45.0;

macro_rules! rules {
    ($($of_all:ident $section:ident.$key:ident = $formula:literal $($exact:ident)?, $value:expr;)*) => {
        pub(crate) const RULES: &[Rule] = &[$(Rule {
            section: stringify!($section),
            key: stringify!($key),
            of_all: OfAll::$of_all,
            formula: $formula,
            exact: rules!(@exact $($exact)?),
            formula_value: $value,
        },)*];
    };
    (@exact) => { false };
    (@exact exact) => { true };
}

rules! {
    Each servo.resistance_ohm = "resistance_ohm" exact,
        |basis, _| basis.actuator.resistance_ohm;
    Each servo.back_emf_v_s_per_m = "2π gear_ratio torque_constant_nm_per_a / lead_m" exact,
        |basis, _| basis.actuator.back_emf_v_s_per_m();
    Each servo.friction_a = "2.6 friction_nm / torque_constant_nm_per_a, at least 0.005 current_range_a",
        |basis, _| friction_a(basis);
    Each servo.pull_a_per_n = "1.05 lead_m / (2π gear_ratio gear_efficiency screw_efficiency torque_constant_nm_per_a)",
        |basis, _| PULL_ALLOWANCE * basis.actuator.pull_a_per_n();
    Each servo.current_a = "2 (friction_a + pull_a_per_n f_max_n) / driven_part, at most 0.45 current_range_a, 0.7 duty_max supply_v / (driven_part resistance_ohm), up to 0.94 of it where 1.1 of the pull takes more, and what continuous_a and thermal_time_s bear for 1 s",
        current_a;
    Each servo.speed_m_per_s = "0.95 (duty_max supply_v - resistance_ohm (friction_a + pull_a_per_n f_max_n)) / back_emf_v_s_per_m, at most 0.03",
        |basis, gains| (0.95 * reachable_m_per_s(basis, gains)).min(0.03);
    Each servo.position_gain_per_s = "the highest at which speed and position loop keep a phase margin of 45°, at most 120",
        |basis, gains| two_digits_below(ServoLoop::new(&basis.actuator, &gains.servo).highest_gain_per_s(MARGIN_DEG)).min(POSITION_GAIN_MAX_PER_S.into());
    Each servo.speed_gain_v_s_per_m = "4.5 position_gain_per_s × 2π gear_ratio resistance_ohm inertia_kg_m2 / (torque_constant_nm_per_a lead_m)",
        |basis, gains| ServoLoop::speed_gain_v_s_per_m(&basis.actuator, f64::from(gains.servo.position_gain_per_s));
    Each servo.integral_time_s = "2.4 / position_gain_per_s",
        |_, gains| ServoLoop::integral_time_s(f64::from(gains.servo.position_gain_per_s));
    Each servo.play_m = "backlash_rad lead_m / 2π" exact,
        |basis, _| basis.actuator.play_m();
    Each servo.dead_band_m = "1.8 counts, at least 2e-7: lead_m / (gear_ratio counts_per_turn) is a count",
        |basis, _| (1.8 * basis.m_per_count).max(2e-7);
    Least motion.speed_rad_per_s = "0.9 servo.speed_m_per_s / the longest lever of a tendon, at most 0.8",
        |basis, gains| (0.9 * f64::from(gains.servo.speed_m_per_s) / basis.lever_m.max(1e-9)).min(0.8);
    Least homing.touch_n = "what lifts the leg, and stretches a tendon, by 2/3 of homing.release_m, at most 2",
        |basis, gains| touch_n(basis, gains).min(TOUCH_N);
    Greatest homing.settle_time_s = "2.7 × the leg's inertia / motion.joint_damping_nm_s_per_rad, at least 1.5 and at most 10",
        |basis, gains| settle_time_s(basis, gains);
    Greatest homing.average_time_s = "a period of the leg's swing by its weight and its joint, at least 0.7 and at most 5",
        |basis, _| (TAU * (basis.inertia_kg_m2 / basis.hanging_nm_per_rad).sqrt()).clamp(0.7, 5.0);
    Least homing.speed_m_per_s = "servo.speed_m_per_s / 3, at most 0.01, what servo.current_a gives the rotor in 5 ms, and what pulls a tendon from touch_n to homing.f_max_n in 4 ms",
        |basis, gains| homed_m_per_s(basis, gains).min(0.01).min(stopped_m_per_s(basis, gains));
    Least motion.acceleration_rad_per_s2 = "what a quarter of servo.current_a gives the rotor / the longest lever of a tendon, and what stretches a tendon by homing.speed_m_per_s as a move of 15° sets out with f_min_n and 0.9 kg, at most 4",
        |basis, gains| acceleration_rad_per_s2(basis, gains);
    Least homing.f_max_n = "tendon.f_max_n, at most 15" exact,
        |basis, _| basis.f_max_n.min(HOMING_MAX_N);
    Least motion.pretension_rate_n_per_s = "0.8 homing.speed_m_per_s × the least stiffness of a tendon between f_min_n and pretension_n, at most 120",
        |basis, gains| (0.8 * f64::from(gains.homing.speed_m_per_s) * basis.least_stiffness_n_per_m).min(120.0);
    Least limits.ramp_m_per_s = "homing.speed_m_per_s / 2",
        |_, gains| 0.5 * f64::from(gains.homing.speed_m_per_s);
    Greatest limits.relax_travel_m = "1.5 × (what a tendon stretches at f_max_n + play_m), at least 0.005",
        |basis, gains| (1.5 * (basis.stretch_m + f64::from(gains.servo.play_m))).max(5e-3);
    Greatest limits.taut_time_s = "1.5 homing.release_m or 1.2 relax_travel_m, whichever is more, / ramp_m_per_s, at least 5 and at most 600",
        |_, gains| taut_time_s(gains);
    Greatest limits.current_a = "2 servo.current_a, at most 0.9 current_range_a",
        |basis, gains| (2.0 * f64::from(gains.servo.current_a)).min(two_digits_below(0.9 * basis.least_current_range_a));
    Greatest limits.disagreement_a = "servo.current_a / 2, at most 0.9 × (servo.current_a - friction_a)",
        |_, gains| disagreement_a(&gains.servo);
    Greatest limits.still_time_s = "4 times what driven_part current_a needs to turn the rotor by a count, at least 0.005",
        |basis, gains| (4.0 * first_count_s(basis, gains)).max(0.005);
    Greatest limits.reversed_time_s = "0.9 resistance_ohm inertia_kg_m2 / torque_constant_nm_per_a², at least 0.005",
        |basis, _| (0.9 * basis.actuator.mechanical_time_s()).max(0.005);
    Greatest limits.supply_min_v = "0.75 supply_v",
        |basis, _| 0.75 * basis.actuator.supply_v;
    Greatest limits.supply_max_v = "1.25 supply_v",
        |basis, _| 1.25 * basis.actuator.supply_v;
}

/// Friction with what the gear adds and viscosity at speed; a current sensor is off by half a percent anyway.
fn friction_a(basis: &Basis) -> f64 {
    let actuator = &basis.actuator;
    let friction = FRICTION_ALLOWANCE * actuator.friction_nm / actuator.torque_constant_nm_per_a;
    friction.max(0.005 * actuator.current_range_a)
}

/// The current of a pull at the highest tension, A.
pub(crate) fn pulling_a(f_max_n: f64, gains: &MotorGains) -> f64 {
    let servo = &gains.servo;
    f64::from(servo.friction_a) + f64::from(servo.pull_a_per_n) * f_max_n
}

/// Twice the current of the hardest pull still counts as not driven: a motor that pulls is not taken for one that is jammed.
fn current_a(basis: &Basis, gains: &MotorGains) -> f64 {
    let driven_part = f64::from(gains.limits.driven_part);
    let asked = 2.0 * pulling_a(basis.f_max_n, gains) / driven_part;
    // One that is jammed gets no more voltage than the supply has, and one that pulls is not taken for one.
    let supply_v = f64::from(gains.servo.duty_max) * basis.actuator.supply_v;
    let resistance_ohm = f64::from(gains.servo.resistance_ohm);
    let pulling_v = resistance_ohm * pulling_a(basis.f_max_n, gains);
    let driven_v = (1.1 * pulling_v).clamp(0.7 * supply_v, 0.94 * supply_v);
    let driven = two_digits_below(driven_v / (driven_part * resistance_ohm));
    // Rounded down first: what comes out is rounded to the nearest, and must not be beyond.
    let seen = two_digits_below(0.45 * basis.actuator.current_range_a);
    let borne = basis
        .actuator
        .current_borne_a(BORNE_S)
        .map(two_digits_below);
    asked
        .min(seen)
        .min(driven)
        .min(borne.unwrap_or(f64::INFINITY))
}

/// How fast a motor pulls its tendon at the highest tension and the nominal supply, m/s.
pub(crate) fn reachable_m_per_s(basis: &Basis, gains: &MotorGains) -> f64 {
    let servo = &gains.servo;
    let dropped_v = f64::from(servo.resistance_ohm) * pulling_a(basis.f_max_n, gains);
    let left_v = f64::from(servo.duty_max) * basis.actuator.supply_v - dropped_v;
    left_v / f64::from(servo.back_emf_v_s_per_m).max(1e-9)
}

/// The speed to which the servo's current brings a motor in 5 ms, m/s: one that starts for longer is taken for one that hauls at
/// a taut tendon.
fn started_m_per_s(basis: &Basis, gains: &MotorGains) -> f64 {
    let free_a = f64::from(gains.servo.current_a) - f64::from(gains.servo.friction_a);
    5e-3 * rotor_m_per_s2(basis, free_a)
}

/// The speed with which a motor homes by what it can do itself, m/s.
pub(crate) fn homed_m_per_s(basis: &Basis, gains: &MotorGains) -> f64 {
    let third = f64::from(gains.servo.speed_m_per_s) / 3.0;
    third.min(started_m_per_s(basis, gains))
}

/// The tension of a tendon that has lifted the leg by so much that paying it out by `release_m` makes it slack again, with half as much to spare, N. More, and
/// homing fails, or finds a wrong zero (`wide_and_light_legs_find_their_zero`).
pub(crate) fn touch_n(basis: &Basis, gains: &MotorGains) -> f64 {
    let lifted_m = f64::from(gains.homing.release_m) / 1.5 - basis.touch_stretch_m;
    lifted_m / basis.lift_m_per_n.max(1e-12)
}

/// A leg that is averaged while it swings has a wrong zero (`a_long_leg_finds_its_zero`). The amplitude falls to a quarter in this time.
fn settle_time_s(basis: &Basis, gains: &MotorGains) -> f64 {
    let damping = f64::from(gains.motion.joint_damping_nm_s_per_rad);
    (2.7 * basis.inertia_kg_m2 / damping.max(1e-9)).clamp(1.5, 10.0)
}

/// The speed at which a motor that finds its tendon taut stops before it pulls with the highest tension of homing, m/s. Tendons of 3e5 to 1e6 N/m
/// were pulled for 2.5 to 3.5 ms (`stiff_tendons_are_homed_below_the_ceiling`).
pub(crate) fn stopped_m_per_s(basis: &Basis, gains: &MotorGains) -> f64 {
    let homing = &gains.homing;
    let left_n = f64::from(homing.f_max_n).min(basis.f_max_n) - f64::from(homing.touch_n);
    left_n / (STOPPED_S * basis.homing_stiffness_n_per_m)
}

/// What a current that nothing else needs gives a rotor, as an acceleration of the tendon, m/s².
fn rotor_m_per_s2(basis: &Basis, current_a: f64) -> f64 {
    let actuator = &basis.actuator;
    let acceleration = current_a * actuator.torque_constant_nm_per_a / actuator.inertia_kg_m2;
    acceleration * actuator.m_per_rad()
}

/// A move sets out with a jerk, by which the moment of its inertia, and of that of a payload that may hang on it, stretches its tendons at a speed: one that a motor cannot start with keeps it behind, and it
/// drives with all that its servo gives (`drawn_rigs_with_slow_motors_work`).
fn acceleration_rad_per_s2(basis: &Basis, gains: &MotorGains) -> f64 {
    let lever_m = basis.lever_m.max(1e-9);
    let rotor = rotor_m_per_s2(basis, 0.25 * f64::from(gains.servo.current_a)) / lever_m;
    // Two of three tendons share the moment.
    let stiffness_nm = 1.5 * lever_m * basis.least_stiffness_n_per_m;
    let jerk = f64::from(gains.homing.speed_m_per_s) * stiffness_nm / basis.moved_inertia_kg_m2;
    // A quintic over an angle D in a time T accelerates by 10/√3 D/T² at the most, and begins with a jerk of 60 D/T³.
    let quintic = 10.0 / 3.0_f64.sqrt();
    let stretched = (jerk * SET_OUT_RAD.sqrt() / 60.0).powf(2.0 / 3.0) * quintic;
    rotor.min(stretched).min(4.0)
}

/// Homing pays each tendon out by a step until it is slack, and a leg that is relaxed pays it out by the travel for that: so far at most it is taken
/// up again, before the tensions rise.
fn taut_time_s(gains: &MotorGains) -> f64 {
    let released_m = 1.5 * f64::from(gains.homing.release_m);
    let relaxed_m = 1.2 * f64::from(gains.limits.relax_travel_m);
    let taken_up_s = released_m.max(relaxed_m) / f64::from(gains.limits.ramp_m_per_s);
    taken_up_s.clamp(5.0, 600.0)
}

/// No current of a sound motor differs by half of the most that is driven; one beyond what friction leaves of it is never seen.
fn disagreement_a(servo: &Servo) -> f64 {
    let most_a = f64::from(servo.current_a) - f64::from(servo.friction_a);
    (0.5 * f64::from(servo.current_a)).min(two_digits_below(0.9 * most_a))
}

/// Time in which the least current that counts as driven turns a rotor at rest by a count, s.
fn first_count_s(basis: &Basis, gains: &MotorGains) -> f64 {
    let actuator = &basis.actuator;
    let current_a = f64::from(gains.limits.driven_part) * f64::from(gains.servo.current_a);
    let free_nm = actuator.torque_constant_nm_per_a * current_a - actuator.friction_nm;
    let acceleration = free_nm.max(1e-9) / actuator.inertia_kg_m2;
    let count_rad = TAU / actuator.counts_per_turn;
    (2.0 * count_rad / acceleration).sqrt()
}
