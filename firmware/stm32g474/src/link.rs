//! The host's line without its wires: what every transport does with the bytes.

use crate::check_ins::CHECK_INS;
use crate::control::SharedLeg;
use crate::settings_task::{SAVED, TO_SAVE};
use leg_firmware::board::WatchedTask;
use leg_firmware::host_link::HostLink;
use leg_firmware::settings::Settings;

/// Time from one report to the next where nothing comes in, ms.
pub const REPORT_MS: u64 = 1;

/// The leg's end of the line, and the leg.
pub struct Session {
    link: HostLink,
    leg: SharedLeg,
    /// Where settings are put for the task that keeps them; none while it has them.
    place: Option<&'static mut Settings>,
}

impl Session {
    /// A line on which nothing was said yet.
    pub fn new(link: HostLink, leg: SharedLeg, place: &'static mut Settings) -> Self {
        let place = Some(place);
        Self { link, leg, place }
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
        if let Some((kept, place)) = SAVED.try_take() {
            self.place = Some(place);
            self.link.saved(kept);
        } else if let Some(settings) = self.link.unsaved_settings()
            && let Some(place) = self.place.take()
        {
            place.clone_from(settings);
            TO_SAVE.signal(place);
        }
    }

    /// The next byte for the host.
    pub fn transmit(&mut self) -> Option<u8> {
        self.link.transmit()
    }
}
