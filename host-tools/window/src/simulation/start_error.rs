//! Why a simulated leg does not start.

use leg_base::failure::Failure;
use leg_sim::emulated_leg::EmulationError;

/// Why there is no leg.
#[derive(Debug)]
pub enum StartError {
    /// The rig is refused.
    Rig(Failure),
    /// The simulation is.
    Emulation(EmulationError),
}

impl std::fmt::Display for StartError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Rig(failure) => f.write_str(&failure.render(false)),
            Self::Emulation(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for StartError {}
