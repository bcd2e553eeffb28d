//! The sections of gains and limits, and the calibration of the sensors: each value with its unit, range, default and meaning.

use super::Field;
use crate::fields;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

fields! {
    /// How the leg moves.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
    pub struct Motion: f32 {
        /// Fastest turn of the leg.
        speed_rad_per_s ["rad/s"]: 0.01..=20.0 = 0.8;
        /// Greatest change of that.
        acceleration_rad_per_s2 ["rad/s²"]: 0.01..=1e3 = 4.0;
        /// Greatest change of that: lower is smoother, and longer.
        jerk_rad_per_s3 ["rad/s³"]: 0.01..=1e5 = 100.0;
        /// Fastest change of the pretension.
        pretension_rate_n_per_s ["N/s"]: 0.1..=1e4 = 120.0;
        /// Time in which the compensation of the load comes and goes.
        load_time_s ["s"]: 1e-3..=60.0 = 0.6;
        /// Damping ratio that is asked of the tendons for the leg's first mode; 0 for none.
        damping_ratio ["1"]: 0.0..=0.5 = 0.25;
        /// Damping of the leg's joint, which a motion has to overcome.
        joint_damping_nm_s_per_rad ["N·m·s/rad"]: 0.0..=10.0 = 0.03;
        /// Damping of each tendon beside its stiffness: it carries a part of a tension that grows.
        tendon_damping_n_s_per_m ["N·s/m"]: 0.0..=1e4 = 200.0;
    }
}

fields! {
    /// How a motor follows.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
    pub struct Servo: f32 {
        /// Speed by error of the position: higher follows closer, until it rings.
        position_gain_per_s ["1/s"]: 1.0..=1e3 = 120.0;
        /// Voltage by error of the speed.
        speed_gain_v_s_per_m ["V·s/m"]: 1.0..=1e5 = 1800.0;
        /// Time in which the integral makes up for an error of the speed.
        integral_time_s ["s"]: 1e-3..=10.0 = 0.02;
        /// Voltage that the motor's speed induces, by the speed of the tendon.
        back_emf_v_s_per_m ["V·s/m"]: 0.0..=1e5 = 647.0;
        /// Resistance of the motor.
        resistance_ohm ["Ω"]: 0.01..=1e3 = 2.32;
        /// Current that friction takes without a tension.
        friction_a ["A"]: 0.0..=100.0 = 0.1;
        /// Current that a pull takes by the tension.
        pull_a_per_n ["A/N"]: 0.0..=10.0 = 0.006;
        /// Highest current that the voltage is let to drive.
        current_a ["A"]: 0.01..=100.0 = 4.0;
        /// Highest part of the supply.
        duty_max ["1"]: 0.05..=1.0 = 0.95;
        /// Fastest tendon.
        speed_m_per_s ["m/s"]: 1e-4..=1.0 = 0.03;
        /// An error of the position that is left alone: less than the play of the gear makes the motor hunt.
        dead_band_m ["m"]: 0.0..=1e-3 = 2e-7;
        /// Play of the gear, as travel of the tendon.
        play_m ["m"]: 0.0..=1e-3 = 2.3873242e-6;
        /// Part of a new reading of the counter that the tracked speed takes up.
        tracking ["1"]: 0.01..=1.0 = 0.4;
        /// Below the maximum tension by this much a tendon is pulled ever more slowly.
        f_max_band_n ["N"]: 0.1..=1e3 = 4.0;
    }
}

/// How many times faster than the position loop a servo's speed loop is, where the settings follow from a motor's data.
pub const SPEED_BY_POSITION: f32 = 4.5;

/// The highest gain of the position loop there, 1/s.
pub const POSITION_GAIN_MAX_PER_S: f32 = 120.0;

impl Servo {
    /// The most that the highest current accelerates the tendon by, m/s², as far as the gains tell it: that of the speed loop follows from the rotor's inertia.
    /// A speed loop that was made softer makes it seem more, and one that was made stiffer less.
    #[must_use]
    pub fn acceleration_m_per_s2(&self) -> f32 {
        let position_gain_per_s = self.position_gain_per_s.max(POSITION_GAIN_MAX_PER_S);
        let v_s2_per_m = self.speed_gain_v_s_per_m / (SPEED_BY_POSITION * position_gain_per_s);
        self.current_a * self.resistance_ohm / v_s2_per_m
    }
}

fields! {
    /// How pose and load are estimated.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
    pub struct Estimation: f32 {
        /// Time constant of the tensions.
        tension_time_s ["s"]: 1.25e-4..=1.0 = 4e-4;
        /// Time constant of each of the two filters of the load; with a first mode below 5 Hz the first one is slower by as much.
        load_time_s ["s"]: 1e-3..=10.0 = 0.15;
        /// Time in which the pretension is trimmed by the tensions.
        trim_time_s ["s"]: 1e-3..=100.0 = 0.5;
        /// Most that the pretension is trimmed.
        trim_max_n ["N"]: 0.1..=1e3 = 20.0;
    }
}

