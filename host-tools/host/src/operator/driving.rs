//! Moving the leg, and leaving it in hold.

use super::looking::near;
use super::{Operator, OperatorError};
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::host_link::HostRefusal;
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use std::time::Duration;

/// Longest homing.
const HOMING_TIME: Duration = Duration::from_secs(120);

/// Longest move with all that belongs to it.
const MOVE_TIME: Duration = Duration::from_secs(60);

/// How long the leg has to be settled.
const SETTLED_TIME: Duration = Duration::from_millis(300);

/// Distance of every tension from its target below which a leg is settled, N.
const SETTLED_N: f32 = 2.0;

/// Change between two looks below which pretension and stiffness are settled, as a part of each.
const SETTLED_PART: f32 = 1e-3;

/// How hard the tendons shall pull.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Demand {
    /// A pretension, N.
    Pretension(f32),
    /// A bending stiffness, N·m/rad: the smallest, or against a push towards (cos, sin).
    Stiffness(f32, Option<[f32; 2]>),
}

impl Demand {
    const fn command(self) -> Command {
        match self {
            Self::Pretension(pretension_n) => Command::Pretension(pretension_n),
            Self::Stiffness(demand_nm_per_rad, towards) => Command::Stiffness {
                demand_nm_per_rad,
                towards,
            },
        }
    }
}

/// What the leg shall do.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Goal {
    /// Where it shall point: horizontal components; where it is if left out.
    pub direction: Option<[f32; 2]>,
    /// How hard its tendons shall pull; as before if left out.
    pub demand: Option<Demand>,
}

impl Operator {
    /// Does `work` while the leg hears of this host, and leaves the leg in hold however that ends. A leg that obeyed nothing
    /// of it is left as it was.
    ///
    /// # Errors
    /// That of `work`, unless no stop is acknowledged; [`OperatorError::Impatient`] before anything is done.
    pub fn drive<T>(
        &mut self,
        work: impl FnOnce(&mut Self) -> Result<T, OperatorError>,
    ) -> Result<T, OperatorError> {
        self.learn_patience()?;
        self.alive = true;
        let result = work(self);
        self.alive = false;
        let halted = if self.drives { self.halt() } else { Ok(()) };
        match (result, halted) {
            // Without a line there can be no stop, and its error says what the leg does then.
            (Err(error @ OperatorError::Broken { .. }), _) => Err(error),
            // Worse than whatever went before: it is not known whether the leg rests.
            (_, Err(not_stopped)) => Err(not_stopped),
            (result, Ok(())) => result,
        }
    }

    /// Finds the zero and leaves the leg in hold, straight down. A leg in hold is disarmed first.
    ///
    /// # Errors
    /// As [`Self::command`]; [`OperatorError::Failed`] if a fault ends it.
    pub fn home(&mut self) -> Result<Telemetry<f32>, OperatorError> {
        let asked = "home";
        self.settle_state(asked)?;
        if self.telemetry()?.telemetry.state == State::Held {
            self.disarm()?;
        }
        self.drive(|operator| {
            operator.command(Command::Home)?;
            operator.following(asked, HOMING_TIME, |_, telemetry| {
                telemetry.state == State::Active
            })?;
            operator.settle(asked)
        })
    }

    /// Brings the leg to a goal and leaves it in hold. Arms it if it is homed and disarmed, ends a hold that no fault
    /// began.
    ///
    /// # Errors
    /// As [`Self::command`]; [`OperatorError::Failed`], [`OperatorError::Limited`], [`OperatorError::Overtaken`] or
    /// [`OperatorError::Late`] on the way.
    pub fn reach(&mut self, goal: &Goal) -> Result<Telemetry<f32>, OperatorError> {
        let asked = match (goal.direction, goal.demand) {
            (Some(_), _) => "move",
            (None, Some(_)) => "change its stiffness",
            (None, None) => "hold",
        };
        self.settle_state(asked)?;
        self.drive(|operator| {
            operator.activate(asked)?;
            if let Some(demand) = goal.demand {
                operator.command(demand.command())?;
            }
            if let Some([x, y]) = goal.direction {
                operator.command(Command::Move { x, y })?;
            }
            if *goal == Goal::default() {
                // Also where the leg is active: it is this host then that holds it, or another that drives it is named.
                operator.command(Command::Hold)?;
            }
            let telemetry = unlimited(asked, &operator.settle(asked)?)?;
            arrived(goal, &telemetry)
        })
    }

