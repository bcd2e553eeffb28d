//! The section `[simulation]`: what the simulated leg is beside its mechanism and its actuators.

use super::actuator::read_fields;
use crate::plant_settings::{PlantSettings, TRANSVERSE_INERTIA};
use crate::toml_problem::Fault;
use crate::toml_section::Section;

/// The name of the section.
pub(super) const SIMULATION: &str = "simulation";

/// The simulated leg; whatever is left out is as by default.
pub(super) fn read(root: &Section<'_>) -> Result<PlantSettings, Fault> {
    let mut plant = PlantSettings::DEFAULT;
    let fields = PlantSettings::fields();
    let mut keys: Vec<_> = fields.iter().map(|field| field.name).collect();
    keys.push(TRANSVERSE_INERTIA.name);
    let Some(section) = root.optional(SIMULATION, &keys)? else {
        return Ok(plant);
    };
    read_fields(&section, &fields, plant.values_mut())?;
    plant.leg_transverse_inertia_kg_m2 = section.field(&TRANSVERSE_INERTIA)?;
    Ok(plant)
}
