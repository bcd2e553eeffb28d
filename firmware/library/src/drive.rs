//! What a tick asks of the motors.

use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// The motors' drivers until the next tick.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct Drive<T> {
    /// Part of the supply at each motor, −1 to 1; positive pulls the tendon in.
    pub duty: [T; 3],
    /// Whether the drivers' outputs are on. Off, the motors are open and the screws hold.
    pub enabled: bool,
}
