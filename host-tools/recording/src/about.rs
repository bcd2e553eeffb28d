//! What a recording is of.

use serde::{Deserialize, Serialize};

/// What a recording is of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct About {
    /// In words: what a chart of it is called.
    pub title: String,
    /// Version of this program.
    pub version: String,
    /// The scenario's file or name; none for a log of a leg.
    pub scenario: Option<String>,
    /// The rig's file or name; none for a log of a leg.
    pub rig: Option<String>,
    /// What everything random in it follows from; none for a log of a leg.
    pub seed: Option<u64>,
    /// The time of the day that the time zero of a simulated leg is given, s since 1970; none where it is not known.
    pub begin_wall_time_s: Option<f64>,
}

impl About {
    /// Of a log of a leg.
    #[must_use]
    pub fn log(title: &str) -> Self {
        Self {
            title: title.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            scenario: None,
            rig: None,
            seed: None,
            begin_wall_time_s: None,
        }
    }
}
