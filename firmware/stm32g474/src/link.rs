//! The host's line without its wires: what every transport does with the bytes.

use crate::check_ins::CHECK_INS;
use crate::control::SharedLeg;
use crate::settings_task::{SAVED, TO_SAVE};
use leg_firmware::board::WatchedTask;
use leg_firmware::host_link::HostLink;

/// Time from one report to the next where nothing comes in, ms.
pub const REPORT_MS: u64 = 1;

/// The leg's end of the line, and the leg.
pub struct Session {
    link: HostLink,
    leg: SharedLeg,
    saving: bool,
}

impl Session {
    /// A line on which nothing was said yet.
    pub fn new(link: HostLink, leg: SharedLeg) -> Self {
        Self {
            link,
            leg,
            saving: false,
        }
    }

    /// Takes bytes from the host.
    pub fn receive(&mut self, bytes: &[u8]) {
        self.link.receive(bytes, &mut self.leg);
    }

    /// Whoever serves the line is alive.
    pub fn alive(&self) {
        CHECK_INS.check_in(WatchedTask::Link);
    }

    /// What has to be done about every millisecond, whatever comes in.
    pub fn turn(&mut self) {
        self.alive();
        self.link.report(&mut self.leg);
        self.save();
    }

    /// Passes settings on to the task that keeps them, and its answer to the host.
    fn save(&mut self) {
        if self.saving {
            if let Some(kept) = SAVED.try_take() {
                self.saving = false;
                self.link.saved(kept);
            }
        } else if let Some(settings) = self.link.to_save() {
            self.saving = true;
            TO_SAVE.signal(settings.clone());
        }
    }

    /// The next byte for the host.
    pub fn transmit(&mut self) -> Option<u8> {
        self.link.transmit()
    }
}
