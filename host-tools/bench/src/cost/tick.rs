//! What a whole tick of the control law takes: sense to drive, supervisor included.

use super::{Cost, CostError, InstructionBudget};
use leg_rig::rig_file::RigFile;
use leg_sim::link::Link;
use leg_sim::ready_scenarios;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::Simulation;
use std::path::Path;

/// What a scenario whose every tick is counted is called, the ready scenario, the ready rig, and the most instructions.
type CountedScenario = (&'static str, &'static str, &'static str, u32);

/// Fewer instructions in a tick mean that something is no longer done.
const MIN: u32 = 150;

/// The most that a tick may take on the paper's leg; a fifth of what the core does in the time of a tick is 4 250 cycles.
const MAX: u32 = 2000;

/// The most where the support turns the leg about itself, so that its geometry has to be made anew at every pose.
const MAX_TURNED: u32 = 2700;

/// Everything that is counted.
pub(super) const COUNTED: [CountedScenario; 8] = [
    ("control tick", "cost", "table1", MAX),
    ("control tick, homing", "cost_homing", "table1", MAX),
    ("control tick, ball joint", "cost", "spherical", MAX_TURNED),
    (
        "control tick, universal joint",
        "cost",
        "universal",
        MAX_TURNED,
    ),
    (
        "control tick, compliant pivot",
        "cost",
        "compliant_pivot",
        MAX_TURNED,
    ),
    (
        "control tick, elastic rods",
        "cost",
        "elastic_rod_universal",
        MAX_TURNED,
    ),
    (
        "control tick, notch hinges",
        "cost",
        "notch_universal",
        MAX_TURNED,
    ),
    (
        "control tick, leaf springs",
        "cost",
        "leaf_spring_universal",
        MAX_TURNED,
    ),
];

/// Counts every tick of a scenario.
///
/// # Errors
/// A link that fails or counts nothing.
pub(super) fn measure(
    link: &mut dyn Link,
    (name, scenario, rig, highest): CountedScenario,
) -> Result<Cost, CostError> {
    let failed = |error: &dyn std::fmt::Display| CostError::Tick(error.to_string());
    let text = ready_scenarios::named(scenario).map_or("", |ready| ready.text);
    let scenario = Scenario::parse(scenario, text).map_err(|error| failed(&error.render(false)))?;
    let rig = RigFile::load(Some(Path::new(rig))).map_err(|error| failed(&error))?;
    let mut instructions = Vec::new();
    let simulation = Simulation::new(&scenario, &rig).map_err(|error| failed(&error))?;
    let summary = simulation
        .counting()
        .run(link, &mut |tick| instructions.extend(tick.instructions))
        .map_err(|error| failed(&error))?;
    if let Some(reason) = summary.stopped {
        return Err(CostError::Tick(reason));
    }
    let budget = InstructionBudget::new(MIN, highest);
    Ok(Cost::from_counts(name, instructions, budget))
}
