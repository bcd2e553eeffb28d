//! What can fail.

use serde::{Deserialize, Serialize};
use std::fmt;

/// One fault. A tendon, cell, encoder or motor is counted from 0 here, and from 1 in files and words, as everywhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Fault {
    /// A tendon does not pull.
    TendonCut(#[serde(with = "from_one")] usize),
    /// A load cell shows what it showed, as if it were new.
    CellStuck(#[serde(with = "from_one")] usize),
    /// A load cell shows its highest code.
    CellSaturated(#[serde(with = "from_one")] usize),
    /// A load cell shows its lowest code.
    CellDead(#[serde(with = "from_one")] usize),
    /// A load cell converts no more: its last code stays, and is not fresh.
    CellStale(#[serde(with = "from_one")] usize),
    /// A load cell's offset grows by 5 N in a second, and stays when the fault ends.
    CellDrifting(#[serde(with = "from_one")] usize),
    /// An encoder's counter stands still.
    EncoderLost(#[serde(with = "from_one")] usize),
    /// An encoder loses every tenth count.
    EncoderSlipping(#[serde(with = "from_one")] usize),
    /// An encoder counts the wrong way.
    EncoderReversed(#[serde(with = "from_one")] usize),
    /// A motor does not turn.
    MotorJammed(#[serde(with = "from_one")] usize),
    /// A motor's current shows 10 A too much.
    CurrentOffset(#[serde(with = "from_one")] usize),
    /// A driver reports a fault and switches its motor off.
    DriverFault(#[serde(with = "from_one")] usize),
    /// The supply falls to 11 V.
    SupplySag,
    /// The supply rises to 32 V.
    SupplySurge,
    /// The drivers heat up by 20 K in a second.
    Overheating,
    /// Every tick ends too late.
    LateTicks,
    /// The board's stored settings are not whole.
    SettingsCorrupt,
}

/// Kinds of faults that strike one of three.
const KINDS: [fn(usize) -> Fault; 12] = [
    Fault::TendonCut,
    Fault::CellStuck,
    Fault::CellSaturated,
    Fault::CellDead,
    Fault::CellStale,
    Fault::CellDrifting,
    Fault::EncoderLost,
    Fault::EncoderSlipping,
    Fault::EncoderReversed,
    Fault::MotorJammed,
    Fault::CurrentOffset,
    Fault::DriverFault,
];

impl Fault {
    /// Every fault.
    pub fn all() -> impl Iterator<Item = Self> {
        let of_three = KINDS.into_iter().flat_map(|kind| (0..3).map(kind));
        of_three.chain([
            Self::SupplySag,
            Self::SupplySurge,
            Self::Overheating,
            Self::LateTicks,
            Self::SettingsCorrupt,
        ])
    }

    /// A bit of its own; none for one of more than three.
    fn bit(self) -> u64 {
        let (kind, which) = match self {
            Self::TendonCut(i) => (0, i),
            Self::CellStuck(i) => (1, i),
            Self::CellSaturated(i) => (2, i),
            Self::CellStale(i) => (3, i),
            Self::CellDrifting(i) => (4, i),
            Self::EncoderLost(i) => (5, i),
            Self::EncoderSlipping(i) => (6, i),
            Self::EncoderReversed(i) => (7, i),
            Self::MotorJammed(i) => (8, i),
            Self::CurrentOffset(i) => (9, i),
            Self::DriverFault(i) => (10, i),
            Self::SupplySag => (11, 0),
            Self::SupplySurge => (11, 1),
            Self::Overheating => (11, 2),
            Self::CellDead(i) => (13, i),
            Self::LateTicks => (12, 0),
            Self::SettingsCorrupt => (12, 1),
        };
        if which < 3 {
            1 << (3 * kind + which)
        } else {
            0
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::TendonCut(i) => write!(f, "tendon {} is cut", i + 1),
            Self::CellStuck(i) => write!(f, "load cell {} is stuck", i + 1),
            Self::CellSaturated(i) => write!(f, "load cell {} shows its highest value", i + 1),
            Self::CellDead(i) => write!(f, "load cell {} shows its lowest value", i + 1),
            Self::CellStale(i) => write!(f, "load cell {} converts no more", i + 1),
            Self::CellDrifting(i) => write!(f, "load cell {} drifts by 5 N/s", i + 1),
            Self::EncoderLost(i) => write!(f, "encoder {} stands still", i + 1),
            Self::EncoderSlipping(i) => write!(f, "encoder {} loses every tenth count", i + 1),
            Self::EncoderReversed(i) => write!(f, "encoder {} counts the wrong way", i + 1),
            Self::MotorJammed(i) => write!(f, "motor {} is jammed", i + 1),
            Self::CurrentOffset(i) => {
                write!(f, "the current of motor {} shows 10 A too much", i + 1)
            }
            Self::DriverFault(i) => write!(f, "driver {} reports a fault", i + 1),
            Self::SupplySag => write!(f, "the supply falls to 11 V"),
            Self::Overheating => write!(f, "the drivers heat up by 20 K/s"),
            Self::SupplySurge => write!(f, "the supply rises to 32 V"),
            Self::LateTicks => write!(f, "every tick ends too late"),
            Self::SettingsCorrupt => write!(f, "the stored settings are not whole"),
        }
    }
}

/// The faults that there are at a time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Faults(u64);

impl Faults {
    pub fn set(&mut self, fault: Fault, on: bool) {
        self.0 = (self.0 & !fault.bit()) | if on { fault.bit() } else { 0 };
    }

    pub fn has(self, fault: Fault) -> bool {
        self.0 & fault.bit() != 0
    }

    /// Which of three a kind of fault strikes.
    pub fn of_three(self, kind: fn(usize) -> Fault) -> [bool; 3] {
        std::array::from_fn(|i| self.has(kind(i)))
    }
}

/// A number from 1 to 3 in a file, from 0 to 2 here.
pub(crate) mod from_one {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    #[allow(clippy::trivially_copy_pass_by_ref, reason = "serde asks for it")]
    pub fn serialize<S: Serializer>(index: &usize, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u64(*index as u64 + 1)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<usize, D::Error> {
        match usize::deserialize(deserializer)? {
            number @ 1..=3 => Ok(number - 1),
            number => Err(D::Error::custom(format!("{number} is none of 1, 2 and 3"))),
        }
    }
}
