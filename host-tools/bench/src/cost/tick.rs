//! What a whole tick of the control law takes: sense to drive, supervisor included.

use super::{Budget, Cost, CostError};
use leg_rig::rig_file::RigFile;
use leg_sim::link::Link;
use leg_sim::ready_scenarios;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::{OnLink, Simulation};
use std::path::Path;

/// A scenario whose every tick is counted, on a rig.
#[derive(Clone, Copy, Debug)]
pub struct Counted {
    name: &'static str,
    scenario: &'static str,
    rig: &'static str,
    budget: Budget,
}

impl Counted {
    const fn new(
        name: &'static str,
        scenario: &'static str,
        rig: &'static str,
        highest: u32,
    ) -> Self {
        Self {
            name,
            scenario,
            rig,
            budget: Budget::new(150, highest),
        }
    }
}

/// The most that a tick may take on the paper's leg; a fifth of what the core does in the time of a tick is 4 250 cycles.
const HIGHEST: u32 = 2000;

/// The most where the support turns the leg about itself, so that its geometry has to be made anew at every pose.
const HIGHEST_TURNED: u32 = 2700;

/// Everything that is counted.
pub const COUNTED: [Counted; 8] = [
    Counted::new("control tick", "cost", "table1", HIGHEST),
    Counted::new("control tick, homing", "cost_homing", "table1", HIGHEST),
    Counted::new(
        "control tick, ball joint",
        "cost",
        "spherical",
        HIGHEST_TURNED,
    ),
    Counted::new(
        "control tick, universal joint",
        "cost",
        "universal",
        HIGHEST_TURNED,
    ),
    Counted::new(
        "control tick, compliant pivot",
        "cost",
        "compliant_pivot",
        HIGHEST_TURNED,
    ),
    Counted::new(
        "control tick, elastic rods",
        "cost",
        "elastic_rod_universal",
        HIGHEST_TURNED,
    ),
    Counted::new(
        "control tick, notch hinges",
        "cost",
        "notch_universal",
        HIGHEST_TURNED,
    ),
    Counted::new(
        "control tick, leaf springs",
        "cost",
        "leaf_spring_universal",
        HIGHEST_TURNED,
    ),
];

/// Counts every tick of a scenario.
///
/// # Errors
/// A link that fails or counts nothing.
pub fn measure(link: &mut dyn Link, counted: &Counted) -> Result<Cost, CostError> {
    let failed = |error: &dyn std::fmt::Display| CostError::Tick(error.to_string());
    let text = ready_scenarios::named(counted.scenario).map_or("", |ready| ready.text);
    let scenario =
        Scenario::parse(counted.scenario, text).map_err(|error| failed(&error.render(false)))?;
    let rig = RigFile::load(Some(Path::new(counted.rig))).map_err(|error| failed(&error))?;
    let mut controller = OnLink::new(link, true);
    let simulation = Simulation::new(&scenario, &rig).map_err(|error| failed(&error))?;
    let summary = simulation
        .run(&mut controller, &mut |_| ())
        .map_err(|error| failed(&error))?;
    if let Some(words) = summary.stopped {
        return Err(CostError::Tick(words));
    }
    Ok(Cost::of(
        counted.name,
        controller.instructions,
        counted.budget,
    ))
}
