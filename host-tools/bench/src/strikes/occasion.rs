//! What the leg is doing when it is struck.

use serde::Serialize;

/// What the leg is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Occasion {
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

impl Occasion {
    /// All, with their names.
    pub const ALL: [(Self, &'static str); 8] = [
        (Self::Following, "following"),
        (Self::Held, "held"),
        (Self::Moving, "moving"),
        (Self::Homing, "homing"),
        (Self::RampingDown, "ramping_down"),
        (Self::Disarmed, "disarmed"),
        (Self::Arming, "arming"),
        (Self::Rearmed, "rearmed"),
    ];

    /// That of the case of a number.
    #[must_use]
    pub const fn of_case(number: u64) -> Self {
        Self::ALL[(number % Self::ALL.len() as u64) as usize].0
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        let mut all = Self::ALL.iter();
        all.find(|(occasion, _)| *occasion == self)
            .map_or("", |(_, name)| name)
    }

    /// Whether the leg is on a way, and not at rest.
    #[must_use]
    pub const fn on_the_way(self) -> bool {
        matches!(self, Self::Moving | Self::Homing | Self::RampingDown)
    }
}
