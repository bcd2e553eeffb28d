//! Keys that were renamed: the old ones are read for one release, with a note.

use crate::toml_error::TomlError;
use std::borrow::Cow;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A key that was renamed, wherever it stands below a section of a file.
#[derive(Clone, Copy)]
struct RenamedKey {
    section: &'static str,
    old: &'static str,
    new: &'static str,
}

const fn renamed(section: &'static str, old: &'static str, new: &'static str) -> RenamedKey {
    RenamedKey { section, old, new }
}

/// Every old key of rig files and scenarios. In the steps of a scenario the same word names a quantity, too.
const RENAMED_KEYS: [RenamedKey; 8] = [
    renamed("tendon", "floor_n", "f_min_n"),
    renamed("tendon", "ceiling_n", "f_max_n"),
    renamed("tendon", "level_n", "pretension_n"),
    renamed("control", "level_rate_n_per_s", "pretension_rate_n_per_s"),
    renamed("control", "ceiling_band_n", "f_max_band_n"),
    renamed("control", "ceiling_n", "f_max_n"),
    renamed("start", "level_n", "pretension_n"),
    renamed("steps", "level_n", "pretension_n"),
];

/// Keys below `[control]` that mean nothing any more: section, key and reason.
const REMOVED_KEYS: [(&str, &str, &str); 2] = [
    (
        "limits",
        "hold_travel_m",
        "the motors of a held leg rest on their screws",
    ),
    (
        "estimation",
        "payload_sine",
        "the payload is found by what shows it, a motion too",
    ),
];

/// Replaces the old keys of a file by the new ones, each at its place, and gives a note for each that was found.
///
/// # Errors
/// A table that gives a key by both of its names.
pub fn replace(file: &mut DeTable<'_>) -> Result<Vec<String>, TomlError> {
    let mut notes = Vec::new();
    for key in &RENAMED_KEYS {
        let RenamedKey { section, old, new } = key;
        if let Some(section_value) = file.get_mut(*section)
            && replace_below(section_value.get_mut(), key)?
        {
            notes.push(format!(
                "note: `{old}` in `{section}` is named `{new}` now; the old name is read for this release only"
            ));
        }
    }
    if let Some(DeValue::Table(control)) = file.get_mut("control").map(Spanned::get_mut) {
        for (section, key, reason) in REMOVED_KEYS {
            if let Some(DeValue::Table(keys)) = control.get_mut(section).map(Spanned::get_mut)
                && keys.remove(key).is_some()
            {
                notes.push(format!(
                    "note: `{key}` in `control.{section}` has no effect any more: {reason}; remove it, this release only ignores it"
                ));
            }
        }
    }
    Ok(notes)
}

/// Whether the old key was found.
fn replace_below(value: &mut DeValue<'_>, key: &RenamedKey) -> Result<bool, TomlError> {
    let mut found = false;
    match value {
        DeValue::String(word) if *word == key.old => {
            *word = Cow::Borrowed(key.new);
            found = true;
        }
        DeValue::Array(entries) => {
            for entry in entries.iter_mut() {
                found |= replace_below(entry.get_mut(), key)?;
            }
        }
        DeValue::Table(table) => {
            found = replace_key(table, key)?;
            for (_, entry) in table.iter_mut() {
                found |= replace_below(entry.get_mut(), key)?;
            }
        }
        _ => {}
    }
    Ok(found)
}

fn replace_key(table: &mut DeTable<'_>, key: &RenamedKey) -> Result<bool, TomlError> {
    let RenamedKey { old, new, .. } = *key;
    let Some((place, value)) = table.remove_entry(old) else {
        return Ok(false);
    };
    if table.contains_key(new) {
        let sentence = format!("`{old}` and `{new}` cannot both be given: they are one key");
        let help = format!("remove `{old}`, the old name");
        return Err(TomlError::new(place.span(), sentence, help));
    }
    table.insert(Spanned::new(place.span(), Cow::Borrowed(new)), value);
    Ok(true)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{RENAMED_KEYS, RenamedKey, replace};
    use crate::ready_rigs::READY_RIGS;
    use crate::rig_file::RigFile;
    use toml::de::DeTable;

    const MORE: &str = "[control.motion]\npretension_rate_n_per_s = 100\n[control.servo]\nf_max_band_n = 3\n\
                        [control.homing]\nf_max_n = 14\n";

    #[test]
    fn a_rig_file_with_old_keys_is_the_same_rig() {
        let new = [READY_RIGS[0].text, MORE].concat();
        let mut old = new.clone();
        let of_rig_files = &RENAMED_KEYS[..6];
        for key in of_rig_files {
            // [tendon] comes first, [control.homing] last: both have an `f_max_n`.
            let line = format!("\n{} = ", key.new);
            let start = match key.section {
                "tendon" => old.find(&line),
                _ => old.rfind(&line),
            };
            let start = 1 + start.unwrap();
            old.replace_range(start..start + key.new.len(), key.old);
        }
        let mut table = DeTable::parse(&old).unwrap().into_inner();
        assert_eq!(replace(&mut table).unwrap().len(), of_rig_files.len());
        let [old, new] = [&old, &new].map(|text| RigFile::parse("test", text).unwrap());
        assert_eq!(old, new);
    }

    #[test]
    fn a_removed_limit_is_noted_and_ignored() {
        let text = "[control.limits]\nhold_travel_m = 1e-3\nslack_n = 2\n";
        let mut table = DeTable::parse(text).unwrap().into_inner();
        let notes = replace(&mut table).unwrap();
        assert!(
            notes.len() == 1 && notes[0].contains("hold_travel_m"),
            "{notes:?}"
        );
        let rest = format!("{table:?}");
        assert!(!rest.contains("hold_travel_m") && rest.contains("slack_n"));
    }

    #[test]
    fn both_names_at_once_are_refused_at_the_old_one() {
        for RenamedKey { section, old, new } in RENAMED_KEYS {
            let text = format!("[{section}.any]\n{old} = 1\n{new} = 2\n");
            let mut table = DeTable::parse(&text).unwrap().into_inner();
            let error = replace(&mut table).unwrap_err();
            assert_eq!(&text[error.span], old);
            assert!(error.sentence.contains(new), "{}", error.sentence);
        }
    }

    #[test]
    fn keys_and_quantities_of_scenarios_are_replaced_at_any_depth() {
        let text = "start = { held = { level_n = 70 } }\n\
                    steps = [\"arm\", { level_n = 50 }, { measure = { quantity = \"level_n\" } }]\n";
        let mut table = DeTable::parse(text).unwrap().into_inner();
        let notes = replace(&mut table).unwrap();
        assert_eq!(notes.len(), 2, "{notes:?}");
        let rest = format!("{table:?}");
        assert!(!rest.contains("level_n") && rest.matches("pretension_n").count() == 3);
    }
}
