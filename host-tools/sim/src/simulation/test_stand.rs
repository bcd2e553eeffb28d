//! The emulated leg of a scenario, its host, and what is seen of it.

use super::SimulationError;
use super::host::Host;
use super::observer::Observer;
use crate::emulated_leg::EmulatedLeg;
use crate::link::Link;
use crate::plant::Plant;
use crate::scenario::{CommandStep, Scenario};
use leg_firmware::sensors::Sensors;
use leg_firmware_bench::protocol::TickReply;
use leg_rig::rig_file::RigFile;

/// Everything but the steps.
pub(super) struct TestStand<'a> {
    leg: EmulatedLeg<&'a mut dyn Link>,
    pub host: Host,
    pub seen: Observer,
}

impl<'a> TestStand<'a> {
    pub fn new(leg: EmulatedLeg<&'a mut dyn Link>, rig: &RigFile, scenario: &Scenario) -> Self {
        Self {
            seen: Observer::new(rig, leg.plant().truth(), scenario.start.direction()),
            host: Host::new(scenario.seed),
            leg,
        }
    }

    pub fn time_s(&self) -> f64 {
        self.plant().time_s()
    }

    pub fn plant(&self) -> &Plant {
        self.leg.plant()
    }

    pub fn plant_mut(&mut self) -> &mut Plant {
        self.leg.plant_mut()
    }

    /// Sends a command.
    pub fn command(&mut self, step: &CommandStep) -> Result<(), SimulationError> {
        let command = step.command();
        self.seen.note_command(&command);
        self.host.send(&command)
    }

    /// One tick.
    ///
    /// # Errors
    /// [`SimulationError::NotFinite`] if a number is lost; a link that fails.
    pub fn tick(
        &mut self,
        watch: impl FnOnce(&Sensors, &[u8], &TickReply),
    ) -> Result<(), SimulationError> {
        let time_s = self.time_s();
        let link = self.host.outgoing(self.seen.ticks);
        let (sensors, reply) = self.leg.advance(link.clone())?;
        watch(&sensors, &link, &reply);
        let truth = self.leg.plant().truth();
        let numbers = truth.tensions_n.iter().chain(truth.tip_m.iter());
        if !numbers.copied().all(f64::is_finite) {
            return Err(SimulationError::NotFinite { time_s });
        }
        self.seen.take(time_s, truth, &reply);
        Ok(())
    }
}
