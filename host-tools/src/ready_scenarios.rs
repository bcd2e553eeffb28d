//! The scenarios that come with the program.

/// A ready scenario.
#[derive(Clone, Copy, Debug)]
pub struct ReadyScenario {
    /// Its name.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
}

macro_rules! ready {
    ($($name:literal),* $(,)?) => {
        &[$(ReadyScenario { name: $name, text: include_str!(concat!("../scenarios/", $name, ".toml")) }),*]
    };
}

/// Every ready scenario; the first is the default.
pub const READY_SCENARIOS: &[ReadyScenario] = ready!["fig9"];

/// The ready scenario of a name.
#[must_use]
pub fn named(name: &str) -> Option<ReadyScenario> {
    READY_SCENARIOS
        .iter()
        .copied()
        .find(|ready| ready.name == name)
}

/// All names, for messages.
#[must_use]
pub fn names() -> String {
    let names: Vec<_> = READY_SCENARIOS.iter().map(|ready| ready.name).collect();
    names.join(", ")
}
