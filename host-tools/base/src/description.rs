//! States, reactions and faults as text.

use leg_firmware::supervisor::{FaultSet, Reaction, State};

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

fn joined(faults: FaultSet, text: fn(leg_firmware::supervisor::Fault) -> String) -> String {
    let texts: Vec<_> = faults.faults().map(text).collect();
    texts.join("; ")
}

/// Bytes in hexadecimal digits: a schema's hash, for instance.
#[must_use]
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
