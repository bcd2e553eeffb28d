//! What two sides have differently of their settings.

use crate::current_output;
use crate::recorded_signals::{self, RECORDED};
use leg_base::flat_json::flatten;
use leg_firmware::settings::Settings;
use serde_json::Value;

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
    let outputs = settings.current_outputs.each().map(current_output::word);
    value["current_outputs"] = outputs.to_vec().into();
    value
}

/// Every setting whose bits differ. What was found while homing is left out.
///
/// Equal values have equal bits: settings hold no NaN, and f32 is written without loss.
#[must_use]
pub fn setting_differences(ours: &Settings, theirs: &Settings) -> Vec<SettingDifference> {
    let [ours, theirs] = [ours, theirs].map(|settings| json(&settings.unhomed()));
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
