//! The sections of gains and limits.

use super::section::{Field, OutOfRange, section};

section! {
    /// How the leg moves.
    0 Motion {
        /// Fastest turn of the leg, rad/s.
        speed_rad_per_s: 0.01..=20.0 = 0.8;
        /// Greatest change of that, rad/s².
        acceleration_rad_per_s2: 0.01..=1e3 = 4.0;
        /// Greatest change of that, rad/s³: lower is smoother, and longer.
        jerk_rad_per_s3: 0.01..=1e5 = 100.0;
        /// Fastest change of the pretension, N/s.
        pretension_rate_n_per_s: 0.1..=1e4 = 120.0;
        /// Time in which the compensation of the load comes and goes, s.
        load_time_s: 1e-3..=60.0 = 0.6;
    }
}

section! {
    /// How a motor follows.
    1 Servo {
        /// Speed by error of the position, 1/s: higher follows closer, until it rings.
        position_gain_per_s: 1.0..=1e3 = 120.0;
        /// Voltage by error of the speed, V·s/m.
        speed_gain_v_s_per_m: 1.0..=1e5 = 1800.0;
        /// Time in which the integral makes up for an error of the speed, s.
        integral_time_s: 1e-3..=10.0 = 0.02;
        /// Voltage that the motor's speed induces, by the speed of the tendon, V·s/m.
        back_emf_v_s_per_m: 0.0..=1e5 = 647.0;
        /// Resistance of the motor, Ω.
        resistance_ohm: 0.01..=1e3 = 2.32;
        /// Current that friction takes without a tension, A.
        friction_a: 0.0..=100.0 = 0.1;
        /// Current that a pull takes by the tension, A/N.
        pull_a_per_n: 0.0..=10.0 = 0.006;
        /// Highest current that the voltage is let to drive, A.
        current_a: 0.01..=100.0 = 4.0;
        /// Highest part of the supply.
        duty_max: 0.05..=1.0 = 0.95;
        /// Fastest tendon, m/s.
        speed_m_per_s: 1e-4..=1.0 = 0.03;
        /// An error of the position that is left alone, m: less than the play of the gear makes the motor hunt.
        dead_band_m: 0.0..=1e-3 = 2e-7;
        /// Part of a new reading of the counter that the tracked speed takes up.
        tracking: 0.01..=1.0 = 0.3;
        /// Below the maximum tension by this much a tendon is pulled ever more slowly, N.
        f_max_band_n: 0.1..=1e3 = 4.0;
    }
}

section! {
    /// How pose and load are estimated.
    2 Estimation {
        /// Time constant of the tensions, s.
        tension_time_s: 1.25e-4..=1.0 = 4e-4;
        /// Time constant of each of the two filters of the load, s: faster ones meet the leg's own swing.
        load_time_s: 1e-3..=10.0 = 0.15;
        /// Time in which the pretension is trimmed by the tensions, s.
        trim_time_s: 1e-3..=100.0 = 0.5;
        /// Most that the pretension is trimmed, N.
        trim_max_n: 0.0..=1e3 = 20.0;
        /// Sine of the tilt from which the payload is told from the load; nearer to the vertical the last one stands.
        payload_sine: 0.01..=1.0 = 0.15;
    }
}

