//! What the leg is doing when it is struck.

use clap::ValueEnum;
use serde::Serialize;

/// What the leg is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
#[value(rename_all = "snake_case")]
pub enum Activity {
    /// At rest after a move, still following commands.
    Following,
    /// Stopped by the user.
    Held,
    /// On the way to another pose.
    Moving,
    /// Searching for its zero.
    Homing,
    /// Relaxing its tendons on command.
    RampingDown,
    /// Relaxed, its drivers off.
    Disarmed,
    /// Just armed where its screws held it.
    Arming,
    /// At rest and following; the user clears the fault and arms again, twice.
    Rearmed,
}

impl Activity {
    /// That of the case of a number: all in turn.
    #[must_use]
    pub fn nth(number: u64) -> Self {
        let all = Self::value_variants();
        all[(number % all.len() as u64) as usize]
    }

    /// How many there are.
    #[must_use]
    pub fn count() -> u64 {
        Self::value_variants().len() as u64
    }

    /// Its name, as options and reports have it.
    #[must_use]
    pub fn name(self) -> String {
        let value = self.to_possible_value();
        value.map_or_else(String::new, |value| value.get_name().into())
    }

    /// Whether the leg is on a way, and not at rest.
    #[must_use]
    pub const fn is_on_the_way(self) -> bool {
        matches!(
            self,
            Self::Moving | Self::Homing | Self::RampingDown | Self::Arming
        )
    }
}
