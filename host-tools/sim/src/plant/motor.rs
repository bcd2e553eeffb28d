//! A motor with its gear and screw.

use super::screw::Screw;
use leg_rig::actuator::Actuator;

/// What does not change of a motor.
#[derive(Clone, Copy, Debug)]
pub(super) struct MotorType {
    actuator: Actuator,
    /// Half a step of the integration, s.
    pub half_s: f64,
    /// Part of a difference of currents that remains after half a step.
    decay: f64,
}

impl MotorType {
    pub fn new(actuator: &Actuator, half_s: f64) -> Self {
        Self {
            actuator: *actuator,
            half_s,
            decay: libm::exp(-half_s * actuator.resistance_ohm / actuator.inductance_h),
        }
    }
}

/// One motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Motor {
    /// Part of the supply at the motor, −1 to 1.
    pub duty: f64,
    /// Whether the driver's outputs are off.
    pub open: bool,
    /// Friction beyond that of the actuator, N·m.
    pub dry_nm: f64,
    /// Whether the rotor is held.
    pub jammed: bool,
    pub current_a: f64,
    /// Speed of the rotor, rad/s.
    pub speed: f64,
    /// Angle of the rotor since the start, rad.
    pub angle_rad: f64,
    pub screw: Screw,
}

impl Motor {
    pub fn new(actuator: &Actuator) -> Self {
        Self {
            duty: 0.0,
            open: false,
            dry_nm: 0.0,
            jammed: false,
            current_a: 0.0,
            speed: 0.0,
            angle_rad: 0.0,
            screw: Screw::new(actuator),
        }
    }

    /// The current after half a step at a supply, A: exact for a speed that stays.
    pub fn next_current_a(&self, kind: &MotorType, supply_v: f64) -> f64 {
        if self.open {
            return 0.0;
        }
        let back_v = kind.actuator.torque_constant_nm_per_a * self.speed;
        let final_a = (self.duty * supply_v - back_v) / kind.actuator.resistance_ohm;
        final_a + (self.current_a - final_a) * kind.decay
    }

    /// Speeds the rotor up for half a step against friction and a pull (N).
    ///
    /// Friction takes up to a limit from the change of momentum, no more than stops the rotor: so it sticks exactly.
    pub fn kick(&mut self, kind: &MotorType, pull_n: f64) {
        let actuator = &kind.actuator;
        let per_torque = kind.half_s / actuator.inertia_kg_m2;
        let driving_nm = actuator.torque_constant_nm_per_a * self.current_a
            - actuator.viscous_nm_s_per_rad * self.speed;
        let free = self.speed + driving_nm * per_torque;
        let resisting_nm =
            actuator.friction_nm + self.dry_nm + self.screw.resistance_nm(free, pull_n);
        let left = (free.abs() - resisting_nm * per_torque).max(0.0);
        self.speed = if self.jammed {
            0.0
        } else {
            left.copysign(free)
        };
    }

    /// Turns by an angle, rad.
    pub fn turn(&mut self, turned_rad: f64) {
        self.angle_rad += turned_rad;
        self.screw.follow(turned_rad);
    }

    /// Speed at which the tendon is pulled in, m/s.
    pub fn slider_m_per_s(&self) -> f64 {
        self.screw.slider_m_per_s(self.speed)
    }
}
