//! A scenario with an emulated leg, and a shadow of the whole control law in f64 beside it.

mod extremes;
mod follow_error;
mod follower;
mod measure;
mod sequencer;
mod summary;
mod test_stand;
mod tick_hash;

pub use crate::hosted_leg::Comparison;
pub use summary::{RefusedCommand, Sample, ScenarioMeasurement, SimulationError, Summary};
pub use test_stand::SAMPLE_TICKS;
pub use tick_hash::TickHash;

use crate::emulated_leg::{EmulatedLeg, EmulationError, assembled};
use crate::link::Link;
use crate::plant::{Plant, Truth};
use crate::scenario::Scenario;
use crate::shadow::Shadow;
use crate::signals::{LegConstants, Report, Simulated};
use leg_firmware::drive::Drive;
use leg_firmware::sensors::Sensors;
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;
use leg_rig::gains;
use leg_rig::rig_file::RigFile;
use sequencer::Sequencer;
use test_stand::TestStand;

/// Longest simulation, s.
const LONGEST_S: f64 = 600.0;

/// What is known of one tick.
#[derive(Debug)]
pub struct Tick<'a> {
    /// What the sensors read.
    pub sensors: &'a Sensors,
    /// The bytes from the host.
    pub link: &'a [u8],
    /// What the firmware asks of the motors.
    pub drive: &'a Drive<f32>,
    /// What it reports.
    pub telemetry: &'a Telemetry<f32>,
    /// Instructions that it took, if they are counted.
    pub instructions: Option<u32>,
    /// Instructions that its recording took, if they are counted.
    pub recorder_instructions: Option<u32>,
    /// The simulated leg beside what it reports.
    pub comparison: &'a Comparison,
    /// The simulated leg as the tick finds it.
    pub truth: &'a Truth,
    /// What its motors get.
    pub motors: &'a Drive<f32>,
}

impl Tick<'_> {
    /// The same as signals.
    #[must_use]
    pub fn signals(&self, leg: &LegConstants) -> (Report, Simulated) {
        let report = Report::new(self.telemetry, leg).compared(self.comparison);
        let simulated = Simulated {
            truth: *self.truth,
            motors: *self.motors,
            comparison: *self.comparison,
        };
        (report, simulated)
    }
}

/// A scenario on a rig, ready to run.
#[derive(Clone, Debug)]
pub struct Simulation {
    scenario: Scenario,
    rig: RigFile,
    plant: Plant,
    settings: Settings,
    counting: bool,
}

impl Simulation {
    /// Puts a leg together.
    ///
    /// # Errors
    /// A start that the model refuses.
    pub fn new(scenario: &Scenario, rig: &RigFile) -> Result<Self, SimulationError> {
        let gains = gains::changed(rig.gains, &scenario.control);
        let errors = scenario.plant(rig);
        let (plant, settings) = assembled(rig, &errors, &gains, scenario.start, scenario.seed)?;
        Ok(Self {
            scenario: scenario.clone(),
            rig: *rig,
            plant,
            settings,
            counting: false,
        })
    }

    /// The same with the instructions of each tick counted: only a link to an emulated core can.
    #[must_use]
    pub fn counting(self) -> Self {
        Self {
            counting: true,
            ..self
        }
    }

    /// The settings that the firmware gets.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Runs to the end of the scenario, or until a step does not end, and calls `watch` after each tick.
    ///
    /// # Errors
    /// A [`SimulationError`]: settings or a link that fail.
    pub fn run(
        self,
        link: &mut dyn Link,
        watch: &mut dyn FnMut(&Tick<'_>),
    ) -> Result<Summary, SimulationError> {
        let mut shadow = Shadow::new(&self.settings).map_err(EmulationError::Settings)?;
        let leg = EmulatedLeg::start(self.plant, &self.settings, link, self.counting)?;
        let mut stand = TestStand::new(leg, &self.rig, &self.settings, &self.scenario);
        let mut sequencer = Sequencer::new(&self.scenario);
        let stopped = loop {
            match advance(&mut sequencer, &mut stand, &mut shadow, watch) {
                Ok(true) => {}
                Ok(false) => break None,
                Err(error) if error.midway() => break Some(error.to_string()),
                Err(error) => return Err(error),
            }
        };
        let mut summary = stand.summary;
        let faults = summary.faults.iter().map(|(fault, _)| *fault);
        summary.unexpected = faults
            .filter(|fault| !sequencer.expected.has(*fault))
            .collect();
        Ok(Summary {
            divergence: shadow.divergence,
            stopped,
            ..summary
        })
    }
}

/// Does the steps that are due, and then one tick; false at the end.
fn advance(
    sequencer: &mut Sequencer<'_>,
    stand: &mut TestStand<'_>,
    shadow: &mut Shadow,
    watch: &mut dyn FnMut(&Tick<'_>),
) -> Result<bool, SimulationError> {
    let Some(step) = sequencer.advance(stand)? else {
        return Ok(false);
    };
    if stand.leg.time_s() > LONGEST_S {
        return Err(SimulationError::Endless(step));
    }
    let (comparison, truth) = (stand.comparison(), *stand.leg.truth());
    stand.tick(&comparison, |sensors, link, reply| {
        shadow.tick(sensors, link, reply);
        watch(&Tick {
            sensors,
            link,
            drive: &reply.drive,
            telemetry: &reply.telemetry,
            instructions: reply.instructions,
            recorder_instructions: reply.recorder_instructions,
            comparison: &comparison,
            truth: &truth,
            motors: &reply.motors,
        });
    })?;
    Ok(true)
}
