//! Every signal of a leg, declared once: JSON, tables, recordings, datagrams and Python have these names and no others.
//!
//! Names end with their units: SI, but for degrees and for tips in mm. Directions and tips are in frame {A}. `docs/telemetry.md` has
//! the same as a table, which a test makes.

mod encoding;
mod reading;
mod recorded;
mod report;
mod simulated;

pub use encoding::{columns, json_object, json_schema, row};
pub use reading::{comparison, numbers, recorder_row, telemetry};
pub use recorded::RECORDER_SIGNALS;
pub use report::{LegConstants, REPORT_SIGNALS, Report};
pub use simulated::{SIMULATED_SIGNALS, Simulated};

use leg_firmware::supervisor::FaultSet;

/// What a signal is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// When, and of which leg.
    Context,
    /// What the leg does and may do.
    State,
    /// What was commanded.
    Commanded,
    /// What its trajectory and its target ask for now.
    Reference,
    /// What its sensors read.
    Measured,
    /// What it concludes from them.
    Estimated,
    /// What is true of a simulated leg, which no sensor says.
    True,
}

impl Origin {
    /// In words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Context => "context",
            Self::State => "state",
            Self::Commanded => "commanded",
            Self::Reference => "reference",
            Self::Measured => "measured",
            Self::Estimated => "estimated",
            Self::True => "true",
        }
    }
}

/// A signal of what `S` holds.
pub struct Signal<S> {
    /// Its name, which ends with its unit.
    pub name: &'static str,
    /// What it is.
    pub origin: Origin,
    /// What it means.
    pub meaning: &'static str,
    /// Its values.
    pub values: Values<S>,
}

/// What a signal has as values, and where they are.
pub enum Values<S> {
    /// One number; not a number where there is none.
    Number(fn(&S) -> f64),
    /// One for each of two coordinates.
    Two(fn(&S) -> [f64; 2]),
    /// One for each tendon or coordinate.
    Three(fn(&S) -> [f64; 3]),
    /// The same of an f32 of the firmware.
    Single(fn(&S) -> f32),
    /// The same of two.
    SingleTwo(fn(&S) -> [f32; 2]),
    /// The same of three.
    SingleThree(fn(&S) -> [f32; 3]),
    /// Counted from 0; none where nobody counts.
    Count(fn(&S) -> Option<u64>),
    /// Whether something is so.
    Flag(fn(&S) -> bool),
    /// A word.
    Word(fn(&S) -> &'static str),
    /// Names.
    Names(fn(&S) -> Vec<&'static str>),
}

impl<S> Signal<S> {
    /// How many numbers it has; none if it has words.
    #[must_use]
    pub const fn width(&self) -> Option<usize> {
        match self.values {
            Values::Number(_) | Values::Single(_) | Values::Count(_) | Values::Flag(_) => Some(1),
            Values::Two(_) | Values::SingleTwo(_) => Some(2),
            Values::Three(_) | Values::SingleThree(_) => Some(3),
            Values::Word(_) | Values::Names(_) => None,
        }
    }

    /// Its numbers: 1 and 0 for a flag, not a number where there is none; nothing of words.
    pub fn numbers(&self, of: &S, out: &mut Vec<f64>) {
        match self.values {
            Values::Number(read) => out.push(read(of)),
            Values::Two(read) => out.extend(read(of)),
            Values::Three(read) => out.extend(read(of)),
            Values::Single(read) => out.push(read(of).into()),
            Values::SingleTwo(read) => out.extend(read(of).map(f64::from)),
            Values::SingleThree(read) => out.extend(read(of).map(f64::from)),
            Values::Count(read) => out.push(read(of).map_or(f64::NAN, |count| count as f64)),
            Values::Flag(read) => out.push(f64::from(u8::from(read(of)))),
            Values::Word(_) | Values::Names(_) => {}
        }
    }
}

fn fault_names(faults: FaultSet) -> Vec<&'static str> {
    faults.faults().map(|fault| fault.entry().name).collect()
}

/// Declares the signals of something.
macro_rules! signals {
    ($(#[$meta:meta])* $table:ident of $of:ty;
     $($origin:ident $kind:ident $name:ident $meaning:literal = $read:expr;)*) => {
        $(#[$meta])*
        pub const $table: &[Signal<$of>] = &[$(Signal {
            name: stringify!($name),
            origin: Origin::$origin,
            meaning: $meaning,
            values: Values::$kind($read),
        },)*];
    };
}
use signals;

#[cfg(test)]
mod tests;
