//! The text of a rig file by its keys: where a value is changed, comments and order stay.

use toml_edit::{DocumentMut, Item, Table, TableLike, Value};

/// Every key with a value, with its section, in the order of the file.
#[must_use]
pub fn keys(document: &DocumentMut) -> Vec<[String; 2]> {
    let mut found = Vec::new();
    collect("", document.as_table(), &mut found);
    found
}

fn collect(section: &str, table: &dyn TableLike, found: &mut Vec<[String; 2]>) {
    for (key, item) in table.iter() {
        match item.as_table_like() {
            Some(inner) if section.is_empty() => collect(key, inner, found),
            Some(inner) => collect(&format!("{section}.{key}"), inner, found),
            None => found.push([section.into(), key.into()]),
        }
    }
}

/// A value in one line; none if the file does not give it.
#[must_use]
pub fn value(document: &DocumentMut, section: &str, key: &str) -> Option<String> {
    let table = section
        .split('.')
        .try_fold(document.as_table() as &dyn TableLike, |table, name| {
            table.get(name)?.as_table_like()
        });
    table?.get(key)?.as_value().map(line)
}

fn line(value: &Value) -> String {
    match value {
        Value::Array(entries) => {
            let entries: Vec<String> = entries.iter().map(line).collect();
            format!("[{}]", entries.join(", "))
        }
        value => value.to_string().trim().into(),
    }
}

/// Gives a key a value; none where a section's name is that of a value.
#[must_use]
pub fn set(document: &mut DocumentMut, section: &str, key: &str, mut value: Value) -> Option<()> {
    let table = section_mut(document, section, true)?;
    match table.get_mut(key) {
        Some(item) => {
            if let Some(old) = item.as_value() {
                *value.decor_mut() = old.decor().clone();
            }
            *item = Item::Value(value);
        }
        None => {
            table.insert(key, Item::Value(value));
        }
    }
    Some(())
}

/// Takes a key out, if it is there.
pub fn remove(document: &mut DocumentMut, section: &str, key: &str) {
    if let Some(table) = section_mut(document, section, false) {
        table.remove(key);
    }
}

/// A section; one that is not there is made at the end if that is wanted.
fn section_mut<'a>(
    document: &'a mut DocumentMut,
    section: &str,
    make: bool,
) -> Option<&'a mut dyn TableLike> {
    let mut table: &mut dyn TableLike = document.as_table_mut();
    for name in section.split('.') {
        if table.get(name).is_none() {
            if !make {
                return None;
            }
            table.insert(name, Item::Table(new_section()));
        }
        table = table.get_mut(name)?.as_table_like_mut()?;
    }
    Some(table)
}

/// Its heading is written once it has a key.
fn new_section() -> Table {
    let mut table = Table::new();
    table.set_implicit(true);
    table.decor_mut().set_prefix("\n");
    table
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{keys, remove, set, value};
    use leg_rig::ready_rigs::READY_RIGS;
    use toml_edit::DocumentMut;

    fn document() -> DocumentMut {
        READY_RIGS[0].text.parse().unwrap()
    }

    #[test]
    fn a_change_leaves_everything_else_as_it_is() {
        let mut changed = document();
        set(&mut changed, "geometry", "leg_mm", 250.5.into()).unwrap();
        let expected = READY_RIGS[0].text.replace("leg_mm = 190", "leg_mm = 250.5");
        assert_eq!(changed.to_string(), expected);
        let old = "190".parse().unwrap();
        set(&mut changed, "geometry", "leg_mm", old).unwrap();
        assert_eq!(changed.to_string(), READY_RIGS[0].text);
    }

    #[test]
    fn a_section_that_is_not_there_is_made_and_a_key_is_taken_out_again() {
        let mut changed = document();
        for (section, key) in [("control.limits", "jump_n"), ("actuator", "gear_ratio")] {
            assert_eq!(value(&changed, section, key), None);
            set(&mut changed, section, key, 30.into()).unwrap();
        }
        let text = changed.to_string();
        assert!(text.contains("\n[control.limits]\njump_n = 30\n"), "{text}");
        assert!(text.contains("\n[actuator]\ngear_ratio = 30\n"), "{text}");
        assert!(!text.contains("\n[control]\n"), "{text}");
        let again: DocumentMut = text.parse().unwrap();
        assert_eq!(value(&again, "control.limits", "jump_n").unwrap(), "30");
        remove(&mut changed, "control.limits", "jump_n");
        remove(&mut changed, "no.such", "key");
        assert_eq!(value(&changed, "control.limits", "jump_n"), None);
    }

    #[test]
    fn keys_are_listed_and_values_stand_in_one_line() {
        let found = keys(&document());
        assert_eq!(found[0], ["geometry", "upper_mm"]);
        assert!(
            found
                .iter()
                .any(|key| key == &["tendon.curve", "elongation_mm"])
        );
        let curve = value(&document(), "tendon.curve", "elongation_mm").unwrap();
        assert!(curve.starts_with("[0.0, 0.07349564446976774, ") && !curve.contains('\n'));
        let anchors = value(&document(), "geometry", "base_anchors_mm").unwrap();
        assert!(anchors.starts_with("[[24, 0], [-12, "), "{anchors}");
        let kind = value(&document(), "support", "kind").unwrap();
        assert_eq!(kind, "\"torsion_free\"");
    }
}
