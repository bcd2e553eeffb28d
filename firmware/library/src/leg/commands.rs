//! What the host's commands make the leg do.

use super::active::Active;
use super::jogging::Jogging;
use super::mode::Mode;
use super::shared::Shared;
use super::{CommandOutcome, Leg};
use crate::command::{Command, CommandRefusal, Compensation};
use crate::control::{JogBounds, Measured, PretensionDemand};
use crate::jog::JogDemand;
use crate::set_point::{SetPoint, StreamTension};
use crate::supervisor::{Event, State};
use leg_model::{BendingAxis, Direction, Scalar};

/// Whether these are a cosine and a sine, but for their rounding. Of a direction of no length or of a huge one there is no
/// stiffness.
fn is_azimuth([cos, sin]: [f32; 2]) -> bool {
    (0.999..=1.001).contains(&(cos * cos + sin * sin))
}

impl<T: Scalar> Leg<T> {
    /// Takes a command, which a later tick executes; the number comes back with its [`CommandOutcome`]. A stop goes before whatever
    /// waits. False if there is no room; apart from the tick, as a board's link runs below it.
    pub fn command(&mut self, number: u16, command: Command) -> bool {
        if matches!(command, Command::Stop | Command::Disarm) {
            self.queue.supersede();
        }
        let taken = self.queue.push(number, command);
        if taken {
            self.link.heard();
        }
        taken
    }

    /// Counts a frame that could not be decoded: see [`Fault::BadFrame`](crate::supervisor::Fault::BadFrame).
    pub fn note_decode_error(&mut self) {
        self.link.note_decode_error();
    }

    /// What became of the oldest command that has not been reported.
    pub fn outcome(&mut self) -> Option<CommandOutcome> {
        self.queue.outcome()
    }

    /// Executes a command.
    #[inline(never)]
    pub(super) fn obey(&mut self, (number, command): (u16, Command), measured: &Measured<T>) {
        let result = self.execute(command, measured);
        self.queue.report(number, result);
    }

    fn execute(&mut self, command: Command, measured: &Measured<T>) -> Result<(), CommandRefusal> {
        match command {
            Command::KeepAlive => Ok(()),
            Command::Pretension(_) | Command::Stiffness { .. } | Command::Compensation(_)
                if let Some(state) = self.mode.refuses_as() =>
            {
                Err(CommandRefusal::State(state))
            }
            Command::Arm if self.shared.zero_m.is_none() => Err(CommandRefusal::NotHomed),
            Command::Arm => self.start(Event::Arm, measured),
            Command::Home => self.start(Event::Home, measured),
            Command::Jog(demand) => self.jog(&demand, measured),
            Command::Move { x, y } => self.start_move(x.into(), y.into()),
            Command::Follow(point) => self.follow(&point),
            Command::Hold => {
                let (active, shared) = self.active()?;
                active.hold(shared);
                Ok(())
            }
            Command::Pretension(pretension_n) => self.demand_pretension(pretension_n),
            Command::Stiffness {
                demand_nm_per_rad,
                towards,
            } => self.demand_stiffness(demand_nm_per_rad, towards),
            Command::Compensation(compensation) => {
                self.compensate(compensation, measured);
                Ok(())
            }
            Command::Stop => self.end(Event::Stop, measured),
            Command::Disarm => self.disarm(measured),
            Command::KeepStation => self.keep_station(measured),
            Command::Clear => {
                self.shared.refused = false;
                self.link.clear_bad_frames();
                let homed = self.shared.zero_m.is_some();
                // Whichever fault was latched: a held leg whose sensors disagree does not follow them again.
                let causes = self.doubts(measured);
                let state = self.mode.state();
                let next = self.supervisor.clear(state, homed, causes);
                self.unfaulted()?;
                self.monitors.forget_jumps();
                if let Some(state) = next {
                    self.enter(state, measured);
                }
                Ok(())
            }
        }
    }

    /// Changes the compensation. A leg whose load is left out, and that stayed where it was as no tensions held what was taken for that load, goes on from
    /// there as one that is armed: its last target was made for that load.
    #[cold]
    #[inline(never)]
    fn compensate(&mut self, compensation: Compensation, measured: &Measured<T>) {
        self.shared.compensation = compensation;
        let active = self.mode.active();
        let rests = active.is_some_and(Active::rests_without_target);
        if rests && compensation == Compensation::Off {
            self.shared.refused = false;
            // The mode is left, so that it begins anew.
            self.mode = Mode::Disarmed;
            self.enter(State::Active, measured);
        }
    }

    /// What sets the leg in motion.
    fn start(&mut self, event: Event, measured: &Measured<T>) -> Result<(), CommandRefusal> {
        let before = self.mode.state();
        let Some(state) = self.supervisor.next(before, event) else {
            self.unfaulted()?;
            return Err(CommandRefusal::State(before));
        };
        self.enter(state, measured);
        Ok(())
    }

    /// Turns one motor of a disarmed leg.
    // Apart, so that the commands of a leg that moves need not keep room for it.
    #[cold]
    #[inline(never)]
    fn jog(&mut self, demand: &JogDemand, measured: &Measured<T>) -> Result<(), CommandRefusal> {
        let bounds = JogBounds::select(&self.shared.limits.jogs, demand);
        let bounds = bounds.map_err(CommandRefusal::Jog)?;
        self.start(Event::Jog, measured)
            .map_err(|refusal| match refusal {
                CommandRefusal::State(state) => CommandRefusal::NotDisarmed(state),
                other => other,
            })?;
        self.mode = Mode::Jogging(Jogging::begin(&mut self.shared, demand, &bounds, measured));
        Ok(())
    }

