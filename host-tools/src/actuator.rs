//! The motors, gears, screws and sensors that pull the tendons: what the control law is told and the simulated leg is.

/// One actuator; the three are of one type.
///
/// The defaults are those of a small ironless DC motor of 20 W at 24 V (maxon RE 25, order number 118752, by its data
/// sheet), a planetary gear, and a trapezoidal screw that holds by its friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Actuator {
    /// Terminal resistance of the motor, Ω.
    pub resistance_ohm: f64,
    /// Terminal inductance, H.
    pub inductance_h: f64,
    /// Torque constant, N·m/A, which is also the voltage per speed, V·s/rad.
    pub torque_constant_nm_per_a: f64,
    /// Inertia of the rotor, and of gear and screw as the rotor feels them, kg·m².
    pub inertia_kg_m2: f64,
    /// Dry friction at the rotor without a load, N·m.
    pub friction_nm: f64,
    /// Viscous friction at the rotor, N·m·s/rad.
    pub viscous_nm_s_per_rad: f64,
    /// Turns of the motor in one of the screw.
    pub gear_ratio: f64,
    /// Play between gear and screw, as a rotation of the screw, rad.
    pub backlash_rad: f64,
    /// How far a turn of the screw pulls the tendon, m.
    pub lead_m: f64,
    /// Part of the work that reaches the tendon when the screw pulls; below a half, so that a pull cannot turn it.
    pub screw_efficiency: f64,
    /// Part of the work that passes the gear.
    pub gear_efficiency: f64,
    /// Encoder counts in a turn of the motor, after quadrature.
    pub counts_per_turn: f64,
    /// Tension at a load cell's code 0 and at its highest, N.
    pub cell_range_n: [f64; 2],
    /// Motor current at the highest code, A; code 0 is minus that.
    pub current_range_a: f64,
    /// Supply at the highest code, V.
    pub supply_range_v: f64,
    /// Temperature at code 0 and at the highest, °C.
    pub temperature_range_c: [f64; 2],
    /// Nominal supply, V.
    pub supply_v: f64,
}

impl Default for Actuator {
    fn default() -> Self {
        Self {
            resistance_ohm: 2.32,
            inductance_h: 0.238e-3,
            torque_constant_nm_per_a: 23.4e-3,
            inertia_kg_m2: 1.2e-6,
            friction_nm: 0.9e-3,
            viscous_nm_s_per_rad: 3e-7,
            gear_ratio: 4.4,
            backlash_rad: 0.015,
            lead_m: 1e-3,
            screw_efficiency: 0.3,
            gear_efficiency: 0.9,
            counts_per_turn: 2048.0,
            cell_range_n: [-20.0, 230.0],
            current_range_a: 12.0,
            supply_range_v: 36.0,
            temperature_range_c: [-40.0, 160.0],
            supply_v: 24.0,
        }
    }
}

impl Actuator {
    /// How far one encoder count pulls the tendon in, m.
    #[must_use]
    pub fn m_per_count(&self) -> f64 {
        self.lead_m / (self.gear_ratio * self.counts_per_turn)
    }

    /// How far one radian of the motor pulls the tendon in, m/rad.
    #[must_use]
    pub fn m_per_rad(&self) -> f64 {
        self.lead_m / (self.gear_ratio * std::f64::consts::TAU)
    }
}
