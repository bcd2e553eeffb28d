//! What is done to an emulated leg from outside, as a line of JSON: `{"payload":{"kg":2}}`.

use crate::plant::faults::from_one;
use crate::plant::{Fault, Plant};
use serde::Deserialize;

/// One thing that is done. Motors and load cells are counted from 0 here, and from 1 in a line.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Touch {
    /// Changes the payload, at once or over a time.
    Payload {
        /// kg.
        kg: f64,
        /// s.
        #[serde(default)]
        over_s: f64,
    },
    /// Lets something fail.
    Fault(Fault),
    /// Mends it.
    Repair(Fault),
    /// Presses the emergency stop, or lets it go.
    EmergencyStop(bool),
    /// Turns a motor by hand, one turn a second; a positive turn pulls its tendon in.
    Turn {
        /// The motor.
        #[serde(with = "from_one")]
        motor: usize,
        /// Turns.
        turns: f64,
    },
    /// Hangs a weight on a load cell in the place of its tendon, or puts the tendon back.
    Hang {
        /// The load cell.
        #[serde(with = "from_one")]
        cell: usize,
        /// Its weight, N; none is the tendon.
        newtons: Option<f64>,
    },
}

impl Touch {
    /// The one of a line.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn parse(line: &str) -> Result<Self, String> {
        let touch: Self = serde_json::from_str(line).map_err(|error| error.to_string())?;
        let within = |what: &str, value: f64, [low, high]: [f64; 2]| {
            if (low..=high).contains(&value) {
                Ok(())
            } else {
                Err(format!("{what} is not within {low} to {high}"))
            }
        };
        match touch {
            Self::Payload { kg, over_s } => {
                within("kg", kg, [0.0, 1e3])?;
                within("over_s", over_s, [0.0, 1e3])?;
            }
            Self::Turn { turns, .. } => within("turns", turns, [-1e3, 1e3])?,
            Self::Hang { newtons, .. } => within("newtons", newtons.unwrap_or(0.0), [0.0, 1e4])?,
            Self::Fault(_) | Self::Repair(_) | Self::EmergencyStop(_) => {}
        }
        Ok(touch)
    }

    /// Does it.
    pub fn apply(&self, plant: &mut Plant) {
        match *self {
            Self::Payload { kg, over_s } => plant.set_payload(kg, over_s),
            Self::Fault(fault) => plant.set_fault(fault, true),
            Self::Repair(fault) => plant.set_fault(fault, false),
            Self::EmergencyStop(pressed) => plant.press_emergency_stop(pressed),
            Self::Turn { motor, turns } => plant.turn_motor(motor, turns),
            Self::Hang { cell, newtons } => plant.hang_on_cell(cell, newtons),
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::Touch;
    use crate::plant::Fault;

    #[test]
    fn a_line_is_one_thing() {
        let turn = Touch::parse(r#"{"turn":{"motor":2,"turns":-0.5}}"#).unwrap();
        let expected = Touch::Turn {
            motor: 1,
            turns: -0.5,
        };
        assert_eq!(turn, expected);
        let fault = Touch::parse(r#"{"fault":{"driver_fault":1}}"#).unwrap();
        assert_eq!(fault, Touch::Fault(Fault::DriverFault(0)));
    }

    #[test]
    fn what_would_do_nothing_or_something_else_is_refused() {
        for line in [
            r#"{"turn":{"motor":2}}"#,
            r#"{"turn":{"motor":0,"turns":1}}"#,
            r#"{"hang":{"cell":4,"newtons":1}}"#,
            r#"{"payload":{"kg":-5}}"#,
            r#"{"payload":{"kg":1,"over_s":-1}}"#,
            r#"{"payload":{"kg":1e308}}"#,
            r#"{"turn":{"motor":1,"turns":1e300}}"#,
            r#"{"hang":{"cell":1,"newtons":-1}}"#,
        ] {
            assert!(Touch::parse(line).is_err(), "{line}");
        }
    }
}