section! {
    /// What is taken as a fault.
    3 Limits {
        /// A tendon below this tension is slack, N.
        slack_n: 0.1..=1e3 = 2.0;
        /// It is a fault after this time, s.
        slack_time_s: 1.25e-4..=10.0 = 0.02;
        /// Above the maximum tension by this part, a tension is a fault.
        over_tension_part: 0.0..=1.0 = 0.1;
        /// A change of a tension within a millisecond that is a fault, N.
        jump_n: 0.1..=1e4 = 25.0;
        /// The most that forward kinematics may leave over, m.
        residual_m: 1e-7..=0.1 = 1.5e-4;
        /// It is a fault after this time, s.
        residual_time_s: 1.25e-4..=10.0 = 0.1;
        /// A load cell whose code has not changed for this time is stuck, s.
        stuck_time_s: 1.25e-4..=10.0 = 0.02;
        /// A load cell whose code is not fresh for this time is stale, s.
        stale_time_s: 1.25e-4..=10.0 = 1e-3;
        /// Farthest that a motor may stay behind, m.
        following_m: 1e-6..=0.1 = 6e-4;
        /// A motor that is driven for this time without a count has lost its encoder or is jammed, s.
        still_time_s: 1.25e-4..=10.0 = 0.005;
        /// Part of the servo's highest current from which it counts as driven.
        driven_part: 0.01..=1.0 = 0.5;
        /// A motor that counts against its voltage for this time is reversed, s.
        reversed_time_s: 1.25e-4..=10.0 = 0.005;
        /// Current of a motor that is a fault after 2 ms, A.
        current_a: 0.01..=1e3 = 8.0;
        /// Motor current that differs from what tension and friction ask by this much, A.
        disagreement_a: 0.01..=1e3 = 2.0;
        /// It is a fault after this time, s.
        disagreement_time_s: 1.25e-4..=10.0 = 0.05;
        /// Highest temperature of the drivers, °C.
        temperature_c: 0.0..=200.0 = 90.0;
        /// Lowest supply, V.
        supply_min_v: 0.0..=1e3 = 18.0;
        /// Highest supply, V.
        supply_max_v: 0.0..=1e3 = 30.0;
        /// Longest silence of the host while armed, s.
        command_time_s: 1.25e-4..=100.0 = 0.2;
        /// Frames that could not be read before the link is a fault.
        bad_frames: 1.0..=1e3 = 3.0;
        /// Speed at which tendons are let out when they have to be relaxed, m/s.
        ramp_m_per_s: 1e-5..=0.1 = 5e-3;
        /// Longest time from an arm until every tendon pulls, s.
        taut_time_s: 0.01..=60.0 = 5.0;
        /// Farthest that a tendon is pulled in to keep the minimum tension, or let out to keep the maximum tension, while the leg is held, m.
        hold_travel_m: 1e-6..=0.1 = 1e-3;
        /// Farthest that a tendon is let out when it has to be relaxed, m.
        relax_travel_m: 1e-6..=0.1 = 5e-3;
    }
}

section! {
    /// How the zero is found: the leg hangs free, with no payload, and one tendon after the other is taken up.
    4 Homing {
        /// How far every tendon is let out at a time, m: until that changes no tension any more.
        release_m: 1e-4..=0.5 = 0.004;
        /// Speed of letting out and taking up, m/s.
        speed_m_per_s: 1e-5..=0.1 = 0.01;
        /// Time in which the slack load cells are averaged, s.
        tare_time_s: 1e-3..=10.0 = 0.25;
        /// Greatest offset of a slack load cell that is taken as its zero, N.
        tare_max_n: 0.0..=1e3 = 10.0;
        /// Tension at which a tendon is taken as taut, N.
        touch_n: 0.1..=100.0 = 2.0;
        /// Time that the leg is given to come to rest then, s.
        settle_time_s: 1e-3..=60.0 = 1.5;
        /// Time in which tension and position are averaged, s.
        average_time_s: 1e-3..=60.0 = 0.7;
        /// Highest tension while homing, N.
        f_max_n: 0.1..=1e3 = 15.0;
        /// Farthest that a tendon is let out until it is slack, and then taken up, m.
        travel_m: 1e-4..=1.0 = 0.05;
    }
}

/// Every section by its name in files, in the order of their numbers.
pub const SECTIONS: [(&str, &[Field]); 5] = [
    ("motion", Motion::FIELDS),
    ("servo", Servo::FIELDS),
    ("estimation", Estimation::FIELDS),
    ("limits", Limits::FIELDS),
    ("homing", Homing::FIELDS),
];

impl OutOfRange {
    /// The section's name and the field; none for numbers that no section has.
    #[must_use]
    pub fn field(&self) -> Option<(&'static str, &'static Field)> {
        let (name, fields) = SECTIONS.get(usize::from(self.section))?;
        Some((name, fields.get(usize::from(self.field))?))
    }
}

impl core::fmt::Display for OutOfRange {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self.field() {
            Some((section, field)) => {
                let [low, high] = field.range;
                let name = field.name;
                write!(f, "{section}.{name} is outside {low} to {high}")
            }
            None => f.write_str("a setting is outside its range"),
        }
    }
}
