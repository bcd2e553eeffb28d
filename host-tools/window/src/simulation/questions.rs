//! What the simulated leg is asked besides commands: as a live one, by the link's own messages.

use super::Simulation;
use leg_firmware::host_link::{HostReply, HostRequest};
use leg_firmware::jog::JogReport;
use leg_firmware::sensors::Sensors;

/// What was asked, and what came.
#[derive(Debug, Default)]
pub struct Questions {
    /// Whether something is not answered yet.
    waiting: bool,
    sensors: Option<Sensors>,
    jog: Option<JogReport<f32>>,
}

impl Questions {
    /// Takes what the leg replied in a tick.
    pub(super) fn take(&mut self, replies: &[(u16, HostReply)]) {
        for (_, reply) in replies {
            match reply {
                HostReply::Sensors(sensors) => self.sensors = Some(sensors.codes),
                HostReply::Jog(report) => self.jog = *report,
                _ => continue,
            }
            self.waiting = false;
        }
    }

    /// The codes that have come, once.
    pub const fn take_sensors(&mut self) -> Option<Sensors> {
        self.sensors.take()
    }

    /// What the last jog saw, once.
    pub const fn take_jog(&mut self) -> Option<JogReport<f32>> {
        self.jog.take()
    }
}

impl Simulation {
    /// Asks it, unless something is not answered yet.
    pub fn ask(&mut self, request: &HostRequest) {
        if !self.questions.waiting {
            // These requests have no numbers in them: they fit into any frame.
            self.questions.waiting = self.leg.ask(request).is_ok();
        }
    }

    /// What came of it.
    pub const fn questions_mut(&mut self) -> &mut Questions {
        &mut self.questions
    }
}
