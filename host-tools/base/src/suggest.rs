//! Help for a key that was mistyped.

/// How alike two keys have to be before one is offered for the other.
const ALIKE: f64 = 0.8;

/// A sentence that offers the nearest of the known keys, or all of them when none is near.
#[must_use]
pub fn key_remedy(given: &str, known: &[&str]) -> String {
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
