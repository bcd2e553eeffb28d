//! Rig files as TOML and as JSON, with the same keys.

use crate::rig_file::RigText;
use clap::ValueEnum;
use leg_base::failure::Failure;

/// A format for rig files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RigFormat {
    /// What every command reads.
    Toml,
    /// For other programs.
    Json,
}

/// Converts a rig file, after a check of what it says; with the notes on it.
///
/// # Errors
/// A [`Failure`] that names the place in a TOML file; what is no JSON object.
pub fn convert(source: &RigText, to: RigFormat) -> Result<(String, Vec<String>), Failure> {
    let toml = if source.text.trim_start().starts_with('{') {
        let text = from_json(source)?;
        let name = source.name.clone();
        RigText { name, text }
    } else {
        source.clone()
    };
    let (_, notes) = toml.read()?;
    let text = match to {
        RigFormat::Toml => toml.text,
        RigFormat::Json => to_json(&toml.name, &toml.text)?,
    };
    Ok((text, notes))
}

fn from_json(source: &RigText) -> Result<String, Failure> {
    let refused = |reason: &dyn std::fmt::Display| {
        let help = "give the keys of a rig file as one JSON object; `leg rig convert table1 --to json` shows one";
        let sentence = format!("{} cannot be read as JSON: {reason}", source.name);
        Failure::refused(sentence, help)
    };
    let value: serde_json::Value =
        serde_json::from_str(&source.text).map_err(|error| refused(&error))?;
    let value = toml_value(&value).ok_or_else(|| refused(&"a rig file has no null"))?;
    toml::to_string(&value).map_err(|error| refused(&error))
}

/// The same value in TOML; none for null and what holds it.
///
/// Not by serde: where another crate enables serde_json's arbitrary precision, a number would become a table.
fn toml_value(value: &serde_json::Value) -> Option<toml::Value> {
    use serde_json::Value;
    Some(match value {
        Value::Null => return None,
        Value::Bool(truth) => toml::Value::Boolean(*truth),
        Value::Number(number) => match number.as_i64() {
            Some(integer) => toml::Value::Integer(integer),
            None => toml::Value::Float(number.as_f64()?),
        },
        Value::String(word) => toml::Value::String(word.clone()),
        Value::Array(values) => {
            toml::Value::Array(values.iter().map(toml_value).collect::<Option<_>>()?)
        }
        Value::Object(entries) => {
            let entry = |(key, value): (&String, &Value)| Some((key.clone(), toml_value(value)?));
            toml::Value::Table(entries.iter().map(entry).collect::<Option<_>>()?)
        }
    })
}

fn to_json(name: &str, toml_text: &str) -> Result<String, Failure> {
    let refused = |error: &dyn std::error::Error| {
        let help = "compare with the ready rigs, `leg rig list`";
        Failure::refused(format!("{name} has no form in JSON: {error}"), help)
    };
    let value: toml::Value = toml::from_str(toml_text).map_err(|error| refused(&error))?;
    match serde_json::to_string_pretty(&value) {
        Ok(json) => Ok(json + "\n"),
        Err(error) => Err(refused(&error)),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{RigFormat, convert};
    use crate::ready_rigs::READY_RIGS;
    use crate::rig_file::{RigFile, RigText};

    #[test]
    fn there_and_back_leaves_the_rig_as_it_is() {
        let more = "[control.limits]\njump_n = 30\n[actuator]\ncell_range_n = [-10, 200]\n[calibration]\n\
                    counts_sign = [1, -1, 1]\n[simulation]\nambient_c = 20\n";
        let with_more = [READY_RIGS[0].text, more].concat();
        for rig in READY_RIGS
            .map(|rig| rig.text)
            .into_iter()
            .chain([&*with_more])
        {
            let source = |text: &str| RigText {
                name: "test".into(),
                text: text.into(),
            };
            let json = convert(&source(rig), RigFormat::Json).unwrap().0;
            let back = convert(&source(&json), RigFormat::Toml).unwrap().0;
            let [before, after] = [rig, &back].map(|text| RigFile::parse("test", text).unwrap());
            assert_eq!(before, after);
        }
    }

    #[test]
    fn what_is_no_rig_is_refused() {
        let source = RigText {
            name: "x.json".into(),
            text: "{\"geometry\": 3}".into(),
        };
        assert!(convert(&source, RigFormat::Toml).is_err());
    }
}
