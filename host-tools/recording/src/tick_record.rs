//! One tick as it is recorded: all that a controller gets, and the bits of what it gives.

use crate::WriteError;
use leg_firmware::drive::Drive;
use leg_firmware::linked_leg::LINK_BYTES_MAX;
use leg_firmware::sensors::Sensors;
use leg_sim::simulation::Tick;
use serde::{Deserialize, Serialize};

/// Longest message, bytes.
const BYTES_MAX: usize = 2048;

/// A tick.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct TickRecord {
    pub sensors: Sensors,
    pub link: heapless::Vec<u8, LINK_BYTES_MAX>,
    pub duty_bits: [u32; 3],
    pub enabled: bool,
}

impl TickRecord {
    pub fn new(tick: &Tick<'_>) -> Result<Self, WriteError> {
        let link = heapless::Vec::from_slice(tick.link);
        let link = link.map_err(|_| WriteError::message("too many bytes from the link"))?;
        let (duty_bits, enabled) = bits(tick.drive);
        Ok(Self {
            sensors: *tick.sensors,
            link,
            duty_bits,
            enabled,
        })
    }
}

/// The bits of what a controller gives.
pub(crate) fn bits(drive: &Drive<f32>) -> ([u32; 3], bool) {
    (drive.duty.map(f32::to_bits), drive.enabled)
}

/// A message in postcard's format.
pub(crate) fn to_bytes<T: Serialize>(message: &T) -> Result<Vec<u8>, WriteError> {
    let mut buffer = [0; BYTES_MAX];
    let bytes = postcard::to_slice(message, &mut buffer).map_err(WriteError::message)?;
    Ok(bytes.to_vec())
}
