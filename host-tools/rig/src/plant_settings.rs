//! What the simulated leg is beside its rig and its actuators.

use crate::toml_error::TomlError;
use crate::toml_section::Section;
use leg_firmware::fields;
use leg_firmware::settings::Field;
use leg_model::RigParameters;

fields! {
    /// What neither the rig's mechanism nor its actuator says of the simulated leg.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct PlantSettings: f64 {
        /// Damping of the central joint against every rotation.
        joint_damping_nm_s_per_rad ["N·m·s/rad"]: 0.0..=10.0 = 0.03;
        /// Damping of a taut tendon. It never makes a tendon push.
        tendon_damping_n_s_per_m ["N·s/m"]: 0.0..=1e4 = 200.0;
        /// Inertia of the leg about its own axis.
        leg_axial_inertia_kg_m2 ["kg·m²"]: 1e-5..=100.0 = 4e-4;
        /// Noise of a load cell's reading, root mean square.
        cell_noise_n ["N"]: 0.0..=100.0 = 0.05;
        /// Resistance of the supply and its leads.
        supply_resistance_ohm ["Ω"]: 0.0..=10.0 = 0.2;
        /// Temperature of the drivers while nothing heats them.
        ambient_c ["°C"]: -100.0..=200.0 = 25.0;
    }
    and {
        /// Inertia of the leg without a payload across its axis, about the joint, kg·m²; none is that of a slender uniform
        /// leg with the rig's mass and centroid.
        leg_transverse_inertia_kg_m2: Option<f64> = None;
        /// How much more than the tension each load cell shows, as a part of it.
        cell_gain_error: [f64; 3] = [0.0; 3];
        /// What each load cell shows without a tension, N.
        cell_offset_n: [f64; 3] = [1.5, -0.8, 0.6];
        /// How fast the offset of every load cell grows, N/s.
        cell_drift_n_per_s: f64 = 0.0;
        /// What each motor's current sensor shows without a current, A.
        current_offset_a: [f64; 3] = [0.02, -0.03, 0.01];
        /// Steps of the integration in a tick.
        substeps: u32 = 4;
        /// How much farther than by the rig file's curve the real tendons stretch, as a part of the elongation.
        curve_error: f64 = 0.0;
    }
}

/// [`PlantSettings::leg_transverse_inertia_kg_m2`]; the default is that of the leg of Table 1.
pub const TRANSVERSE_INERTIA: Field<f64> = Field::new(
    "leg_transverse_inertia_kg_m2",
    "kg·m²",
    "Inertia of the leg without a payload across its axis, about the joint.",
    [1e-5, 1e3],
    0.016562,
);

/// [`PlantSettings::current_offset_a`].
pub const CURRENT_OFFSET: Field<f64> = Field::new(
    "current_offset_a",
    "A",
    "What each motor's current sensor shows without a current.",
    [-1e3, 1e3],
    0.0,
);

/// The section `[simulation]`.
pub const SIMULATION: &str = "simulation";

impl PlantSettings {
    /// Reads the section; whatever is left out is as by default.
    pub(crate) fn read(root: &Section<'_>) -> Result<Self, TomlError> {
        let mut plant = Self::DEFAULT;
        let mut keys: Vec<_> = Self::FIELDS.iter().map(|field| field.name).collect();
        keys.extend([TRANSVERSE_INERTIA.name, CURRENT_OFFSET.name]);
        if let Some(section) = root.optional(SIMULATION, &keys)? {
            section.read(Self::FIELDS, plant.values_mut())?;
            let inertia = section.values([&TRANSVERSE_INERTIA])?;
            plant.leg_transverse_inertia_kg_m2 = inertia.map(|[inertia]| inertia);
            if let Some(offsets) = section.values([&CURRENT_OFFSET; 3])? {
                plant.current_offset_a = offsets;
            }
        }
        Ok(plant)
    }

    /// The same without any damping of the leg: its energy then stays.
    #[must_use]
    pub fn undamped(&self) -> Self {
        Self {
            joint_damping_nm_s_per_rad: 0.0,
            tendon_damping_n_s_per_m: 0.0,
            ..*self
        }
    }

    /// Inertia of the leg without a payload across its axis, about the joint, kg·m². A slender uniform leg reaches twice
    /// as far as its centroid c, so it is m(2c)²/3.
    #[must_use]
    pub fn transverse_inertia_kg_m2(&self, rig: &RigParameters<f64, 3>) -> f64 {
        let (mass, centroid) = (rig.leg_mass_kg, rig.leg_centroid_m);
        let slender = mass * centroid * centroid * 4.0 / 3.0;
        self.leg_transverse_inertia_kg_m2.unwrap_or(slender)
    }
}
