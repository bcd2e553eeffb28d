//! The settings of a leg: read, replaced, kept and compared.

use super::request::{Repeat, done};
use super::{Operator, OperatorError};
use crate::flat_json::flatten;
use leg_firmware::host_link::{HostReply, HostRequest};
use leg_firmware::settings::Settings;
use leg_rig::recorded_signals::{self, RECORDED};
use serde_json::Value;
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

/// A setting that two sides have differently.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct SettingDifference {
    /// Its place, from the outermost name inwards: `limits.slack_n`.
    pub name: String,
    /// On the one side; none if it is not there.
    pub ours: Option<Value>,
    /// On the other side.
    pub theirs: Option<Value>,
}

/// Settings as JSON: of signals their names, not the bits.
fn json(settings: &Settings) -> Value {
    // Settings always have a form in JSON.
    let mut value = serde_json::to_value(settings).unwrap_or_default();
    let names: Vec<_> = recorded_signals::words(settings.recorded).collect();
    value[RECORDED] = names.join(", ").into();
    value
}

/// Every setting whose bits differ. What was found while homing is left out.
///
/// Equal values have equal bits: settings hold no NaN, and f32 is written without loss.
pub fn setting_differences(ours: &Settings, theirs: &Settings) -> Vec<SettingDifference> {
    let [ours, theirs] = [ours, theirs].map(|settings| json(&settings.without_zero()));
    let [ours, theirs] = [&ours, &theirs].map(|settings| flatten(settings, "."));
    let value = |settings: &[(String, &Value)], name: &str| {
        let found = settings.iter().find(|(other, _)| other == name);
        found.map(|(_, value)| (*value).clone())
    };
    let added = theirs
        .iter()
        .filter(|(name, _)| value(&ours, name).is_none());
    let differences = ours.iter().chain(added).map(|(name, _)| SettingDifference {
        name: name.clone(),
        ours: value(&ours, name),
        theirs: value(&theirs, name),
    });
    differences
        .filter(|difference| difference.ours != difference.theirs)
        .collect()
}
