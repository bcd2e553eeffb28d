//! States, reactions and faults as text.

use leg_firmware::supervisor::{Fault, FaultSet, Reaction, State};

/// A state.
#[must_use]
pub const fn state(state: State) -> &'static str {
    match state {
        State::Boot => "booting",
        State::Disarmed => "disarmed",
        State::Homing => "homing",
        State::Active => "active",
        State::KeepingStation => "keeping station",
        State::Held => "held",
        State::RampingDown => "ramping down",
        State::Off => "off",
        State::Jogging => "jogging",
    }
}

/// A reaction.
#[must_use]
pub const fn reaction(reaction: Reaction) -> &'static str {
    match reaction {
        Reaction::Limit => "limit",
        Reaction::Hold => "hold",
        Reaction::RampDown => "ramp down",
        Reaction::GateOff => "gate off",
    }
}

/// The names of faults; `none` for none.
#[must_use]
pub fn faults(faults: FaultSet) -> String {
    let names: Vec<_> = faults.faults().map(|fault| fault.entry().name).collect();
    if names.is_empty() {
        "none".into()
    } else {
        names.join(", ")
    }
}

/// Each fault with what raises it.
#[must_use]
pub fn causes(faults: FaultSet) -> String {
    joined(faults, |fault| {
        let entry = fault.entry();
        format!("fault {}, {}: {}", fault.code(), entry.name, entry.cause)
    })
}

/// What a leg does without its host.
pub const WITHOUT_HOST: &str = "a leg that homes or follows commands is held by itself, one that jogs is switched off; one that keeps station \
                                goes on and moves by itself";

/// What to do about each.
#[must_use]
pub fn remedies(faults: FaultSet) -> String {
    joined(faults, |fault| fault.entry().remedy.into())
}

/// The words of a remedy by which it says itself that the fault is cleared.
const CLEARED: &str = "clear the fault";

/// What to do about each, and that they are cleared then; `clear` is the name of the command where it is read.
#[must_use]
pub fn remedies_and_clear(faults: FaultSet, clear: &str) -> String {
    let named = format!("{CLEARED} ({clear})");
    let remedies = joined(faults, |fault| {
        fault.entry().remedy.replacen(CLEARED, &named, 1)
    });
    let mut all = faults.faults();
    if all.all(|fault| fault.entry().remedy.contains(CLEARED)) {
        return remedies;
    }
    format!("{remedies}; then {clear}")
}

fn joined(faults: FaultSet, text: impl Fn(Fault) -> String) -> String {
    let texts: Vec<_> = faults.faults().map(text).collect();
    texts.join("; ")
}

/// Bytes in hexadecimal digits: a schema's hash, for instance.
#[must_use]
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::remedies_and_clear;
    use leg_firmware::supervisor::{Fault, FaultSet};

    /// Each is cleared once, and after all causes are removed.
    #[test]
    fn a_clear_follows_the_remedies_and_is_named() {
        let words = |faults: &[Fault]| {
            let all = faults.iter().copied().map(FaultSet::single);
            remedies_and_clear(all.fold(FaultSet::NONE, FaultSet::union), "`leg clear`")
        };
        let driver = words(&[Fault::DriverFault]);
        assert!(driver.ends_with("; then `leg clear`"), "{driver}");
        let reversed = words(&[Fault::EncoderReversed]);
        assert!(
            reversed.ends_with("then clear the fault (`leg clear`) and home"),
            "{reversed}"
        );
        let both = words(&[Fault::DriverFault, Fault::EncoderReversed]);
        assert!(both.ends_with("; then `leg clear`"), "{both}");
        assert!(both.contains(&driver.replace("; then `leg clear`", "")));
    }
}
