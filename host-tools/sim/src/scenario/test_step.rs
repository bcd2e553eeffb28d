//! The steps of a scenario that wait and measure, and those that act on the host's line.

use super::{CircleStep, FollowStep, Measurand};
use crate::range;
use leg_firmware::supervisor::{Fault, State};
use serde::{Deserialize, Deserializer, de::Error};
use strum::VariantNames;

/// Something that is awaited or measured, or done to the host's line.
#[derive(Clone, Debug, PartialEq, Deserialize, VariantNames)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[strum(serialize_all = "snake_case")]
pub enum TestStep {
    /// Sends so many random bytes to the leg.
    Garbage(#[serde(deserialize_with = "range::garbage")] u32),
    /// Stops the host's keep-alives, or lets them go on.
    Silence(bool),
    /// Waits, s.
    WaitS(#[serde(deserialize_with = "range::wait_s")] f64),
    /// Waits for a state.
    Await {
        /// The state.
        state: State,
        /// s.
        #[serde(deserialize_with = "range::timeout_s")]
        timeout_s: f64,
    },
    /// Waits until a move is done, and a time more.
    Arrive {
        /// s.
        #[serde(deserialize_with = "range::then_s")]
        then_s: f64,
        /// s.
        #[serde(deserialize_with = "range::timeout_s")]
        timeout_s: f64,
    },
    /// Moves the leg to the start of a path, streams the path, and waits until the leg is at rest.
    Follow(FollowStep),
    /// The same with a circle.
    Circle(CircleStep),
    /// Starts the extremes anew.
    Mark,
    /// Waits for a fault and the state that it leads to, and measures the time since the last action or command.
    Reaction {
        /// The fault.
        fault: Fault,
        /// The state.
        state: State,
        /// ms.
        #[serde(deserialize_with = "range::within_ms")]
        within_ms: f64,
    },
    /// Measures.
    Measure {
        /// What it is called in the table.
        #[serde(deserialize_with = "range::name")]
        name: String,
        /// What.
        quantity: Measurand,
        /// Lowest and highest value.
        #[serde(deserialize_with = "ordered")]
        between: [f64; 2],
    },
    /// Pushes at the tip and measures the stiffness against the push.
    PushTest(PushTest),
}

/// A push that measures the leg's bending stiffness.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PushTest {
    /// What it is called in the table.
    #[serde(deserialize_with = "range::name")]
    pub name: String,
    /// Azimuth of the push, degrees.
    #[serde(deserialize_with = "range::azimuth_deg")]
    pub azimuth_deg: f64,
    /// N.
    #[serde(deserialize_with = "range::test_force_n")]
    pub force_n: f64,
    /// Time until the leg rests, s.
    #[serde(deserialize_with = "range::settle_s")]
    pub settle_s: f64,
    /// The stiffness that is expected, N·m/rad.
    #[serde(deserialize_with = "range::stiffness_nm_per_rad")]
    pub nm_per_rad: f64,
    /// How far from that it may be, percent.
    #[serde(deserialize_with = "range::within_percent")]
    pub within_percent: f64,
}

/// A lower and a higher number.
fn ordered<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 2], D::Error> {
    let [low, high]: [f64; 2] = range::between(deserializer)?;
    if low > high {
        let sentence = format!("between = [{low}, {high}] ends below its start");
        return Err(D::Error::custom(sentence));
    }
    Ok([low, high])
}
