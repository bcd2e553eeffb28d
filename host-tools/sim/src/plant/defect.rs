//! Defects of the simulated leg: what can fail.

use serde::{Deserialize, Serialize};

/// One defect. A tendon, cell, encoder or motor is counted from 0 here, and from 1 in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Defect {
    /// A tendon does not pull.
    TendonCut(#[serde(with = "from_one")] usize),
    /// A load cell repeats its last code and marks it as fresh.
    CellStuck(#[serde(with = "from_one")] usize),
    /// A load cell gives its highest code.
    CellSaturated(#[serde(with = "from_one")] usize),
    /// A load cell gives its lowest code.
    CellDead(#[serde(with = "from_one")] usize),
    /// A load cell converts no more: its last code stays, and is not fresh.
    CellStale(#[serde(with = "from_one")] usize),
    /// A load cell's offset grows by 5 N in a second, and stays when the defect ends.
    CellDrifting(#[serde(with = "from_one")] usize),
    /// An encoder's counter stands still.
    EncoderLost(#[serde(with = "from_one")] usize),
    /// An encoder loses every tenth count.
    EncoderSlipping(#[serde(with = "from_one")] usize),
    /// An encoder counts in the wrong direction.
    EncoderReversed(#[serde(with = "from_one")] usize),
    /// A motor does not turn.
    MotorJammed(#[serde(with = "from_one")] usize),
    /// A motor's current reads 10 A too high.
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
    /// The board's stored settings fail their check.
    SettingsCorrupt,
}

/// Kinds of defects that each of the three tendons can have.
const KINDS: [fn(usize) -> Defect; 12] = [
    Defect::TendonCut,
    Defect::CellStuck,
    Defect::CellSaturated,
    Defect::CellDead,
    Defect::CellStale,
    Defect::CellDrifting,
    Defect::EncoderLost,
    Defect::EncoderSlipping,
    Defect::EncoderReversed,
    Defect::MotorJammed,
    Defect::CurrentOffset,
    Defect::DriverFault,
];

impl Defect {
    /// Every defect.
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
}

/// The defects at a time.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Defects(Vec<Defect>);

impl Defects {
    pub fn set(&mut self, defect: Defect, on: bool) {
        self.0.retain(|other| *other != defect);
        if on {
            self.0.push(defect);
        }
    }

    pub fn has(&self, defect: Defect) -> bool {
        self.0.contains(&defect)
    }

    /// Which of the three have a kind of defect.
    pub fn of_three(&self, kind: fn(usize) -> Defect) -> [bool; 3] {
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
