//! What a fault leads to, and what ends it.

use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// What a fault leads to, from the mildest to the most severe.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, Schema)]
#[serde(rename_all = "snake_case")]
pub enum Reaction {
    /// The leg goes on with what is possible.
    Limit,
    /// The leg stays where it is, its motors at rest on their screws.
    Hold,
    /// The tendons are paid out until they are slack, then the drivers are switched off.
    RampDown,
    /// The drivers are switched off at once; the screws hold.
    GateOff,
}

/// What ends a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clearing {
    /// The end of its cause.
    CauseGone,
    /// A clear command after the end of its cause.
    Command,
}
