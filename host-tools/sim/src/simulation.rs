//! A controller and a simulated leg in lock-step, with a shadow of the whole control law in f64 beside them.

mod controller;
mod divergence;
mod extremes;
mod outcome;
mod script;
mod stage;

pub use controller::{Controller, ControllerError, InThisProcess, OnLink};
pub use divergence::Divergence;
pub use outcome::{Finding, Sample, SimulationError, Summary};

use crate::plant::Plant;
use crate::scenario::Scenario;
use leg_firmware::drive::Drive;
use leg_firmware::host_link::BoardKind;
use leg_firmware::linked_leg::LinkedLeg;
use leg_firmware::sensors::Sensors;
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;
use leg_firmware_bench::protocol::TickReply;
use leg_firmware_bench::server::emulated;
use leg_rig::control_settings;
use leg_rig::rig_file::RigFile;
use script::Script;
use stage::Stage;

/// Longest simulation, s.
const LONGEST_S: f64 = 600.0;

/// What is known of one tick.
#[derive(Debug)]
pub struct Tick<'a> {
    /// What the sensors read.
    pub sensors: &'a Sensors,
    /// The bytes from the host.
    pub link: &'a [u8],
    /// What the controller asks of the motors.
    pub drive: &'a Drive<f32>,
    /// What it tells.
    pub telemetry: &'a Telemetry<f32>,
}

/// A scenario on a rig, ready to run.
#[derive(Clone, Debug)]
pub struct Simulation {
    scenario: Scenario,
    rig: RigFile,
    plant: Plant,
    settings: Settings,
}

impl Simulation {
    /// Puts a leg together.
    ///
    /// # Errors
    /// A start that the model refuses.
    pub fn new(scenario: &Scenario, rig: &RigFile) -> Result<Self, SimulationError> {
        let plant = Plant::new(rig, &scenario.plant(rig), scenario.start(), scenario.seed)
            .map_err(SimulationError::Start)?;
        let zero = (!scenario.starts_slack()).then(|| plant.unstretched_at_zero_m());
        Ok(Self {
            settings: control_settings::settings(rig, &rig.gains.with(&scenario.control), zero),
            scenario: scenario.clone(),
            rig: *rig,
            plant,
        })
    }

    /// The settings that the controller gets.
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
        controller: &mut dyn Controller,
        watch: &mut dyn FnMut(&Tick<'_>),
    ) -> Result<Summary, SimulationError> {
        let mut shadow = LinkedLeg::<f64>::new(emulated(BoardKind::InProcess), &self.settings)
            .map_err(SimulationError::Settings)?;
        controller.start(&self.settings)?;
        let mut stage = Stage::new(&self.rig, self.plant, &self.scenario);
        let mut script = Script::new(&self.scenario);
        let mut divergence = Divergence::default();
        let stopped = loop {
            let next = script.advance(&mut stage).and_then(|step| match step {
                Some(step) if stage.time_s() > LONGEST_S => Err(SimulationError::Endless { step }),
                Some(_) => {
                    tick(controller, &mut shadow, &mut stage, &mut divergence, watch).map(Some)
                }
                None => Ok(None),
            });
            match next {
                Ok(Some(())) => {}
                Ok(None) => break None,
                Err(error) if error.midway() => break Some(error.to_string()),
                Err(error) => return Err(error),
            }
        };
        let (findings, expected) = script.findings();
        Ok(stage.summary(findings, expected, divergence, stopped))
    }
}

/// One tick of controller, shadow and simulated leg.
fn tick(
    controller: &mut dyn Controller,
    shadow: &mut LinkedLeg<f64>,
    stage: &mut Stage,
    divergence: &mut Divergence,
    watch: &mut dyn FnMut(&Tick<'_>),
) -> Result<(), SimulationError> {
    let sensors = stage.plant.sense();
    let link = stage.outgoing();
    let TickReply {
        drive,
        motors,
        telemetry,
        ..
    } = controller.tick(&sensors, &link)?;
    shadow.receive(&link);
    let shadow_drive = shadow.leg().tick(&sensors);
    divergence.compare(&drive, &telemetry, &shadow_drive, &shadow.leg().telemetry());
    shadow.leg().take_over(&Drive {
        duty: drive.duty.map(f64::from),
        enabled: drive.enabled,
    });
    watch(&Tick {
        sensors: &sensors,
        link: &link,
        drive: &drive,
        telemetry: &telemetry,
    });
    stage.step(&motors, &telemetry)
}
