//! One number for what the firmware decides in a ready scenario: the same in a browser as on every other system.

use leg_rig::rig_file::RigFile;
use leg_sim::link::InProcess;
use leg_sim::ready_scenarios;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::{Simulation, TickHash};
use std::path::Path;

/// The row of `tests/golden/scenario_bits.txt` of a ready scenario.
///
/// # Errors
/// No such scenario, or one that does not run, as a sentence.
pub fn row(name: &str) -> Result<String, String> {
    let ready = ready_scenarios::named(name).ok_or("there is no such scenario")?;
    let scenario = Scenario::parse(name, ready.text).map_err(|error| error.render(false))?;
    let rig = RigFile::load(Some(Path::new(&scenario.rig))).map_err(|error| error.render(false))?;
    let mut hash = TickHash::default();
    let simulation = Simulation::new(&scenario, &rig).map_err(|error| error.to_string())?;
    let run = simulation.run(&mut InProcess::new(), &mut |tick| hash.take(tick));
    let ticks = run.map_err(|error| error.to_string())?.ticks;
    Ok(format!("{name} {ticks} ticks {:016x}", hash.value()))
}
