//! Data sheets of the motors, gears, screws and sensors: for the control law and for the simulated leg.

use crate::current_output::{self, CURRENT_OUTPUT};
use crate::motor_sections::{own_sections, with_motors};
use crate::toml_error::TomlError;
use crate::toml_section::Section;
use leg_firmware::fields;
use leg_firmware::sensors::CODE_MAX;
use leg_firmware::settings::{CurrentOutput, Field};

fields! {
    /// One actuator; the three are of one type, or each of its own.
    ///
    /// The defaults are typical of an ironless DC motor of 20 W at 24 V such as maxon's RE 25, with a planetary gear and
    /// a trapezoidal screw that holds by its friction. Replace them by the data sheets of your own.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Actuator: f64 {
        /// Terminal resistance of the motor.
        resistance_ohm ["Ω"]: 0.01..=1e3 = 2.32;
        /// Terminal inductance.
        inductance_h ["H"]: 1e-7..=1.0 = 0.238e-3;
        /// Torque constant, which is also the voltage per speed in V·s/rad.
        torque_constant_nm_per_a ["N·m/A"]: 1e-5..=100.0 = 23.4e-3;
        /// Inertia of the rotor, and of gear and screw as the rotor feels them.
        inertia_kg_m2 ["kg·m²"]: 1e-10..=1.0 = 1.2e-6;
        /// Dry friction at the rotor without a load.
        friction_nm ["N·m"]: 0.0..=10.0 = 0.9e-3;
        /// Viscous friction at the rotor.
        viscous_nm_s_per_rad ["N·m·s/rad"]: 0.0..=0.1 = 3e-7;
        /// Turns of the motor in one of the screw.
        gear_ratio ["1"]: 0.1..=1e4 = 4.4;
        /// Play between gear and screw, as a rotation of the screw.
        backlash_rad ["rad"]: 0.0..=1.0 = 0.015;
        /// How far a turn of the screw pulls the tendon.
        lead_m ["m"]: 1e-5..=0.1 = 1e-3;
        /// Part of the work that reaches the tendon when the screw pulls; below a half, so that a pull cannot turn it.
        screw_efficiency ["1"]: 0.01..=0.499 = 0.3;
        /// Part of the work that passes the gear.
        gear_efficiency ["1"]: 0.05..=1.0 = 0.9;
        /// Encoder counts in a turn of the motor, after quadrature.
        counts_per_turn ["1"]: 4.0..=1e6 = 2048.0;
        /// Motor current at the highest code; where the output shows both directions code 0 is minus that.
        current_range_a ["A"]: 0.01..=1e3 = 12.0;
        /// Supply at the highest code.
        supply_range_v ["V"]: 1.0..=1e3 = 36.0;
        /// Nominal supply.
        supply_v ["V"]: 1.0..=1e3 = 24.0;
    }
    and {
        /// What the current output shows.
        current_output: CurrentOutput = CurrentOutput::Bidirectional;
        /// Highest continuous current of the motor, A; none where the file does not say.
        continuous_a: Option<f64> = None;
        /// Thermal time constant of the winding, s; none where the file does not say.
        thermal_time_s: Option<f64> = None;
        /// Tension at a load cell's code 0 and at its highest, N.
        cell_range_n: [f64; 2] = [-20.0, 230.0];
        /// Temperature at code 0 and at the highest, °C.
        temperature_range_c: [f64; 2] = [-40.0, 160.0];
    }
}

/// The ends of [`Actuator::cell_range_n`].
pub const CELL_RANGE: [Field<f64>; 2] = {
    let low = "Tension at a load cell's code 0; below zero, since a slack cell at the end of its range would be taken for a \
               faulty one.";
    let high = "Tension at a load cell's highest code.";
    let [slack, taut] = Actuator::DEFAULT.cell_range_n;
    [
        Field::new("cell_range_n", "N", low, [-1e5, -1e-3], slack),
        Field::new("cell_range_n", "N", high, [1e-3, 1e5], taut),
    ]
};

/// The ends of [`Actuator::temperature_range_c`].
pub const TEMPERATURE_RANGE: [Field<f64>; 2] = {
    let (name, [cold, hot]) = ("temperature_range_c", Actuator::DEFAULT.temperature_range_c);
    [
        Field::new(name, "°C", "Temperature at code 0.", [-300.0, 20.0], cold),
        Field::new(
            name,
            "°C",
            "Temperature at the highest code.",
            [30.0, 2000.0],
            hot,
        ),
    ]
};

/// [`Actuator::continuous_a`] and [`Actuator::thermal_time_s`], which have no default.
pub(crate) const THERMAL: [Field<f64>; 2] = [
    Field::new(
        "continuous_a",
        "A",
        "Highest continuous current of the motor; with `thermal_time_s` it bounds the current of the servo.",
        [0.01, 1e3],
        f64::NAN,
    ),
    Field::new(
        "thermal_time_s",
        "s",
        "Thermal time constant of the winding.",
        [0.1, 1e4],
        f64::NAN,
    ),
];

/// The section `[actuator]`: motors, gears, screws and sensors by their data sheets.
pub const ACTUATOR: &str = "actuator";