    /// Waits while the leg starts or relaxes; refuses a leg with a fault.
    fn settle_state(&mut self, asked: &'static str) -> Result<(), OperatorError> {
        let telemetry = self.until("come to rest", MOVE_TIME, |telemetry| {
            !matches!(telemetry.state, State::Boot | State::RampingDown)
        })?;
        let faults = telemetry.faults.without_limits();
        if faults.any() {
            return Err(OperatorError::Faulted { asked, faults });
        }
        Ok(())
    }

    /// Makes a leg without faults follow commands, its tendons taut.
    fn activate(&mut self, asked: &'static str) -> Result<(), OperatorError> {
        let telemetry = self.telemetry()?.telemetry;
        let refuse = |refusal| {
            Err(OperatorError::Refused {
                asked,
                refusal: HostRefusal::Command(refusal),
            })
        };
        match telemetry.state {
            State::Homing => return refuse(CommandRefusal::State(State::Homing)),
            _ if !telemetry.homed => return refuse(CommandRefusal::NotHomed),
            State::Disarmed => self.command(Command::Arm)?,
            State::Held | State::Off => self.command(Command::Clear)?,
            // Another host's, or not yet ended by its silence: the commands that follow tell.
            State::Active | State::Boot | State::RampingDown => return Ok(()),
        }
        if telemetry.state == State::Disarmed {
            self.settle(asked)?;
        }
        Ok(())
    }

    /// Waits until an armed leg is where it shall be, and stays so.
    fn settle(&mut self, asked: &'static str) -> Result<Telemetry<f32>, OperatorError> {
        let mut last: Option<Telemetry<f32>> = None;
        let mut since = None;
        self.following(asked, MOVE_TIME, |now, telemetry| {
            let before = last.replace(*telemetry);
            if !before.is_some_and(|before| settled(&before, telemetry)) {
                since = None;
                return false;
            }
            now >= *since.get_or_insert(now) + SETTLED_TIME
        })
    }

    /// Looks at a leg that follows commands until `done` with it; what else it may come to is an error.
    fn following(
        &mut self,
        asked: &'static str,
        timeout: Duration,
        mut done: impl FnMut(Duration, &Telemetry<f32>) -> bool,
    ) -> Result<Telemetry<f32>, OperatorError> {
        let until = self.now() + timeout;
        loop {
            let telemetry = self.telemetry()?.telemetry;
            let (state, faults) = (telemetry.state, telemetry.faults);
            if !state.follows() {
                let faults = faults.without_limits();
                return Err(if faults.any() {
                    OperatorError::Failed {
                        asked,
                        failed_tendon: telemetry.failed_tendon,
                        state,
                        faults,
                    }
                } else {
                    OperatorError::Overtaken { asked, state }
                });
            }
            if done(self.now(), &telemetry) {
                return Ok(telemetry);
            }
            if self.now() >= until {
                // What limits the leg is why it does not arrive.
                unlimited(asked, &telemetry)?;
                return Err(OperatorError::Late {
                    what: asked,
                    timeout,
                    state,
                    faults,
                });
            }
            self.pause(super::telemetry::LOOK_TIME)?;
        }
    }
}

fn settled(before: &Telemetry<f32>, now: &Telemetry<f32>) -> bool {
    let steady = |of: fn(&Telemetry<f32>) -> f32| {
        (of(now) - of(before)).abs() <= SETTLED_PART * of(now).abs()
    };
    !now.moving
        && steady(|telemetry| telemetry.pretension_n)
        && steady(|telemetry| telemetry.stiffness_nm_per_rad)
        && near(&now.pose, &now.target)
        && taut(&now.tensions_n, &now.target_tensions_n)
}

fn taut(measured_n: &[f32; 3], target_n: &[f32; 3]) -> bool {
    let mut pairs = measured_n.iter().zip(target_n);
    pairs.all(|(measured, target)| (measured - target).abs() <= SETTLED_N)
}

/// Whether the leg is where it shall be: a board may give up a way that it cannot plan.
fn arrived(goal: &Goal, telemetry: &Telemetry<f32>) -> Result<Telemetry<f32>, OperatorError> {
    match &goal.direction {
        Some(direction) if !near(&telemetry.target, direction) => Err(OperatorError::Elsewhere {
            pose: telemetry.pose,
        }),
        _ => Ok(*telemetry),
    }
}

fn unlimited(
    asked: &'static str,
    telemetry: &Telemetry<f32>,
) -> Result<Telemetry<f32>, OperatorError> {
    let faults = telemetry.faults.limits();
    if faults.any() {
        return Err(OperatorError::Limited {
            asked,
            faults,
            stiffness_nm_per_rad: telemetry.stiffness_nm_per_rad,
            pretension_n: telemetry.pretension_n,
        });
    }
    Ok(*telemetry)
}
