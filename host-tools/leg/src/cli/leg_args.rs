//! What the commands for one leg have in common: where it is, how they tell what came out.

use super::leg_told;
use super::line::{Fresh, Line, LineArgs, RigArgs, Use, shown};
use leg_base::failure::Failure;
use leg_firmware::telemetry::Telemetry;
use leg_host::operator::{Operator, OperatorError};

/// The leg, and how it is told of.
#[derive(Debug, clap::Args)]
pub(super) struct LegArgs {
    #[command(flatten)]
    line: LineArgs,
    #[command(flatten)]
    rig: RigArgs,
    /// Prints JSON instead of words.
    #[arg(long)]
    pub(super) json: bool,
}

impl LegArgs {
    /// Opens the line to the leg.
    pub(super) fn open(&self, fresh: Fresh, verbose: bool) -> Result<Line, Failure> {
        self.line.open(&self.rig.load()?, fresh, verbose)
    }

    /// Stops the leg beside whatever else goes on, and tells what it is doing then.
    pub(super) fn stop(&self, verbose: bool) -> Result<(), Failure> {
        let rig = self.rig.load()?;
        let mut line = self.line.open_for(Use::Stop, &rig, Fresh::Homed, verbose)?;
        shown(&mut line.operator, Operator::stop)?;
        leg_told::tell(&line.operator.telemetry()?.telemetry, self.json)
    }

    /// Lets the leg do something, shows it meanwhile, and gives the leg afterwards.
    pub(super) fn drive<T>(
        &self,
        fresh: Fresh,
        verbose: bool,
        work: impl FnOnce(&mut Operator) -> Result<T, OperatorError>,
    ) -> Result<Telemetry<f32>, Failure> {
        let mut line = self.open(fresh, verbose)?;
        shown(&mut line.operator, work)?;
        Ok(line.operator.telemetry()?.telemetry)
    }

    /// The same with a leg that is homed, and tells what it is doing then.
    pub(super) fn command<T>(
        &self,
        verbose: bool,
        work: impl FnOnce(&mut Operator) -> Result<T, OperatorError>,
    ) -> Result<(), Failure> {
        leg_told::tell(&self.drive(Fresh::Homed, verbose, work)?, self.json)
    }
}
