//! The settings of a leg: read, replaced and kept.

use super::request::{Repeat, done};
use super::{Operator, OperatorError};
use leg_firmware::host_link::{HostReply, HostRequest};
use leg_firmware::settings::Settings;
use leg_rig::settings_difference::setting_differences;
use std::time::Duration;

/// Longest time in which a board stores its settings: erasing a page of flash takes most of it.
const SAVE_TIME: Duration = Duration::from_secs(3);

impl Operator {
    /// The settings in use.
    pub fn settings(&mut self) -> Result<Settings, OperatorError> {
        let request = HostRequest::GetSettings;
        self.ask("report its settings", &request, |reply| match reply {
            HostReply::Settings(settings) => Some(settings),
            _ => None,
        })
    }

    /// Replaces the settings in use, reads them back and compares their bits. The leg has to be homed then.
    ///
    /// # Errors
    /// As [`Self::command`]; [`OperatorError::ReadBack`]; [`OperatorError::Frame`] if they are too long for a message.
    pub fn set_settings(&mut self, settings: &Settings) -> Result<(), OperatorError> {
        let request = HostRequest::SetSettings(settings.clone());
        self.silence_max = None;
        self.ask("take the settings", &request, done)?;
        let differences = setting_differences(settings, &self.settings()?);
        if differences.is_empty() {
            return Ok(());
        }
        let names = differences.into_iter().map(|difference| difference.name);
        Err(OperatorError::ReadBack(names.collect()))
    }

    /// Lets the board keep the settings in use over a reset.
    pub fn save_settings(&mut self) -> Result<(), OperatorError> {
        let asked = "keep its settings";
        let request = HostRequest::SaveSettings;
        let reply = self.exchange(asked, &request, Repeat::IfLost, SAVE_TIME)?;
        done(reply).ok_or(OperatorError::WrongReply(asked))
    }
}
