//! A leg without a board: the simulated mechanism, scenarios, and the firmware in this process.

pub mod emulated_leg;
pub mod link;
pub mod plant;
pub mod ready_scenarios;
pub mod scenario;
pub mod simulation;
pub mod touch;
