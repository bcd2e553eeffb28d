//! What the host's commands make the leg do.

use super::{Leg, Outcome};
use crate::command::{Command, CommandRefusal};
use crate::control::{Measured, PretensionDemand};
use crate::supervisor::{Event, State};
use leg_model::{BendingAxis, Direction, Scalar};

/// Whether these are a cosine and a sine, but for their rounding. Of a direction of no length or of a huge one there is no
/// stiffness.
fn is_azimuth([cos, sin]: [f32; 2]) -> bool {
    (0.999..=1.001).contains(&(cos * cos + sin * sin))
}

impl<T: Scalar> Leg<T> {
    /// Takes a command, which a later tick obeys; the number comes back with its [`Outcome`]. A stop goes before whatever
    /// waits. False if there is no room; apart from the tick, as a board's link runs below it.
    pub fn command(&mut self, number: u16, command: Command) -> bool {
        if matches!(command, Command::Stop | Command::Disarm) {
            self.forget_commands();
        }
        let taken = self.commands.push_back((number, command)).is_ok();
        if taken {
            self.silence = 0;
            self.bad_frames = 0;
        }
        taken
    }

    /// Takes note of a frame that could not be read: see [`Fault::BadFrame`](crate::supervisor::Fault::BadFrame).
    pub fn misheard(&mut self) {
        self.bad_frames = self.bad_frames.saturating_add(1);
    }

    /// What became of the oldest command that has not been told of.
    pub fn outcome(&mut self) -> Option<Outcome> {
        self.outcomes.pop_front()
    }

    pub(super) fn forget_commands(&mut self) {
        while let Some((number, _)) = self.commands.pop_front() {
            self.tell(number, Err(CommandRefusal::Overtaken));
        }
    }

    fn tell(&mut self, number: u16, result: Result<(), CommandRefusal>) {
        if self.outcomes.is_full() {
            // Nobody asks for them.
            self.outcomes.pop_front();
        }
        let _ = self.outcomes.push_back(Outcome { number, result });
    }

    /// Obeys the command that waits longest.
    #[inline(never)]
    pub(super) fn obey(&mut self, (number, command): (u16, Command), measured: &Measured<T>) {
        let before = self.supervisor.state();
        let result = self.carry_out(command);
        let state = self.supervisor.state();
        if state != before {
            self.entered(state, measured);
        }
        self.tell(number, result);
    }

    fn carry_out(&mut self, command: Command) -> Result<(), CommandRefusal> {
        match command {
            Command::KeepAlive => Ok(()),
            Command::Arm if self.zero_m.is_none() => Err(CommandRefusal::NotHomed),
            Command::Arm => self.start(Event::Arm),
            Command::Home => self.start(Event::Home),
            Command::Move { x, y } => self.go(x.into(), y.into()),
            Command::Hold => {
                self.following()?;
                self.trajectory.stop();
                Ok(())
            }
            Command::Pretension(pretension_n) if pretension_n.is_finite() => {
                self.pretension
                    .demand(PretensionDemand::Pretension(pretension_n.into()));
                Ok(())
            }
            Command::Stiffness {
                demand_nm_per_rad,
                towards,
            } if demand_nm_per_rad > 0.0
                && demand_nm_per_rad.is_finite()
                && towards.is_none_or(is_azimuth) =>
            {
                let axis = match towards {
                    None => BendingAxis::Softest,
                    Some(towards) => BendingAxis::Towards(towards.map(T::from)),
                };
                self.pretension
                    .demand(PretensionDemand::Stiffness(demand_nm_per_rad.into(), axis));
                Ok(())
            }
            Command::Pretension(_) | Command::Stiffness { .. } => {
                self.refused = true;
                Err(CommandRefusal::Number)
            }
            Command::Compensation(compensation) => {
                self.compensation = compensation;
                Ok(())
            }
            Command::Stop => self.end(Event::Stop),
            Command::Disarm => self.end(Event::Disarm),
            Command::Clear => {
                self.refused = false;
                self.bad_frames = 0;
                self.supervisor.clear(self.zero_m.is_some());
                self.unfaulted()
            }
        }
    }

    /// What sets the leg in motion.
    fn start(&mut self, event: Event) -> Result<(), CommandRefusal> {
        if self.supervisor.happen(event) {
            return Ok(());
        }
        self.unfaulted()?;
        Err(CommandRefusal::State(self.supervisor.state()))
    }

    /// What brings it to rest; there is nothing to do where it rests already.
    fn end(&mut self, event: Event) -> Result<(), CommandRefusal> {
        let state = self.supervisor.state();
        let resting = match event {
            Event::Stop => matches!(state, State::Held | State::Disarmed | State::Off),
            _ => matches!(state, State::RampingDown | State::Disarmed | State::Off),
        };
        if resting || self.supervisor.happen(event) {
            Ok(())
        } else {
            Err(CommandRefusal::State(state))
        }
    }

    fn unfaulted(&self) -> Result<(), CommandRefusal> {
        if self.supervisor.latched().without_limits().any() {
            Err(CommandRefusal::Faulted)
        } else {
            Ok(())
        }
    }

    fn following(&self) -> Result<(), CommandRefusal> {
        match self.supervisor.state() {
            State::Active => Ok(()),
            state => self.unfaulted().and(Err(CommandRefusal::State(state))),
        }
    }

    /// A move inside the workspace; another is refused.
    fn go(&mut self, x: T, y: T) -> Result<(), CommandRefusal> {
        self.following()?;
        let reach = self.limits.tilt_max_sine;
        let inside = x * x + y * y <= reach * reach;
        match Direction::from_xy(x, y) {
            Ok(direction) if inside => {
                self.refused = false;
                self.trajectory.go(direction.half_tangent());
                Ok(())
            }
            _ => {
                self.refused = true;
                Err(if x.is_finite() && y.is_finite() {
                    CommandRefusal::OutOfReach
                } else {
                    CommandRefusal::Number
                })
            }
        }
    }
}