fields! {
    /// What is taken as a fault.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
    pub struct Limits: f32 {
        /// A tendon below this tension is slack.
        slack_n ["N"]: 0.1..=1e3 = 2.0;
        /// It is a fault after this time.
        slack_time_s ["s"]: 1.25e-4..=10.0 = 0.02;
        /// Above the maximum tension by this part, a tension is a fault.
        over_tension_part ["1"]: 0.0..=1.0 = 0.1;
        /// A change of a tension within a millisecond that is a fault.
        jump_n ["N"]: 0.1..=1e4 = 25.0;
        /// The most that forward kinematics may leave over.
        residual_m ["m"]: 1e-7..=0.1 = 1.5e-4;
        /// It is a fault after this time.
        residual_time_s ["s"]: 1.25e-4..=10.0 = 0.1;
        /// The most that the mean of what forward kinematics leaves over may change without a motion or a load that explains it.
        residual_change_m ["m"]: 1e-7..=0.1 = 9e-6;
        /// A load cell whose code has not changed for this time is stuck.
        stuck_time_s ["s"]: 1.25e-4..=10.0 = 0.02;
        /// A load cell whose code is not fresh for this time is stale.
        stale_time_s ["s"]: 1.25e-4..=10.0 = 1e-3;
        /// Farthest that a motor may stay behind.
        following_m ["m"]: 1e-6..=0.1 = 6e-4;
        /// A motor that is driven for this time without a count has lost its encoder or is jammed.
        still_time_s ["s"]: 1.25e-4..=10.0 = 0.005;
        /// Part of the servo's highest current from which it counts as driven.
        driven_part ["1"]: 0.01..=1.0 = 0.5;
        /// A motor that counts against its voltage for this time is reversed.
        reversed_time_s ["s"]: 1.25e-4..=10.0 = 0.005;
        /// Current of a motor that is a fault after 2 ms.
        current_a ["A"]: 0.01..=1e3 = 8.0;
        /// Motor current that differs from what tension and friction ask by this much.
        disagreement_a ["A"]: 0.01..=1e3 = 2.0;
        /// It is a fault after this time.
        disagreement_time_s ["s"]: 1.25e-4..=10.0 = 0.05;
        /// Highest temperature of the drivers.
        temperature_c ["°C"]: 0.0..=200.0 = 90.0;
        /// Lowest supply.
        supply_min_v ["V"]: 0.0..=1e3 = 18.0;
        /// Highest supply.
        supply_max_v ["V"]: 0.0..=1e3 = 30.0;
        /// Longest silence of the host while the leg homes, follows commands or jogs.
        command_time_s ["s"]: 1.25e-4..=100.0 = 0.2;
        /// Frames that could not be read before the link is a fault.
        bad_frames ["1"]: 1.0..=1e3 = 3.0;
        /// Speed at which tendons are paid out when they have to be relaxed.
        ramp_m_per_s ["m/s"]: 1e-5..=0.1 = 5e-3;
        /// Longest time from an arm until every tendon pulls.
        taut_time_s ["s"]: 0.01..=600.0 = 5.0;
        /// Farthest that a tendon is paid out when it has to be relaxed.
        relax_travel_m ["m"]: 1e-6..=0.1 = 5e-3;
    }
}

fields! {
    /// How the zero is found: the leg hangs free, with no payload, and one tendon after the other is reeled in.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
    pub struct Homing: f32 {
        /// How far every tendon is paid out at a time: until that changes no tension any more.
        release_m ["m"]: 1e-4..=0.5 = 0.004;
        /// Speed of paying out and reeling in.
        speed_m_per_s ["m/s"]: 1e-5..=0.1 = 0.01;
        /// Time in which the slack load cells are averaged.
        tare_time_s ["s"]: 1e-3..=10.0 = 0.25;
        /// Greatest offset of a slack load cell that is taken as its zero.
        tare_max_n ["N"]: 0.0..=1e3 = 10.0;
        /// Tension at which a tendon is taken as taut.
        touch_n ["N"]: 0.1..=100.0 = 2.0;
        /// Time that the leg is given to come to rest then.
        settle_time_s ["s"]: 1e-3..=60.0 = 1.5;
        /// Time in which tension and position are averaged.
        average_time_s ["s"]: 1e-3..=60.0 = 0.7;
        /// Highest tension while homing.
        f_max_n ["N"]: 0.1..=1e3 = 15.0;
        /// Farthest that a tendon is paid out until it is slack, and then reeled in.
        travel_m ["m"]: 1e-4..=1.0 = 0.05;
    }
}

fields! {
    /// Calibration of one axis: its encoder, its load cell and its motor's current.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
    pub struct AxisCalibration: f32 {
        /// How far one encoder count pulls the tendon in. With finer counts a fast motor outruns the counter of 16 bits.
        m_per_count ["m"]: 1e-9..=1e-4 = 1.11e-7 signed;
        /// Tension by code of the load cell: a code up has to be more tension.
        cell_n_per_code ["N"]: 1e-6..=10.0 = 3.8156e-3;
        /// Code of the load cell without tension.
        cell_zero_code ["1"]: 0.0..=65520.0 = 5241.6;
        /// Current by code of the motor's current.
        current_a_per_code ["A"]: 1e-7..=1.0 = 3.663e-4;
    }
    and {
        /// Length of the tendon without tension when the board started (counter at zero), m; none until it is homed.
        unstretched_at_zero_m: Option<f32> = None;
    }
}

/// [`AxisCalibration::unstretched_at_zero_m`] where there is one.
pub(super) const UNSTRETCHED: Field = Field {
    name: "unstretched_at_zero_m",
    unit: "m",
    meaning: "Length of the tendon without tension when the board started.",
    // As far as the model knows lengths.
    range: [0.0, 100.0],
    signed: true,
    default: 0.0,
};

fields! {
    /// Scales of what all axes share.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
    pub struct BoardCalibration: f32 {
        /// Supply voltage by code.
        supply_v_per_code ["V"]: 1e-5..=0.1 = 5.4945e-4;
        /// Temperature by code.
        temperature_c_per_code ["°C"]: 1e-4..=0.1 = 3.0525e-3;
        /// Temperature at code 0.
        temperature_at_zero_c ["°C"]: -300.0..=20.0 = -40.0;
    }
}
