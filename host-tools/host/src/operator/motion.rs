//! Homing and moving the leg, and leaving it to itself or in hold.

use super::command::name;
use super::telemetry::POLL_TIME;
use super::{Goal, Operator, OperatorError};
use leg_base::longest_times::{USUAL_HOMING, USUAL_MOVE, longest_homing, longest_move};
use leg_base::settling::{Settling, same_direction};
use leg_firmware::command::{Command, CommandRefusal, Compensation};
use leg_firmware::host_link::HostRefusal;
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use std::time::Duration;

/// How long a leg that another host has relax, or that starts, may stand still before it is waited for no longer.
const FOREIGN_STILL_TIME: Duration = Duration::from_secs(60);

/// Whoever left the load out may not be there any more. It comes before the leg is active: one that begins with its load left out goes to where it would
/// be without.
const COMPENSATED: Command = Command::Compensation(Compensation::Estimated);

/// How long something is waited for: usually, and at the most by the settings of the leg.
type Longest = (Duration, fn(&Settings) -> Duration);

const HOMING: Longest = (USUAL_HOMING, longest_homing);
pub(super) const MOVE: Longest = (USUAL_MOVE, longest_move);

impl Operator {
    /// Does `work` with keep-alives, and leaves the leg in hold however that ends. A leg that obeyed nothing
    /// of it is left as it was, and so is one that another host has disarmed or drives since: a stop would end what that one does.
    ///
    /// # Errors
    /// [`OperatorError::CommandTimeTooShort`] before any work. [`OperatorError::ConnectionLost`] by the work;
    /// else [`OperatorError::NotStopped`] if no stop is acknowledged; else the error of the work.
    pub fn drive<T>(
        &mut self,
        work: impl FnOnce(&mut Self) -> Result<T, OperatorError>,
    ) -> Result<T, OperatorError> {
        self.learn_command_time()?;
        self.keeps_alive = true;
        let result = work(self);
        self.keeps_alive = false;
        if result.as_ref().is_err_and(is_overtaken) {
            self.drives = false;
        }
        let halted = if self.drives { self.halt() } else { Ok(()) };
        match (result, halted) {
            // Without a line there can be no stop, and its error says what the leg does then.
            (Err(error @ OperatorError::ConnectionLost(..)), _) => Err(error),
            // Worse than whatever went before: it is not known whether the leg rests.
            (_, Err(not_stopped)) => Err(not_stopped),
            (result, Ok(())) => result,
        }
    }

    /// The same, but where the work succeeds the leg is left to itself: it keeps station where its settings allow that.
    pub(super) fn drive_to_station<T>(
        &mut self,
        work: impl FnOnce(&mut Self) -> Result<T, OperatorError>,
    ) -> Result<T, OperatorError> {
        self.drive(|operator| {
            let result = work(operator)?;
            operator.command(Command::KeepStation)?;
            operator.drives = false;
            Ok(result)
        })
    }

    /// Finds the zero and leaves the leg in hold, straight down. A leg in hold is disarmed first.
    ///
    /// # Errors
    /// As [`Self::drive`] and [`Self::command`]; [`OperatorError::Failed`] if a fault ends it.
    pub fn home(&mut self) -> Result<Telemetry<f32>, OperatorError> {
        let asked = "home";
        self.settle_state(asked)?;
        let state = self.telemetry()?.telemetry.state;
        if matches!(state, State::Held | State::KeepingStation) {
            self.disarm()?;
        }
        self.drive(|operator| {
            operator.command(Command::Home)?;
            operator.poll_followed(asked, &HOMING, |telemetry| telemetry.state == State::Active)?;
            operator.settle(asked)
        })
    }

    /// Leads the leg to the goal, waits until it has come to rest there, and leaves it to itself; in hold where it shall only come to
    /// rest. Arms it if it is homed and disarmed, ends a hold that no fault began.
    ///
    /// # Errors
    /// As [`Self::drive`] and [`Self::command`]; [`OperatorError::Failed`], [`OperatorError::Limited`],
    /// [`OperatorError::StoppedByOtherHost`] or [`OperatorError::TimedOut`] on the way; [`OperatorError::OtherPose`] at
    /// the end of a move.
    pub fn reach(&mut self, goal: &Goal) -> Result<Telemetry<f32>, OperatorError> {
        let commands = goal.commands();
        let asked = match commands.last() {
            None | Some(Command::Hold) => "hold",
            Some(command) => name(command),
        };
        self.settle_state(asked)?;
        let holds = *goal == Goal::default();
        if holds && self.telemetry()?.telemetry.state == State::KeepingStation {
            // At once, also in the middle of a correction.
            return self.stop();
        }
        let lead = |operator: &mut Self| {
            operator.activate(asked)?;
            for command in commands {
                operator.command(command)?;
            }
            let telemetry = operator.settle(asked)?;
            unlimited(asked, &telemetry)?;
            match &goal.direction {
                // A board may give up a path that it cannot plan.
                Some(direction) if !same_direction(&telemetry.target, direction) => {
                    Err(OperatorError::OtherPose(telemetry.pose))
                }
                _ => Ok(telemetry),
            }
        };
        if holds {
            self.drive(lead)
        } else {
            self.drive_to_station(lead)
        }
    }

