//! What a whole tick of the control law takes: sense to drive, supervisor included.

use super::{Budget, Cost, CostError};
use crate::link::Link;
use crate::ready_scenarios;
use crate::rig_file::RigFile;
use crate::scenario::Scenario;
use crate::simulation::{OnLink, Simulation};

/// The scenario that is counted.
const SCENARIO: &str = "cost";

/// The most that a tick may take: a fifth of what the core does in the time of a tick would be 4 250 cycles.
const BUDGET: Budget = Budget::new(150, 2000);

/// Counts every tick of a scenario.
///
/// # Errors
/// A link that fails or counts nothing.
pub fn measure(link: &mut dyn Link) -> Result<Cost, CostError> {
    let failed = |error: &dyn std::fmt::Display| CostError::Tick(error.to_string());
    let text = ready_scenarios::named(SCENARIO).map_or("", |ready| ready.text);
    let scenario = Scenario::parse(SCENARIO, text).map_err(|error| failed(&error.render(false)))?;
    let rig = RigFile::load(None).map_err(|error| failed(&error))?;
    let mut controller = OnLink::new(link, true);
    let simulation = Simulation::new(&scenario, &rig).map_err(|error| failed(&error))?;
    simulation
        .run(&mut controller, &mut |_| ())
        .map_err(|error| failed(&error))?;
    Ok(Cost::of(
        "whole control tick",
        controller.instructions,
        BUDGET,
    ))
}