    /// What brings it to rest; there is nothing to do where it rests already.
    fn end(&mut self, event: Event, measured: &Measured<T>) -> Result<(), CommandRefusal> {
        let before = self.mode.state();
        let resting = match event {
            Event::Stop => matches!(before, State::Held | State::Disarmed | State::Off),
            _ => matches!(before, State::RampingDown | State::Disarmed | State::Off),
        };
        if resting {
            return Ok(());
        }
        let next = self.supervisor.next(before, event);
        self.enter(next.ok_or(CommandRefusal::State(before))?, measured);
        Ok(())
    }

    /// Leads a leg that knows its pose down before its tendons are paid out. A command that is repeated changes nothing.
    fn disarm(&mut self, measured: &Measured<T>) -> Result<(), CommandRefusal> {
        let trusted = self.agreement.watches() && self.unfaulted().is_ok();
        if self.mode.active().is_some_and(|active| active.disarming) {
            return Ok(());
        }
        if !trusted {
            return self.end(Event::Disarm, measured);
        }
        if let Some(state) = self.supervisor.next(self.mode.state(), Event::LeadDown) {
            self.enter(state, measured);
        }
        self.shared.refused = false;
        if let Mode::Active(active) = &mut self.mode {
            active.disarm(&mut self.shared);
        }
        Ok(())
    }

    /// Leaves the leg to itself. A command that is repeated changes nothing.
    fn keep_station(&mut self, measured: &Measured<T>) -> Result<(), CommandRefusal> {
        self.unfaulted()?;
        if matches!(self.mode.state(), State::KeepingStation | State::Held) {
            return Ok(());
        }
        let trusted = self.agreement.trusts();
        let (active, shared) = self.active()?;
        let keeps = trusted && active.may_keep_station(shared);
        self.end(
            if keeps {
                Event::KeepStation
            } else {
                Event::Stop
            },
            measured,
        )
    }

    fn unfaulted(&self) -> Result<(), CommandRefusal> {
        if self.supervisor.stopped() {
            Err(CommandRefusal::Faulted)
        } else {
            Ok(())
        }
    }

    /// The active mode, and what it works with; refused in every other.
    fn active(&mut self) -> Result<(&mut Active<T>, &mut Shared<T>), CommandRefusal> {
        let refusal = self.unfaulted().err();
        if let Some(state) = self.mode.refuses_as() {
            return Err(CommandRefusal::State(state));
        }
        let state = self.mode.state();
        match &mut self.mode {
            Mode::Active(active) => Ok((active, &mut self.shared)),
            _ => Err(refusal.unwrap_or(CommandRefusal::State(state))),
        }
    }

    /// Takes a set-point of a stream.
    fn follow(&mut self, point: &SetPoint) -> Result<(), CommandRefusal> {
        let tick = self.tick;
        let (active, shared) = self.active()?;
        let taken = active.follow(shared, tick, point);
        taken.map_err(CommandRefusal::Point)
    }

    fn demand_pretension(&mut self, pretension_n: f32) -> Result<(), CommandRefusal> {
        if !pretension_n.is_finite() {
            return self.refuse(CommandRefusal::Number);
        }
        self.demand(PretensionDemand::Pretension(pretension_n.into()));
        Ok(())
    }

    fn demand_stiffness(
        &mut self,
        demand_nm_per_rad: f32,
        towards: Option<[f32; 2]>,
    ) -> Result<(), CommandRefusal> {
        let possible = StreamTension::Stiffness(demand_nm_per_rad).is_possible();
        if !possible || !towards.is_none_or(is_azimuth) {
            return self.refuse(CommandRefusal::Number);
        }
        let axis = match towards {
            None => BendingAxis::Softest,
            Some(towards) => BendingAxis::Towards(towards.map(T::from)),
        };
        self.demand(PretensionDemand::Stiffness(demand_nm_per_rad.into(), axis));
        Ok(())
    }

    /// Tenses the leg so. One that rests without a target still has none.
    fn demand(&mut self, demand: PretensionDemand<T>) {
        self.shared.pretension.demand(demand);
        let active = self.mode.active();
        self.shared.refused &= active.is_some_and(Active::rests_without_target);
    }

    /// A move inside the workspace; another is refused.
    fn start_move(&mut self, x: T, y: T) -> Result<(), CommandRefusal> {
        let reach = self.shared.limits.tilt_max_sine;
        let (active, shared) = self.active()?;
        let inside = x * x + y * y <= reach * reach;
        match Direction::from_xy(x, y) {
            Ok(direction) if inside => {
                active.go(shared, &direction);
                shared.refused = false;
                Ok(())
            }
            _ => self.refuse(if x.is_finite() && y.is_finite() {
                CommandRefusal::OutOfReach
            } else {
                CommandRefusal::Number
            }),
        }
    }

    /// Refuses what cannot be reached; [`Fault::Infeasible`](crate::supervisor::Fault::Infeasible) shows it until another
    /// command is accepted.
    fn refuse(&mut self, refusal: CommandRefusal) -> Result<(), CommandRefusal> {
        self.shared.refused = true;
        Err(refusal)
    }
}

#[cfg(test)]
mod tests;
