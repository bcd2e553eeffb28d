//! A leg without a board: the firmware behind a link and the simulated leg that it drives, tick by tick.

use crate::link::{InProcess, Link, LinkError};
use crate::plant::{Plant, Start};
use crate::shadow::Shadow;
use leg_firmware::drive::Drive;
use leg_firmware::linked_leg::LINK_BYTES_MAX;
use leg_firmware::sensors::{Sensors, TICK_HZ};
use leg_firmware::settings::{Gains, Settings, SettingsError};
use leg_firmware::supervisor::State;
use leg_firmware_bench::protocol::{Refusal, Reply, Request, TickReply, TickRequest};
use leg_rig::control_settings;
use leg_rig::plant_settings::PlantSettings;
use leg_rig::rig_file::RigFile;
use std::collections::VecDeque;
use std::time::Duration;

/// Slack of each tendon of a leg that has to be homed, mm: enough that homing has something to reel in.
const SLACK_MM: f64 = 3.0;

/// The bytes that the user's host sends in one tick.
pub type HostBytes = heapless::Vec<u8, LINK_BYTES_MAX>;

/// How an emulated leg starts: disarmed and hanging straight down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InitialState {
    /// Homed, its tendons at the rig's pretension.
    Homed,
    /// Not homed, every tendon slack by 3 mm.
    Slack,
}

/// Why an emulated leg does not run.
#[derive(Debug, thiserror::Error)]
pub enum EmulationError {
    /// The leg cannot start so.
    #[error("the leg cannot start as the scenario says: {0}")]
    Start(leg_model::Error),
    /// The settings are refused.
    #[error("the settings are refused: {0}")]
    Settings(SettingsError),
    /// Something else is refused.
    #[error("the firmware refused ({0:?}): build host and firmware from the same sources")]
    Refused(Refusal),
    /// The reply is of another kind.
    #[error("the firmware's reply is no tick: build host and firmware from the same sources")]
    WrongReply,
    /// A number of the simulated leg is lost.
    #[error(
        "at {0:.3} s the simulated leg has no finite place or tension any more; look what acts on it"
    )]
    NotFinite(f64),
    /// The link failed.
    #[error(transparent)]
    Link(#[from] LinkError),
}

/// What changes the signals between the firmware and its leg, where a loop is broken to measure it.
pub trait SignalChange {
    /// Changes what the sensors read.
    fn sensors(&mut self, _sensors: &mut Sensors) {}
    /// Changes what the motors get.
    fn motors(&mut self, _motors: &mut Drive<f32>) {}
}

/// Nothing.
impl SignalChange for () {}

/// The firmware, wherever it runs, and the leg that it drives.
#[derive(Clone)]
pub struct EmulatedLeg<L = Box<dyn Link>> {
    plant: Plant,
    link: L,
    /// Whether the instructions of each tick are counted.
    counting: bool,
}

impl EmulatedLeg {
    /// A leg that has just started. The noise of its load cells is always the same.
    ///
    /// # Errors
    /// A rig whose start or whose settings are refused; a link that fails.
    pub fn new(
        rig: &RigFile,
        initial: InitialState,
        link: Box<dyn Link>,
    ) -> Result<Self, EmulationError> {
        let (start, settings) = match initial {
            InitialState::Slack => (Start::Slack { slack_mm: SLACK_MM }, rig.plant),
            InitialState::Homed => (Start::hanging(rig.pretension_n), tared(rig)),
        };
        let (plant, settings) = assembled(rig, &settings, &rig.gains, start, 0)?;
        let mut leg = Self::start(plant, &settings, link, false)?;
        while leg.advance(HostBytes::new())?.1.telemetry.state == State::Boot {}
        Ok(leg)
    }

    /// A leg that is another one than its firmware is set to: `real` is the mechanism with its motors, not homed and slack. Its noise
    /// follows from the seed.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn unlike(
        configured: &RigFile,
        real: &RigFile,
        link: Box<dyn Link>,
        seed: u64,
    ) -> Result<Self, EmulationError> {
        let start = Start::Slack { slack_mm: SLACK_MM };
        let plant = Plant::new(real, &real.plant, start, seed).map_err(EmulationError::Start)?;
        let settings = control_settings::settings(configured, &configured.gains, None);
        let mut leg = Self::start(plant, &settings, link, false)?;
        while leg.advance(HostBytes::new())?.1.telemetry.state == State::Boot {}
        Ok(leg)
    }

    /// One tick: takes what of the host's bytes reaches the leg in it, and gives what the host gets.
    ///
    /// # Errors
    /// A link that fails.
    pub fn tick(
        &mut self,
        incoming: &mut VecDeque<u8>,
    ) -> Result<impl Iterator<Item = u8> + use<>, EmulationError> {
        let count = incoming.len().min(LINK_BYTES_MAX);
        let (_, reply) = self.advance(incoming.drain(..count).collect())?;
        Ok(reply.link.into_iter())
    }
}

