//! A leg without a board: the firmware and a simulated leg, tick by tick.

use crate::link::Link;
use crate::plant::{Plant, Start};
use crate::simulation::{Controller, ControllerError, OnLink, SimulationError};
use leg_firmware::linked_leg::LINK_BYTES_MAX;
use leg_firmware::sensors::{Sensors, TICK_HZ};
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::State;
use leg_firmware_bench::protocol::TickReply;
use leg_rig::control_settings;
use leg_rig::plant_settings::PlantSettings;
use leg_rig::rig_file::RigFile;
use std::collections::VecDeque;
use std::time::Duration;

/// How an emulated leg begins; it is disarmed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Beginning {
    /// Homed, hanging straight down, its tendons at the rig's pretension.
    Hanging,
    /// Not homed, hanging straight down, every tendon longer than its way by as much, m.
    Slack(f64),
}

/// The firmware, wherever it runs, and the leg that it drives.
pub struct EmulatedLeg {
    plant: Plant,
    controller: Box<dyn Controller>,
    ticks: u64,
}

impl EmulatedLeg {
    /// A leg that has just started. The noise of its load cells is always the same.
    ///
    /// # Errors
    /// A rig whose start or whose settings are refused; a controller that fails.
    pub fn new(
        rig: &RigFile,
        beginning: Beginning,
        mut controller: Box<dyn Controller>,
    ) -> Result<Self, SimulationError> {
        let (start, plant) = begin(rig, beginning);
        let plant = Plant::new(rig, &plant, start, 0).map_err(SimulationError::Start)?;
        let homed = beginning == Beginning::Hanging;
        let zero = homed.then(|| plant.unstretched_at_zero_m());
        controller.start(&control_settings::settings(rig, &rig.gains, zero))?;
        let mut leg = Self {
            plant,
            controller,
            ticks: 0,
        };
        while leg.advance(&[])?.telemetry.state == State::Boot {}
        Ok(leg)
    }

    fn advance(&mut self, bytes: &[u8]) -> Result<TickReply, ControllerError> {
        let sensors = self.plant.sense();
        let reply = self.controller.tick(&sensors, bytes)?;
        self.plant.step(&reply.motors);
        self.ticks += 1;
        Ok(reply)
    }

    /// One tick: takes what of the host's bytes reaches the leg in it, and gives what the host gets.
    ///
    /// # Errors
    /// A controller that fails.
    pub fn tick(
        &mut self,
        incoming: &mut VecDeque<u8>,
    ) -> Result<impl Iterator<Item = u8> + use<>, ControllerError> {
        let count = incoming.len().min(LINK_BYTES_MAX);
        let bytes: heapless::Vec<u8, LINK_BYTES_MAX> = incoming.drain(..count).collect();
        Ok(self.advance(&bytes)?.link.into_iter())
    }

    /// The leg's time since its start.
    #[must_use]
    pub fn time(&self) -> Duration {
        Duration::from_nanos(self.ticks * (1_000_000_000 / u64::from(TICK_HZ)))
    }

    /// What is done to the leg from outside goes here.
    pub fn plant(&mut self) -> &mut Plant {
        &mut self.plant
    }
}

/// A leg that is homed has its load cells tared.
fn begin(rig: &RigFile, beginning: Beginning) -> (Start, PlantSettings) {
    match beginning {
        Beginning::Slack(slack_m) => (Start::Slack { slack_m }, rig.plant),
        Beginning::Hanging => {
            let start = Start::Held {
                azimuth_deg: 0.0,
                tilt_deg: 0.0,
                pretension_n: rig.pretension_n,
                payload_kg: 0.0,
            };
            let plant = PlantSettings {
                cell_offset_n: [0.0; 3],
                ..rig.plant
            };
            (start, plant)
        }
    }
}

/// A controller behind a link that belongs to it.
pub struct Behind(Box<dyn Link>);

impl Behind {
    /// The controller behind `link`.
    #[must_use]
    pub fn new(link: Box<dyn Link>) -> Self {
        Self(link)
    }
}

impl Controller for Behind {
    fn start(&mut self, settings: &Settings) -> Result<(), ControllerError> {
        OnLink::new(self.0.as_mut(), false).start(settings)
    }

    fn tick(&mut self, sensors: &Sensors, link: &[u8]) -> Result<TickReply, ControllerError> {
        OnLink::new(self.0.as_mut(), false).tick(sensors, link)
    }
}
