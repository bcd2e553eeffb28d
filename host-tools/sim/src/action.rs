//! What can be done to a simulated leg from outside: a step of a scenario, or a line of JSON for `leg emulate`, such as
//! `{"payload":{"kg":2}}`.

use crate::plant::defect::from_one;
use crate::plant::{Defect, Plant};
use crate::range;
use serde::Deserialize;
use strum::VariantNames;

/// Time in which the force of a push rises, s.
const PUSH_RISE_S: f64 = 0.02;

/// One action. Motors and load cells are counted from 0 here, and from 1 in files and lines.
#[derive(Clone, Debug, PartialEq, Deserialize, VariantNames)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[strum(serialize_all = "snake_case")]
pub enum Action {
    /// Changes the payload, at once or over a time.
    Payload {
        /// kg.
        #[serde(deserialize_with = "range::kg")]
        kg: f64,
        /// s.
        #[serde(default, deserialize_with = "range::over_s")]
        over_s: f64,
    },
    /// Pushes at the tip, as horizontally as is possible across the leg.
    Push {
        /// Degrees.
        #[serde(deserialize_with = "range::azimuth_deg")]
        azimuth_deg: f64,
        /// N.
        #[serde(deserialize_with = "range::force_n")]
        force_n: f64,
        /// s.
        #[serde(deserialize_with = "range::for_s")]
        for_s: f64,
    },
    /// Lets a defect begin.
    Fault(Defect),
    /// Ends it.
    Repair(Defect),
    /// Presses or releases the emergency stop.
    EmergencyStop(bool),
    /// Turns a motor by hand, one turn a second; a positive turn reels its tendon in.
    Turn {
        /// The motor.
        #[serde(with = "from_one")]
        motor: usize,
        /// Turns.
        #[serde(deserialize_with = "range::turns")]
        turns: f64,
    },
    /// Hangs a weight on a load cell in the place of its tendon, or puts the tendon back.
    Hang {
        /// The load cell.
        #[serde(with = "from_one")]
        cell: usize,
        /// Its weight, N; none is the tendon.
        #[serde(default, deserialize_with = "range::newtons")]
        newtons: Option<f64>,
    },
}

impl Action {
    /// The action of a line of JSON.
    ///
    /// # Errors
    /// What is wrong with it, as a sentence.
    pub fn parse(line: &str) -> Result<Self, String> {
        serde_json::from_str(line).map_err(|error| error.to_string())
    }

    /// Does it.
    pub fn apply(&self, plant: &mut Plant) {
        match *self {
            Self::Payload { kg, over_s } => plant.set_payload(kg, over_s),
            Self::Push {
                azimuth_deg,
                force_n,
                for_s,
            } => plant.push(plant.transverse(azimuth_deg) * force_n, for_s, PUSH_RISE_S),
            Self::Fault(defect) => plant.set_defect(defect, true),
            Self::Repair(defect) => plant.set_defect(defect, false),
            Self::EmergencyStop(pressed) => plant.press_emergency_stop(pressed),
            Self::Turn { motor, turns } => plant.turn_motor(motor, turns),
            Self::Hang { cell, newtons } => plant.hang_on_cell(cell, newtons),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Action;
    use crate::plant::Defect;

    #[test]
    fn a_line_is_one_action() {
        for (line, expected) in [
            (
                r#"{"turn":{"motor":2,"turns":-0.5}}"#,
                Action::Turn {
                    motor: 1,
                    turns: -0.5,
                },
            ),
            (
                r#"{"fault":{"driver_fault":1}}"#,
                Action::Fault(Defect::DriverFault(0)),
            ),
            (
                r#"{"push":{"azimuth_deg":90,"force_n":2,"for_s":0.5}}"#,
                Action::Push {
                    azimuth_deg: 90.0,
                    force_n: 2.0,
                    for_s: 0.5,
                },
            ),
        ] {
            assert_eq!(Action::parse(line), Ok(expected));
        }
    }

    #[test]
    fn a_line_that_is_no_action_is_refused() {
        for (line, part) in [
            (r#"{"turn":{"motor":2}}"#, "missing field `turns`"),
            (
                r#"{"turn":{"motor":0,"turns":1}}"#,
                "0 is none of 1, 2 and 3",
            ),
            (
                r#"{"hang":{"cell":4,"newtons":1}}"#,
                "4 is none of 1, 2 and 3",
            ),
            (r#"{"payload":{"kg":-5}}"#, "kg = -5 is not from 0 to 50"),
            (r#"{"payload":{"kg":1,"over_s":-1}}"#, "over_s = -1 is not"),
            (r#"{"payload":{"kg":1e308}}"#, "is not from 0 to 50"),
            (r#"{"turn":{"motor":1,"turns":1e300}}"#, "is not from -1000"),
            (r#"{"hang":{"cell":1,"newtons":-1}}"#, "newtons = -1 is not"),
            (r#"{"arm":{}}"#, "unknown variant `arm`"),
        ] {
            let refusal = Action::parse(line).err().unwrap_or_default();
            assert!(refusal.contains(part), "{line}: {refusal}");
        }
    }
}
