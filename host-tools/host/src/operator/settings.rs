//! The settings of a leg: read, replaced, kept and compared.

use super::asking::Repeat;
use super::{Operator, OperatorError};
use leg_firmware::host_link::{HostReply, HostRequest};
use leg_firmware::settings::Settings;
use serde_json::Value;
use std::time::Duration;

/// Longest time in which a board keeps its settings.
const SAVE_TIME: Duration = Duration::from_secs(3);

impl Operator {
    /// The settings in use.
    ///
    /// # Errors
    /// As [`Self::command`].
    pub fn settings(&mut self) -> Result<Settings, OperatorError> {
        let asked = "tell its settings";
        match self.ask(asked, &HostRequest::GetSettings, Repeat::Always)? {
            HostReply::Settings(settings) => Ok(settings),
            _ => Err(OperatorError::WrongReply { asked }),
        }
    }

    /// Replaces the settings in use, reads them back and compares their bits. The leg has to be homed then.
    ///
    /// # Errors
    /// As [`Self::command`]; [`OperatorError::ReadBack`].
    pub fn set_settings(&mut self, settings: &Settings) -> Result<(), OperatorError> {
        let asked = "take the settings";
        let request = HostRequest::SetSettings(settings.clone());
        self.silence_max = None;
        match self.ask(asked, &request, Repeat::Always)? {
            HostReply::Done => {}
            _ => return Err(OperatorError::WrongReply { asked }),
        }
        let found = self.settings()?;
        let names: Vec<String> = differences(settings, &found)
            .into_iter()
            .map(|difference| difference.name)
            .collect();
        if names.is_empty() {
            return Ok(());
        }
        Err(OperatorError::ReadBack { names })
    }

    /// Lets the board keep the settings in use over a reset.
    ///
    /// # Errors
    /// As [`Self::command`].
    pub fn save_settings(&mut self) -> Result<(), OperatorError> {
        let asked = "keep its settings";
        let request = HostRequest::SaveSettings;
        match self.ask_within(asked, &request, Repeat::IfLost, SAVE_TIME)? {
            HostReply::Done => Ok(()),
            _ => Err(OperatorError::WrongReply { asked }),
        }
    }
}

/// A setting that two sides have differently.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Difference {
    /// Its place, from the outermost name inwards: `limits.slack_n`.
    pub name: String,
    /// On the one side; none if it is not there.
    pub ours: Option<Value>,
    /// On the other side.
    pub theirs: Option<Value>,
}

/// Every setting whose bits differ. What was found while homing is left out.
#[must_use]
pub fn differences(ours: &Settings, theirs: &Settings) -> Vec<Difference> {
    let [ours, theirs] = [ours, theirs].map(|settings| named(&settings.without_zero()));
    let mut found: Vec<Difference> = ours
        .iter()
        .filter_map(|(name, value)| {
            let other = value_of(&theirs, name);
            (other != Some(value)).then(|| Difference {
                name: name.clone(),
                ours: Some(value.clone()),
                theirs: other.cloned(),
            })
        })
        .collect();
    let added = theirs
        .iter()
        .filter(|(name, _)| value_of(&ours, name).is_none());
    found.extend(added.map(|(name, value)| Difference {
        name: name.clone(),
        ours: None,
        theirs: Some(value.clone()),
    }));
    found
}

fn value_of<'a>(named: &'a [(String, Value)], name: &str) -> Option<&'a Value> {
    let found = named.iter().find(|(other, _)| other == name);
    found.map(|(_, value)| value)
}

/// Every value by its name. Equal values have equal bits: settings hold no NaN, and f32 is written without loss.
fn named(settings: &Settings) -> Vec<(String, Value)> {
    let mut values = Vec::new();
    // Settings always have a form in JSON.
    if let Ok(value) = serde_json::to_value(settings) {
        flatten(String::new(), value, &mut values);
    }
    values
}

fn flatten(name: String, value: Value, values: &mut Vec<(String, Value)>) {
    let inside = |inner: &str| {
        if name.is_empty() {
            inner.to_string()
        } else {
            format!("{name}.{inner}")
        }
    };
    match value {
        Value::Object(map) => map
            .into_iter()
            .for_each(|(key, value)| flatten(inside(&key), value, values)),
        Value::Array(items) => (1..)
            .zip(items)
            .for_each(|(number, value)| flatten(inside(&number.to_string()), value, values)),
        value => values.push((name, value)),
    }
}
