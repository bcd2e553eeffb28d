//! A record: schema, settings in postcard's format, CRC-32 (ISO-HDLC, little-endian) of all before it.

use super::error::CorruptReason;
use super::max_size::max_size;
use crate::settings::Settings;
use crc::{CRC_32_ISO_HDLC, Crc};
use postcard_schema::{Schema, key::Key};
use sequential_storage::map::{SerializationError, Value};

/// Hash of the type [`Settings`] alone: other messages may change without the settings being lost. A record of another layout
/// needs another path, and so has another hash.
pub const SETTINGS_SCHEMA: [u8; 8] = Key::for_path::<Settings>("settings").to_bytes();

/// Most that settings take in postcard's format, bytes: three tendons with full curves.
pub const SETTINGS_MAX: usize = max_size(Settings::SCHEMA);

const HEAD: usize = SETTINGS_SCHEMA.len();
const CHECKSUM: usize = size_of::<u32>();

/// Longest record, bytes.
pub const RECORD_MAX: usize = HEAD + SETTINGS_MAX + CHECKSUM;

const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// Settings that are written as a record.
pub struct Packed<'a>(pub &'a Settings);

impl<'a> Value<'a> for Packed<'_> {
    fn serialize_into(&self, buffer: &mut [u8]) -> Result<usize, SerializationError> {
        pack(self.0, buffer).ok_or(SerializationError::BufferTooSmall)
    }

    /// A record is fetched as bytes, so that [`unpack`] can report what is wrong with it.
    fn deserialize_from(_: &'a [u8]) -> Result<(Self, usize), SerializationError> {
        Err(SerializationError::InvalidFormat)
    }
}

/// Writes a record and returns its length; `None` if there is no room for it.
pub fn pack(settings: &Settings, out: &mut [u8]) -> Option<usize> {
    let (schema, rest) = out.split_first_chunk_mut::<HEAD>()?;
    schema.copy_from_slice(&SETTINGS_SCHEMA);
    let checked = HEAD + postcard::to_slice(settings, rest).ok()?.len();
    let (checked_bytes, rest) = out.split_at_mut_checked(checked)?;
    let checksum = CRC.checksum(checked_bytes).to_le_bytes();
    rest.first_chunk_mut::<CHECKSUM>()?
        .copy_from_slice(&checksum);
    Some(checked + CHECKSUM)
}

/// The settings in a record.
pub fn unpack(record: &[u8]) -> Result<Settings, CorruptReason> {
    let (checked, checksum) = record.split_last_chunk().ok_or(CorruptReason::Crc)?;
    if CRC.checksum(checked) != u32::from_le_bytes(*checksum) {
        return Err(CorruptReason::Crc);
    }
    let (&schema, data) = checked
        .split_first_chunk()
        .ok_or(CorruptReason::NotSettings)?;
    if schema != SETTINGS_SCHEMA {
        return Err(CorruptReason::OtherSchema { found: schema });
    }
    match postcard::take_from_bytes::<Settings>(data) {
        Ok((settings, [])) => settings
            .check()
            .map(|()| settings)
            .map_err(CorruptReason::Refused),
        Ok(_) | Err(_) => Err(CorruptReason::NotSettings),
    }
}
