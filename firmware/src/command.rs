//! What a host commands the leg to do.

use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// Which load the tendons are made to hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
#[serde(rename_all = "snake_case")]
pub enum Compensation {
    /// None: the leg sags under its own weight and its payload, as without a controller that knows of them.
    Off,
    /// The one that the tensions tell: the loaded tip comes to its target.
    Estimated,
    /// The one that was told last: the leg answers a push with its stiffness, and does not take it for a load.
    Frozen,
}

/// A command. The leg answers the next one only when this one is done or refused; both are told by the state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub enum Command {
    /// Nothing but that the host is there.
    KeepAlive,
    /// Follows commands from now on, from the present pose.
    Arm,
    /// Looks for the zero, then tensions the leg straight down.
    Home,
    /// Goes to a direction, given by its horizontal components.
    Move {
        /// p_x = sin θ cos φ.
        x: f32,
        /// p_y = sin θ sin φ.
        y: f32,
    },
    /// Comes to rest on the way, and goes on following commands.
    Hold,
    /// Sets the level of pretension, N.
    Level(f32),
    /// Demands a bending stiffness, N·m/rad: the smallest, or that against a push towards (cos, sin).
    Stiffness {
        /// N·m/rad.
        demand_nm_per_rad: f32,
        /// Direction of the push; none for the smallest.
        towards: Option<[f32; 2]>,
    },
    /// Chooses the load that is held.
    Compensation(Compensation),
    /// Stays where it is until a clear, whatever else is going on.
    Stop,
    /// Relaxes the tendons and switches the drivers off.
    Disarm,
    /// Clears the faults whose cause is gone.
    Clear,
}
