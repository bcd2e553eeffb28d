//! What a leg's motors, gears and tendons are, measured by an operator that waits: `leg tune`. [`leg_rig::tune`] has how.

use crate::operator::{Goal, Operator, OperatorError, Tensioning};
use embassy_futures::block_on;
use leg_base::failure::Failure;
use leg_firmware::command::Command;
use leg_firmware::jog::{JogDemand, JogReport};
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use leg_rig::rig_file::RigFile;
use leg_rig::tune::{
    self, JogPlan, Jogged, LegError, MeasuredMotor, Swing, SwingPlan, Swings, TunedLeg,
};
use std::time::Duration;

/// Why a leg was not measured to the end. It rests then.
pub type OperatorTuneError = tune::TuneError<OperatorError>;

/// The voltage of the motors' supply, V.
///
/// # Errors
/// As [`Operator::sensors`].
pub fn supply_v(operator: &mut Operator, settings: &Settings) -> Result<f32, OperatorError> {
    Ok(f32::from(operator.sensors()?.codes.supply_code) * settings.board.supply_v_per_code)
}

/// Jogs a motor of a disarmed leg: [`leg_rig::tune::measure_motor`].
///
/// # Errors
/// As that.
pub fn measure_motor(
    operator: &mut Operator,
    plan: &JogPlan,
    settings: &Settings,
    seen: &mut dyn FnMut(&Jogged),
) -> Result<MeasuredMotor, OperatorTuneError> {
    block_on(tune::measure_motor(
        &mut OperatedLeg(operator),
        plan,
        settings,
        seen,
    ))
}

/// Homes the leg, and lets it swing by the plan: [`leg_rig::tune::measure_swing`].
///
/// # Errors
/// As that.
pub fn measure_swing(
    operator: &mut Operator,
    plan: &SwingPlan,
    rig: &RigFile,
    seen: &mut dyn FnMut(&Swing),
) -> Result<Swings, OperatorTuneError> {
    block_on(tune::measure_swing(
        &mut OperatedLeg(operator),
        plan,
        rig,
        seen,
    ))
}

/// A leg whose operator waits until it has done what it was asked.
struct OperatedLeg<'a>(&'a mut Operator);

impl TunedLeg for OperatedLeg<'_> {
    type Error = OperatorError;

    async fn telemetry(&mut self) -> Result<Telemetry<f32>, OperatorError> {
        Ok(self.0.telemetry()?.telemetry)
    }

    async fn telemetry_after(&mut self, error: Option<&OperatorError>) -> Option<Telemetry<f32>> {
        if let Some(OperatorError::ConnectionLost(..) | OperatorError::NoAnswer(_)) = error {
            return None;
        }
        let report = self.0.uncancelled(Operator::telemetry).ok()?;
        Some(report.telemetry)
    }

    async fn jog(
        &mut self,
        demand: &JogDemand,
    ) -> Result<(JogReport<f32>, Telemetry<f32>), OperatorError> {
        self.0.jog(demand)
    }

    async fn home(&mut self) -> Result<(), OperatorError> {
        self.0.home().map(drop)
    }

    async fn hang_straight(&mut self, pretension_n: f32) -> Result<(), OperatorError> {
        let goal = Goal {
            tensioning: Some(Tensioning::Pretension(pretension_n)),
            direction: Some([0.0; 2]),
        };
        self.0.reach(&goal).map(drop)
    }

    async fn interrupt(
        &mut self,
        command: Command,
        passed: &mut dyn FnMut(&Telemetry<f32>) -> bool,
        time: Duration,
    ) -> Result<Vec<Telemetry<f32>>, OperatorError> {
        self.0.interrupt(command, passed, time)
    }

    async fn stop(&mut self) -> Result<(), OperatorError> {
        self.0.stop().map(drop)
    }
}

impl LegError for OperatorError {
    fn faulted(asked: &'static str, telemetry: &Telemetry<f32>) -> Self {
        Self::Failed(asked, Box::new(*telemetry))
    }

    fn stopped(asked: &'static str, state: State) -> Self {
        Self::StoppedByOtherHost(asked, state)
    }

    fn failure(&self) -> Failure {
        self.failure()
    }
}