    /// Waits while the leg starts or relaxes; refuses a leg with a fault.
    pub(super) fn settle_state(&mut self, asked: &'static str) -> Result<(), OperatorError> {
        let telemetry =
            self.wait_while_moving("come to rest", FOREIGN_STILL_TIME, |telemetry| {
                !matches!(telemetry.state, State::Boot | State::RampingDown)
            })?;
        let faults = telemetry.faults.stopping();
        if faults.any() {
            return Err(OperatorError::Faulted(asked, faults));
        }
        Ok(())
    }

    /// Makes a leg without faults follow commands, its tendons taut.
    pub(super) fn activate(&mut self, asked: &'static str) -> Result<(), OperatorError> {
        let telemetry = self.telemetry()?.telemetry;
        let refuse = |refusal| Err(OperatorError::Refused(asked, HostRefusal::Command(refusal)));
        match telemetry.state {
            state @ (State::Homing | State::Jogging) => {
                return refuse(CommandRefusal::State(state));
            }
            _ if !telemetry.homed => return refuse(CommandRefusal::NotHomed),
            State::KeepingStation => self.command(Command::Arm)?,
            State::Disarmed => {
                self.command(COMPENSATED)?;
                self.command(Command::Arm)?;
            }
            State::Held | State::Off => {
                self.command(COMPENSATED)?;
                self.command(Command::Clear)?;
            }
            // Another host's, or not yet ended by its silence: the commands that follow show it.
            State::Active | State::Boot | State::RampingDown => return Ok(()),
        }
        if telemetry.state == State::Disarmed {
            self.settle(asked)?;
        }
        Ok(())
    }

    /// Waits until an armed leg is where it shall be, and stays so.
    pub(super) fn settle(&mut self, asked: &'static str) -> Result<Telemetry<f32>, OperatorError> {
        let mut settling = Settling::default();
        self.poll_followed(asked, &MOVE, |telemetry| settling.take(telemetry))
    }

    /// Polls a leg that follows commands until `done` says so; what else it may come to is an error. How long it may take by its settings is
    /// asked where it takes longer than usual.
    pub(super) fn poll_followed(
        &mut self,
        asked: &'static str,
        (usual, longest): &Longest,
        mut done: impl FnMut(&Telemetry<f32>) -> bool,
    ) -> Result<Telemetry<f32>, OperatorError> {
        let begun = self.now();
        let mut limit = *usual;
        loop {
            let telemetry = self.telemetry()?.telemetry;
            if !telemetry.state.follows() {
                return Err(not_following(asked, &telemetry));
            }
            if done(&telemetry) {
                return Ok(telemetry);
            }
            if self.now() >= begun + limit {
                let needed = longest(&self.settings()?);
                if needed <= limit {
                    // What limits the leg is why it does not arrive.
                    unlimited(asked, &telemetry)?;
                    let telemetry = Box::new(telemetry);
                    return Err(OperatorError::TimedOut(asked, limit, telemetry));
                }
                limit = needed;
            }
            self.pause(POLL_TIME)?;
        }
    }
}

/// Why a leg that was driven no longer follows commands.
pub(super) fn not_following(asked: &'static str, telemetry: &Telemetry<f32>) -> OperatorError {
    if telemetry.faults.stopping().any() {
        OperatorError::Failed(asked, Box::new(*telemetry))
    } else {
        OperatorError::StoppedByOtherHost(asked, telemetry.state)
    }
}

pub(super) fn unlimited(
    asked: &'static str,
    telemetry: &Telemetry<f32>,
) -> Result<(), OperatorError> {
    if telemetry.faults.limits().any() {
        return Err(OperatorError::Limited(asked, Box::new(*telemetry)));
    }
    Ok(())
}

/// Whether a command was refused because a stop or a disarm came first, or another host drives since.
pub(super) fn is_overtaken(error: &OperatorError) -> bool {
    matches!(
        error,
        OperatorError::StoppedByOtherHost(_, State::RampingDown)
            | OperatorError::Refused(
                _,
                HostRefusal::OtherHost
                    | HostRefusal::Command(
                        CommandRefusal::Superseded | CommandRefusal::State(State::RampingDown)
                    )
            )
    )
}
