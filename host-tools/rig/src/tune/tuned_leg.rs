//! The leg that is measured, as its host asks it.

use super::error::LegError;
use leg_firmware::command::Command;
use leg_firmware::jog::{JogDemand, JogReport};
use leg_firmware::telemetry::Telemetry;
use std::time::Duration;

/// A leg that does what it is asked, and says when that is done. A program that may wait is done at once; a page comes back later.
#[allow(async_fn_in_trait, reason = "nothing of it leaves its thread")]
pub trait TunedLeg {
    /// Why it did not do what it was asked.
    type Error: LegError;

    /// What it reports.
    async fn telemetry(&mut self) -> Result<Telemetry<f32>, Self::Error>;

    /// The same after an error, if there was one of the leg; none if it no longer answers.
    async fn telemetry_after(&mut self, error: Option<&Self::Error>) -> Option<Telemetry<f32>>;

    /// Turns a motor and waits until it is off again; what the board saw, and the leg after it, also where a fault ended it.
    async fn jog(
        &mut self,
        demand: &JogDemand,
    ) -> Result<(JogReport<f32>, Telemetry<f32>), Self::Error>;

    /// Finds the zero, and leaves it in hold, straight down.
    async fn home(&mut self) -> Result<(), Self::Error>;

    /// Leads it straight down with a pretension, N, and waits until it rests.
    async fn hang_straight(&mut self, pretension_n: f32) -> Result<(), Self::Error>;

    /// Commands an active leg, stops it on the way as soon as `passed` says so, and gives the telemetry from the command until a
    /// time after the stop. The leg is held then.
    async fn interrupt(
        &mut self,
        command: Command,
        passed: &mut dyn FnMut(&Telemetry<f32>) -> bool,
        time: Duration,
    ) -> Result<Vec<Telemetry<f32>>, Self::Error>;

    /// Stops it.
    async fn stop(&mut self) -> Result<(), Self::Error>;
}
