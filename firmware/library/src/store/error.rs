//! What a store finds, and why it fails.

use crate::settings::{Settings, SettingsError};
use core::fmt::{Debug, Display, Formatter, Result};

/// What was stored.
#[derive(Clone, Debug, PartialEq)]
#[allow(
    clippy::large_enum_variant,
    reason = "settings are kept in place: there is no allocation on the board"
)]
pub enum Loaded {
    /// The newest settings that are whole.
    Settings(Settings),
    /// Nothing: the flash is blank, or the settings were cleared.
    Empty,
    /// Something that cannot be used; to save again replaces it.
    Corrupt(CorruptReason),
}

/// Why what was stored cannot be used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CorruptReason {
    /// The record's CRC belongs to other bytes.
    Crc,
    /// The record holds settings of another shape: another firmware wrote it.
    OtherSchema {
        /// Its schema.
        found: [u8; 8],
    },
    /// The record has the right schema, but does not hold exactly one `Settings`.
    NotSettings,
    /// The settings are whole, but [`Settings::check`] refuses them.
    Refused(SettingsError),
    /// The flash is not blank, and no whole record is found in it: the only one is damaged, the first save was
    /// interrupted, or something else wrote there.
    Storage,
}

impl Display for CorruptReason {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Crc => f.write_str("the record's CRC belongs to other bytes"),
            Self::OtherSchema { .. } => f.write_str("another firmware's settings are stored"),
            Self::NotSettings => f.write_str("the record does not hold settings"),
            Self::Refused(error) => write!(f, "the settings stored are refused: {error}"),
            Self::Storage => f.write_str("the flash holds no whole record and is not blank"),
        }
    }
}

impl core::error::Error for CorruptReason {}

/// Why a store fails.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StoreError<E> {
    /// The range is not at least three whole pages inside the flash.
    Region,
    /// The settings are refused; nothing was written.
    Settings(SettingsError),
    /// The flash itself.
    Flash(E),
    /// What is in the flash leaves no way to store a record; [`Store::clear`](super::Store::clear) makes one.
    Storage,
}

impl<E> From<sequential_storage::Error<E>> for StoreError<E> {
    fn from(error: sequential_storage::Error<E>) -> Self {
        match error {
            sequential_storage::Error::Storage { value, .. } => Self::Flash(value),
            _ => Self::Storage,
        }
    }
}

impl<E: Debug> Display for StoreError<E> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Region => {
                f.write_str("the region is not at least three whole pages inside the flash")
            }
            Self::Settings(error) => Display::fmt(error, f),
            Self::Flash(error) => write!(f, "the flash failed: {error:?}"),
            Self::Storage => f.write_str("what is in the flash leaves no way to store a record"),
        }
    }
}

impl<E: Debug> core::error::Error for StoreError<E> {}
