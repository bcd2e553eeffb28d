//! The table of settings: every key of a rig file with its value, unit, range, default and meaning, from the one schema.

use super::document;
use leg_rig::gains::{CONTROL, KEEPS_STATION};
use leg_rig::mechanism_keys;
use leg_rig::recorded_signals::{self, RECORDED};
use leg_rig::rig_file::RigFile;
use leg_rig::rig_settings::{self, Setting, written};
use toml_edit::DocumentMut;

/// A setting.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The section of the rig file.
    pub section: String,
    /// Its key.
    pub key: String,
    /// Its unit; empty for words and pure numbers.
    pub unit: String,
    /// As it stands in the file, or as it is without.
    pub value: String,
    /// What it is unless the file gives it; none where the file has to.
    pub default: Option<String>,
    /// Lowest and highest value; none where the model checks it.
    pub range: Option<[f64; 2]>,
    /// What it means.
    pub meaning: String,
    /// Whether the file gives it.
    pub given: bool,
    /// As numbers, which do not depend on how they are written.
    numbers: Vec<f64>,
}

impl Row {
    /// Whether it is the same setting.
    #[must_use]
    pub fn is(&self, section: &str, key: &str) -> bool {
        self.section == section && self.key == key
    }

    /// Whether both have the same value, however it is written.
    #[must_use]
    pub fn same_value(&self, other: &Self) -> bool {
        match (&self.numbers[..], &other.numbers[..]) {
            ([], []) => self.value == other.value,
            (ours, theirs) => ours == theirs,
        }
    }

    /// Whether some words are found in it, in any letters; the empty text is in all.
    #[must_use]
    pub fn contains(&self, search: &str) -> bool {
        let text = format!(
            "{}.{} {} {}",
            self.section, self.key, self.unit, self.meaning
        );
        let text = text.to_lowercase();
        let mut words = search.split_whitespace();
        words.all(|word| text.contains(&word.to_lowercase()))
    }

    fn from_schema(setting: Setting, document: &DocumentMut) -> Self {
        let given = document::value(document, &setting.section, setting.key);
        Self {
            key: setting.key.into(),
            unit: unit(setting.unit),
            given: given.is_some(),
            value: given.unwrap_or_else(|| written(&setting.value)),
            default: Some(written(&setting.default)),
            range: Some(setting.range),
            meaning: setting.meaning,
            section: setting.section,
            numbers: setting.value,
        }
    }

    fn from_file([section, key]: [String; 2], document: &DocumentMut) -> Self {
        let known = mechanism_keys::find(&section, &key);
        Self {
            value: document::value(document, &section, &key).unwrap_or_default(),
            unit: unit(known.map_or("", |known| known.unit)),
            meaning: known.map_or("", |known| known.meaning).into(),
            default: None,
            range: None,
            given: true,
            numbers: Vec::new(),
            section,
            key,
        }
    }

    fn from_control(
        key: &str,
        value: String,
        default: &str,
        meaning: &str,
        document: &DocumentMut,
    ) -> Self {
        let given = document::value(document, CONTROL, key);
        Self {
            section: CONTROL.into(),
            key: key.into(),
            unit: String::new(),
            given: given.is_some(),
            value: given.unwrap_or(value),
            default: Some(default.into()),
            range: None,
            meaning: meaning.into(),
            numbers: Vec::new(),
        }
    }
}

/// A value with its unit, if that has one.
#[must_use]
pub fn with_unit(value: &str, unit: &str) -> String {
    if unit.is_empty() {
        value.into()
    } else {
        format!("{value} {unit}")
    }
}

fn unit(unit: &str) -> String {
    if unit == "1" {
        String::new()
    } else {
        unit.into()
    }
}

/// The table of a rig and of the text that describes it: the mechanism as the file has it, then every field of the schema.
#[must_use]
pub fn rows(rig: &RigFile, document: &DocumentMut) -> Vec<Row> {
    let schema = [
        rig_settings::control(rig),
        rig_settings::actuator(rig),
        rig_settings::simulation(rig),
    ];
    let schema: Vec<Row> = schema
        .into_iter()
        .flatten()
        .map(|setting| Row::from_schema(setting, document))
        .collect();
    let recorded: Vec<_> = recorded_signals::words(rig.recorded).collect();
    let control = [
        Row::from_control(
            KEEPS_STATION,
            rig.keeps_station.to_string(),
            "true",
            "Whether the leg keeps station after a move, or is held.",
            document,
        ),
        Row::from_control(
            RECORDED,
            format!("{recorded:?}"),
            "[]",
            "What the board's recorder keeps of every tick, as an array of words in quotes.",
            document,
        ),
    ];
    let known = |key: &[String; 2]| {
        let [section, key] = key;
        schema
            .iter()
            .chain(&control)
            .any(|row| row.is(section, key))
    };
    let file = document::keys(document);
    let mechanism = file.into_iter().filter(|key| !known(key));
    let mut rows: Vec<Row> = mechanism.map(|key| Row::from_file(key, document)).collect();
    rows.extend(control.clone());
    rows.extend(schema.clone());
    rows
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{Row, rows};
    use leg_firmware::settings::SECTIONS;
    use leg_rig::ready_rigs::READY_RIGS;
    use leg_rig::rig_file::RigFile;

    fn table(text: &str) -> Vec<Row> {
        let rig = RigFile::parse("test", text).unwrap();
        rows(&rig, &text.parse().unwrap())
    }

    fn find(rows: &[Row], section: &str, key: &str) -> Row {
        let row = rows.iter().find(|row| row.is(section, key));
        row.unwrap_or_else(|| panic!("[{section}] {key}")).clone()
    }

    #[test]
    fn every_field_of_the_schema_stands_once_with_its_meaning() {
        for rig in READY_RIGS {
            let rows = table(rig.text);
            for (name, fields) in SECTIONS {
                for field in fields {
                    let row = find(&rows, &format!("control.{name}"), field.name);
                    assert_eq!(row.meaning, field.meaning.trim());
                    assert!(row.range.is_some() && row.default.is_some());
                }
            }
            for row in &rows {
                let same = rows.iter().filter(|other| other.is(&row.section, &row.key));
                assert_eq!(same.count(), 1, "[{}] {}", row.section, row.key);
                assert!(!row.meaning.is_empty(), "[{}] {}", row.section, row.key);
                assert!(!row.value.is_empty(), "[{}] {}", row.section, row.key);
            }
        }
    }

    #[test]
    fn a_value_is_the_files_or_what_follows() {
        let text = [READY_RIGS[0].text, "[control.limits]\njump_n = 30.0\n"].concat();
        let rows = table(&text);
        let given = find(&rows, "control.limits", "jump_n");
        assert!(given.given);
        assert_eq!(
            [given.value.as_str(), given.default.as_deref().unwrap()],
            ["30.0", "25"]
        );
        let other = text.replace("30.0", "30");
        assert!(given.same_value(&find(&table(&other), "control.limits", "jump_n")));
        let left_out = find(&rows, "control.limits", "slack_n");
        assert!(!left_out.given && left_out.value == "2" && left_out.unit == "N");
        let length = find(&rows, "geometry", "leg_mm");
        assert!(length.value == "190" && length.unit == "mm" && length.default.is_none());
    }

    #[test]
    fn words_are_searched_in_key_and_meaning() {
        let rows = table(READY_RIGS[0].text);
        let row = find(&rows, "control.limits", "slack_n");
        assert!(row.contains("") && row.contains("SLACK limits") && row.contains("tendon below"));
        assert!(!row.contains("slack motion"));
    }
}
