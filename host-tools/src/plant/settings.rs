//! What the simulated leg is beside its rig and its actuators.

use leg_model::RigParameters;

/// What neither the rig file nor the actuator tells of the simulated leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlantSettings {
    /// Damping of the central joint against every rotation, N·m·s/rad.
    pub joint_damping_nm_s_per_rad: f64,
    /// Damping of a taut tendon, N·s/m. It never makes a tendon push.
    pub tendon_damping_n_s_per_m: f64,
    /// Inertia of the leg about its own axis, kg·m².
    pub leg_axial_inertia_kg_m2: f64,
    /// Inertia of the leg without a payload across its axis, about the joint, kg·m²; none is that of a slender uniform
    /// leg with the rig's mass and centroid.
    pub leg_transverse_inertia_kg_m2: Option<f64>,
    /// How much more than the tension each load cell shows, as a part of it.
    pub cell_gain_error: [f64; 3],
    /// What each load cell shows without a tension, N.
    pub cell_offset_n: [f64; 3],
    /// Noise of a load cell's reading, root mean square, N.
    pub cell_noise_n: f64,
    /// How fast the offset of every load cell grows, N/s.
    pub cell_drift_n_per_s: f64,
    /// Resistance of the supply and its leads, Ω.
    pub supply_resistance_ohm: f64,
    /// Temperature of the drivers while nothing heats them, °C.
    pub ambient_c: f64,
    /// Steps of the integration in a tick.
    pub substeps: u32,
    /// How much farther than by the rig file's curve the real tendons stretch, as a part of the elongation.
    pub curve_error: f64,
}

impl Default for PlantSettings {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl PlantSettings {
    /// A small leg in a calm room.
    pub const DEFAULT: Self = Self {
        joint_damping_nm_s_per_rad: 0.03,
        tendon_damping_n_s_per_m: 200.0,
        leg_axial_inertia_kg_m2: 4e-4,
        leg_transverse_inertia_kg_m2: None,
        cell_gain_error: [0.0; 3],
        cell_offset_n: [1.5, -0.8, 0.6],
        cell_noise_n: 0.05,
        cell_drift_n_per_s: 0.0,
        supply_resistance_ohm: 0.2,
        ambient_c: 25.0,
        substeps: 4,
        curve_error: 0.0,
    };

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
    pub(super) fn transverse_inertia_kg_m2(&self, rig: &RigParameters<f64, 3>) -> f64 {
        let (mass, centroid) = (rig.leg_mass_kg, rig.leg_centroid_m);
        let slender = mass * centroid * centroid * 4.0 / 3.0;
        self.leg_transverse_inertia_kg_m2.unwrap_or(slender)
    }
}