impl EmulatedLeg<InProcess> {
    /// A leg in this process at a start, with errors of its own, whose noise follows from a seed. It can be cloned.
    ///
    /// # Errors
    /// A rig whose start or whose settings are refused.
    pub fn start_in_process(
        rig: &RigFile,
        plant: &PlantSettings,
        start: Start,
        seed: u64,
    ) -> Result<Self, EmulationError> {
        Self::start_shadowed(rig, plant, start, seed).map(|(leg, _)| leg)
    }

    /// The same, and its shadow in f64.
    ///
    /// # Errors
    /// As [`Self::start_in_process`].
    pub fn start_shadowed(
        rig: &RigFile,
        plant: &PlantSettings,
        start: Start,
        seed: u64,
    ) -> Result<(Self, Shadow), EmulationError> {
        let (plant, settings) = assembled(rig, plant, &rig.gains, start, seed)?;
        let leg = Self::start(plant, &settings, InProcess::new(), false)?;
        let shadow = Shadow::new(&settings).map_err(EmulationError::Settings)?;
        Ok((leg, shadow))
    }
}

impl<L: Link> EmulatedLeg<L> {
    /// Gives the firmware its settings. With `counting` it reports the instructions of each tick.
    pub(crate) fn start(
        plant: Plant,
        settings: &Settings,
        mut link: L,
        counting: bool,
    ) -> Result<Self, EmulationError> {
        match link.ask(&Request::Start(settings.clone()))? {
            Reply::Started => Ok(Self {
                plant,
                link,
                counting,
            }),
            Reply::Refused(Refusal::Settings(error)) => Err(EmulationError::Settings(error)),
            Reply::Refused(refusal) => Err(EmulationError::Refused(refusal)),
            _ => Err(EmulationError::WrongReply),
        }
    }

    /// One tick of firmware and leg: reads the sensors, lets the control law run, and moves the leg on. Gives what the leg
    /// took, and what it made of it.
    ///
    /// # Errors
    /// A link that fails.
    pub fn advance(&mut self, link: HostBytes) -> Result<(TickRequest, TickReply), EmulationError> {
        self.advance_through(&mut (), link)
    }

    /// The same with something between firmware and leg.
    ///
    /// # Errors
    /// A link that fails.
    pub fn advance_through(
        &mut self,
        change: &mut impl SignalChange,
        link: HostBytes,
    ) -> Result<(TickRequest, TickReply), EmulationError> {
        let mut sensors = self.plant.sense();
        change.sensors(&mut sensors);
        let tick = TickRequest { sensors, link };
        let request = if self.counting {
            Request::CountTick(tick.clone())
        } else {
            Request::Tick(tick.clone())
        };
        let mut reply = match self.link.ask(&request)? {
            Reply::Ticked(reply) => reply,
            Reply::Refused(refusal) => return Err(EmulationError::Refused(refusal)),
            _ => return Err(EmulationError::WrongReply),
        };
        change.motors(&mut reply.motors);
        self.plant.step(&reply.motors);
        Ok((self.link.taken().unwrap_or(tick), reply))
    }

    /// The leg's time since its start.
    #[must_use]
    pub fn time(&self) -> Duration {
        Duration::from_nanos(self.plant.ticks * (1_000_000_000 / u64::from(TICK_HZ)))
    }

    /// The simulated leg.
    #[must_use]
    pub fn plant(&self) -> &Plant {
        &self.plant
    }

    /// The simulated leg, for what is done to it from outside.
    pub fn plant_mut(&mut self) -> &mut Plant {
        &mut self.plant
    }
}

/// A leg at its start, and the settings of its firmware.
pub(crate) fn assembled(
    rig: &RigFile,
    plant: &PlantSettings,
    gains: &Gains,
    start: Start,
    seed: u64,
) -> Result<(Plant, Settings), EmulationError> {
    let plant = Plant::new(rig, plant, start, seed).map_err(EmulationError::Start)?;
    let zero = (!start.is_slack()).then(|| plant.unstretched_at_zero_m());
    let settings = control_settings::settings(rig, gains, zero);
    Ok((plant, settings))
}

/// A leg that is homed has its load cells tared.
fn tared(rig: &RigFile) -> PlantSettings {
    PlantSettings {
        cell_offset_n: [0.0; 3],
        ..rig.plant
    }
}
