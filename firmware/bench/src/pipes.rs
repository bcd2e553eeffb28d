//! Names of the two pipes by which a host and the firmware under an emulator meet.
//!
//! The host makes both in the emulator's working directory. Both sides open [`TO_HOST`] first: opening a pipe waits
//! for the other side, and another order would wait for ever.

use core::ffi::CStr;

/// The pipe that the firmware writes and the host reads.
pub const TO_HOST: &CStr = c"to-host";

/// The pipe that the host writes and the firmware reads.
pub const TO_FIRMWARE: &CStr = c"to-firmware";
