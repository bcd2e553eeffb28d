//! What a whole tick of the control law takes: sense to drive, supervisor included. The recorder, which follows the drive, is counted
//! apart.

use super::{Cost, CostError, InstructionBudget};
use leg_firmware::settings::{RECORDED_SIGNALS, SignalSet};
use leg_rig::ready_rigs::{READY_RIGS, ReadyRig};
use leg_rig::rig_file::RigFile;
use leg_rig::support_name::SupportName;
use leg_sim::link::Link;
use leg_sim::ready_scenarios;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::Simulation;

/// Fewer instructions in a tick mean that something is no longer done.
const MIN: u32 = 150;

/// The most that a tick may take on the paper's leg; a fifth of what the core does in the time of a tick is 4 250 cycles.
const MAX: u32 = 2000;

/// The most where the support turns the leg about itself, so that its geometry has to be made anew at every pose.
const MAX_TURNED: u32 = 2700;

/// The most that the recording of three signals may take.
const RECORDER_MAX: u32 = 400;

/// The most that the recording of all signals may take.
const RECORDER_WHOLE_MAX: u32 = 800;

/// A scenario whose every tick is counted.
pub(super) struct CountedScenario {
    name: String,
    /// The ready scenario.
    scenario: &'static str,
    rig: ReadyRig,
    part: Part,
}

/// What of a tick is counted.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    ControlLaw,
    /// While it keeps these signals.
    Recorder(SignalSet),
}

/// How many scenarios are counted.
pub(super) const COUNTED: usize = READY_RIGS.len() + 5;

/// Everything that is counted: every ready rig as it moves, and the paper's as it is homed, follows set-points and keeps station,
/// too, and its recorder.
pub(super) fn counted() -> impl Iterator<Item = CountedScenario> {
    let [paper, others @ ..] = READY_RIGS;
    let counted = |what: &str, scenario, rig| CountedScenario {
        name: format!("control tick{what}"),
        scenario,
        rig,
        part: Part::ControlLaw,
    };
    let recorder = |what: &str, signals| CountedScenario {
        name: format!("recorder{what}"),
        scenario: "cost_station",
        rig: paper,
        part: Part::Recorder(signals),
    };
    let others = others.map(|rig| counted(&format!(", {}", rig.joint), "cost", rig));
    [
        counted("", "cost", paper),
        counted(", homing", "cost_homing", paper),
        counted(", set-points", "cost_follow", paper),
        counted(", keeping station", "cost_station", paper),
    ]
    .into_iter()
    .chain(others)
    .chain([
        recorder("", SignalSet::default()),
        recorder(", all signals", SignalSet::new(&RECORDED_SIGNALS)),
    ])
}

/// Counts every tick of a scenario.
///
/// # Errors
/// A link that fails or counts nothing.
pub(super) fn measure(link: &mut dyn Link, counted: &CountedScenario) -> Result<Cost, CostError> {
    let failed = |error: &dyn std::fmt::Display| CostError::Tick(error.to_string());
    let CountedScenario {
        name,
        scenario,
        rig,
        part,
    } = counted;
    let text = ready_scenarios::named(scenario).map_or("", |ready| ready.text);
    let scenario = Scenario::parse(scenario, text).map_err(|error| failed(&error.render(false)))?;
    let mut file = RigFile::parse(rig.name, rig.text).map_err(|error| failed(&error))?;
    if let Part::Recorder(signals) = part {
        file.recorded = *signals;
    }
    let mut instructions = Vec::new();
    let simulation = Simulation::new(&scenario, &file).map_err(|error| failed(&error))?;
    let summary = simulation
        .counting()
        .run(link, &mut |tick| {
            instructions.extend(match part {
                Part::ControlLaw => tick.instructions,
                Part::Recorder(_) => tick.recorder_instructions,
            });
        })
        .map_err(|error| failed(&error))?;
    if let Some(reason) = summary.stopped {
        return Err(CostError::Tick(reason));
    }
    let budget = match (part, rig.support) {
        (Part::Recorder(signals), _) if *signals == SignalSet::default() => {
            InstructionBudget::new(MIN, RECORDER_MAX)
        }
        (Part::Recorder(_), _) => InstructionBudget::new(MIN, RECORDER_WHOLE_MAX),
        (Part::ControlLaw, SupportName::TorsionFree) => InstructionBudget::new(MIN, MAX),
        (Part::ControlLaw, _) => InstructionBudget::new(MIN, MAX_TURNED),
    };
    Ok(Cost::from_counts(name, instructions, budget))
}
