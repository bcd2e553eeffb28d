//! Who has checked in with the watchdog since its last round.

use leg_firmware::board::CheckIns;

/// Filled by the control interrupt and the tasks, emptied by the watchdog.
pub static CHECK_INS: CheckIns = CheckIns::new();
