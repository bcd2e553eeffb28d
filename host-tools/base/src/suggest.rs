//! The fix for a key that was mistyped.

/// How alike two keys have to be before one is offered for the other.
const ALIKE: f64 = 0.8;

/// A sentence that offers the nearest of the known keys, or all of them when none is near.
#[must_use]
pub fn for_key(given: &str, known: &[&str]) -> String {
    let likeness = |key: &&str| strsim::jaro_winkler(given, key);
    let nearest = known
        .iter()
        .copied()
        .filter(|key| likeness(key) >= ALIKE)
        .max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    match nearest {
        Some(key) if unit(key) == unit(given) => format!("the key here is `{key}`"),
        Some(key) => format!("the key here is `{key}`; mind its unit"),
        None => format!("the keys here are {}", list(known)),
    }
}

/// The end of a key that names a unit: `mm` in `upper_mm`.
fn unit(key: &str) -> Option<&str> {
    key.rsplit_once('_').map(|(_, unit)| unit)
}

fn list(known: &[&str]) -> String {
    let quoted: Vec<String> = known.iter().map(|key| format!("`{key}`")).collect();
    quoted.join(", ")
}

#[cfg(test)]
mod tests {
    use super::for_key;

    #[test]
    fn a_wrong_unit_is_answered_with_the_right_one() {
        assert_eq!(
            for_key("upper_cm", &["upper_mm", "joint_mm", "leg_mm"]),
            "the key here is `upper_mm`; mind its unit"
        );
    }

    #[test]
    fn a_slip_of_the_pen_is_answered_with_the_right_key() {
        assert_eq!(
            for_key("uper_mm", &["upper_mm"]),
            "the key here is `upper_mm`"
        );
        assert_eq!(for_key("masses", &["mass"]), "the key here is `mass`");
    }

    #[test]
    fn a_strange_key_is_answered_with_all_of_them() {
        assert_eq!(
            for_key("colour", &["leg_kg", "pretension_n"]),
            "the keys here are `leg_kg`, `pretension_n`"
        );
    }
}