/// Keys of what the board has once for all motors: no motor has them for itself.
const OF_THE_BOARD: [&str; 3] = ["supply_range_v", "supply_v", TEMPERATURE_RANGE[0].name];

impl Actuator {
    /// Reads the section for each motor: what a motor has for itself wins, whatever is left out is as by default.
    pub(crate) fn read_all(root: &Section<'_>) -> Result<[Self; 3], TomlError> {
        let mut keys: Vec<_> = Self::FIELDS.iter().map(|field| field.name).collect();
        keys.extend([CELL_RANGE[0].name, TEMPERATURE_RANGE[0].name]);
        keys.extend(THERMAL.map(|field| field.name));
        keys.push(CURRENT_OUTPUT);
        let Some(section) = root.optional(ACTUATOR, &with_motors(&keys))? else {
            return Ok([Self::DEFAULT; 3]);
        };
        let mut actuators = [Self::DEFAULT.with(&section)?; 3];
        keys.retain(|key| !OF_THE_BOARD.contains(key));
        let own = own_sections(&section, &keys)?;
        for (actuator, own) in actuators.iter_mut().zip(own) {
            if let Some(own) = own {
                *actuator = actuator.with(&own)?;
            }
        }
        Ok(actuators)
    }

    /// The same with what a section gives.
    fn with(mut self, section: &Section<'_>) -> Result<Self, TomlError> {
        section.read(Self::FIELDS, self.values_mut())?;
        let [continuous, time] = THERMAL.each_ref();
        for (field, value) in [
            (continuous, &mut self.continuous_a),
            (time, &mut self.thermal_time_s),
        ] {
            if let Some([given]) = section.values([field])? {
                *value = Some(given);
            }
        }
        if let Some(output) = current_output::read(section)? {
            self.current_output = output;
        }
        if let Some(range) = section.values(CELL_RANGE.each_ref())? {
            self.cell_range_n = range;
        }
        if let Some(range) = section.values(TEMPERATURE_RANGE.each_ref())? {
            self.temperature_range_c = range;
        }
        Ok(self)
    }

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

    /// Play of the gear, as travel of the tendon, m.
    #[must_use]
    pub fn play_m(&self) -> f64 {
        self.backlash_rad * self.lead_m / std::f64::consts::TAU
    }

    /// Voltage that the motor induces, by the speed of the tendon, V·s/m.
    #[must_use]
    pub fn back_emf_v_s_per_m(&self) -> f64 {
        self.torque_constant_nm_per_a / self.m_per_rad()
    }

    /// Current that a pull takes beside friction, by the tension, A/N.
    #[must_use]
    pub fn pull_a_per_n(&self) -> f64 {
        let efficiency = self.gear_efficiency * self.screw_efficiency;
        self.m_per_rad() / (efficiency * self.torque_constant_nm_per_a)
    }

    /// The current that a cold motor bears for a time, A: the heat I²t approaches that of the continuous current with the
    /// winding's time constant. None where the file does not give both.
    #[must_use]
    pub fn current_borne_a(&self, time_s: f64) -> Option<f64> {
        let (continuous_a, thermal_s) = (self.continuous_a?, self.thermal_time_s?);
        Some(continuous_a / (-(-time_s / thermal_s).exp_m1()).sqrt())
    }

    /// The time for which a cold motor bears a current, s: infinite up to the continuous one. None where the file does not give
    /// both.
    #[must_use]
    pub fn bears_s(&self, current_a: f64) -> Option<f64> {
        let (continuous_a, thermal_s) = (self.continuous_a?, self.thermal_time_s?);
        let part = (continuous_a / current_a).powi(2);
        Some(if part >= 1.0 {
            f64::INFINITY
        } else {
            -thermal_s * (-part).ln_1p()
        })
    }

    /// Time in which the motor comes up to speed at a voltage: RJ/k², s.
    #[must_use]
    pub fn mechanical_time_s(&self) -> f64 {
        self.resistance_ohm * self.inertia_kg_m2 / self.torque_constant_nm_per_a.powi(2)
    }

    /// Tension by code of a load cell, N.
    #[must_use]
    pub fn cell_n_per_code(&self) -> f64 {
        let [low, high] = self.cell_range_n;
        (high - low) / f64::from(CODE_MAX)
    }

    /// Code of a load cell without tension.
    #[must_use]
    pub fn cell_zero_code(&self) -> f64 {
        -self.cell_range_n[0] / self.cell_n_per_code()
    }

    /// Current by code, A.
    #[must_use]
    pub fn current_a_per_code(&self) -> f64 {
        let [lowest_a, highest_a] = self.current_ends_a();
        (highest_a - lowest_a) / f64::from(CODE_MAX)
    }

    /// The currents at code 0 and at the highest, A.
    #[must_use]
    pub fn current_ends_a(&self) -> [f64; 2] {
        let lowest_a = match self.current_output {
            CurrentOutput::Bidirectional => -self.current_range_a,
            CurrentOutput::Magnitude | CurrentOutput::MagnitudeWhenDriven => 0.0,
        };
        [lowest_a, self.current_range_a]
    }
}
