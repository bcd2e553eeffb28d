//! Where the controller runs: in this process, or behind a link.

use crate::link::{Link, LinkError};
use leg_firmware::host_link::BoardKind;
use leg_firmware::sensors::Sensors;
use leg_firmware::settings::{Settings, SettingsError};
use leg_firmware_bench::boarded_leg::BoardedLeg;
use leg_firmware_bench::protocol::{Refusal, Reply, Request, TickReply, TickRequest};
use leg_firmware_bench::server;

/// Why a controller gave no duty.
#[derive(Debug, thiserror::Error)]
pub enum ControllerError {
    /// The settings are refused.
    #[error("the settings are refused: {0}")]
    Settings(SettingsError),
    /// Something else is refused.
    #[error("the firmware refused ({0:?}): build host and firmware from the same sources")]
    Refused(Refusal),
    /// The reply is of another kind.
    #[error("the firmware's reply is no tick: build host and firmware from the same sources")]
    WrongReply,
    /// Too many bytes for one tick.
    #[error("a tick takes at most 64 bytes from the link")]
    TooManyBytes,
    /// The link failed.
    #[error(transparent)]
    Link(#[from] LinkError),
}

/// The controller of a leg in f32, with its end of the user's link.
pub trait Controller {
    /// Makes a leg anew.
    ///
    /// # Errors
    /// Settings that are refused; a link that failed.
    fn start(&mut self, settings: &Settings) -> Result<(), ControllerError>;

    /// One tick.
    ///
    /// # Errors
    /// A link that failed.
    fn tick(&mut self, sensors: &Sensors, link: &[u8]) -> Result<TickReply, ControllerError>;
}

/// In this process.
#[derive(Debug, Default)]
pub struct InThisProcess {
    leg: Option<BoardedLeg>,
    /// The settings that were saved last.
    pub saved: Option<Settings>,
}

impl Controller for InThisProcess {
    fn start(&mut self, settings: &Settings) -> Result<(), ControllerError> {
        let identity = server::emulated(BoardKind::InProcess);
        let leg = BoardedLeg::new(identity, settings).map_err(ControllerError::Settings)?;
        self.leg = Some(leg);
        Ok(())
    }

    fn tick(&mut self, sensors: &Sensors, link: &[u8]) -> Result<TickReply, ControllerError> {
        let leg = self
            .leg
            .as_mut()
            .ok_or(ControllerError::Refused(Refusal::NoLeg))?;
        let saved = &mut self.saved;
        Ok(leg.tick(&tick_request(sensors, link)?, |settings| {
            *saved = Some(settings.clone());
            true
        }))
    }
}

/// Behind a link; it can count the instructions of each tick.
pub struct OnLink<'a> {
    link: &'a mut dyn Link,
    counting: bool,
    /// Instructions of each tick, if they are counted.
    pub instructions: Vec<u32>,
}

impl<'a> OnLink<'a> {
    /// The controller behind `link`.
    pub fn new(link: &'a mut dyn Link, counting: bool) -> Self {
        Self {
            link,
            counting,
            instructions: Vec::new(),
        }
    }
}

impl Controller for OnLink<'_> {
    fn start(&mut self, settings: &Settings) -> Result<(), ControllerError> {
        match self.link.ask(&Request::Start(settings.clone()))? {
            Reply::Started => Ok(()),
            Reply::Refused(Refusal::Settings(error)) => Err(ControllerError::Settings(error)),
            Reply::Refused(refusal) => Err(ControllerError::Refused(refusal)),
            _ => Err(ControllerError::WrongReply),
        }
    }

    fn tick(&mut self, sensors: &Sensors, link: &[u8]) -> Result<TickReply, ControllerError> {
        let request = tick_request(sensors, link)?;
        let request = if self.counting {
            Request::CountTick(request)
        } else {
            Request::Tick(request)
        };
        match self.link.ask(&request)? {
            Reply::Ticked(reply) => {
                self.instructions.extend(reply.instructions);
                Ok(reply)
            }
            Reply::Refused(refusal) => Err(ControllerError::Refused(refusal)),
            _ => Err(ControllerError::WrongReply),
        }
    }
}

fn tick_request(sensors: &Sensors, link: &[u8]) -> Result<TickRequest, ControllerError> {
    Ok(TickRequest {
        sensors: *sensors,
        link: heapless::Vec::from_slice(link).map_err(|_| ControllerError::TooManyBytes)?,
    })
}
