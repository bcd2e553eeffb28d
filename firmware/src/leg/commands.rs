//! What the host's bytes make the leg do.

use super::Leg;
use crate::command::Command;
use crate::control::{LevelDemand, Measured};
use crate::supervisor::{Event, State};
use leg_model::{BendingAxis, Direction, Scalar};

impl<T: Scalar> Leg<T> {
    /// Takes bytes from the host; apart from the tick, as a board's link runs below it. A frame that cannot be read, and
    /// a command for which there is no room, is told by [`Fault::BadFrame`](crate::supervisor::Fault::BadFrame).
    pub fn receive(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            let command = match self.decoder.push(byte) {
                None => continue,
                Some(Ok(frame)) => frame.message::<Command>(),
                Some(Err(_)) => None,
            };
            let taken = command.is_some_and(|command| self.commands.push_back(command).is_ok());
            if taken {
                self.silence = 0;
                self.bad_frames = 0;
            } else {
                self.bad_frames = self.bad_frames.saturating_add(1);
            }
        }
    }

    #[inline(never)]
    pub(super) fn obey(&mut self, command: Command, measured: &Measured<T>) {
        let before = self.supervisor.state();
        match command {
            Command::KeepAlive => {}
            Command::Arm => {
                if self.zero_m.is_some() {
                    self.supervisor.happen(Event::Arm);
                }
            }
            Command::Home => {
                self.supervisor.happen(Event::Home);
            }
            Command::Move { x, y } => self.go(x.into(), y.into()),
            Command::Hold => self.trajectory.stop(),
            Command::Level(level_n) if level_n.is_finite() => {
                self.level.demand(LevelDemand::Level(level_n.into()));
            }
            Command::Stiffness {
                demand_nm_per_rad,
                towards,
            } if demand_nm_per_rad > 0.0 && demand_nm_per_rad.is_finite() => {
                let axis = match towards {
                    None => BendingAxis::Softest,
                    Some(towards) => BendingAxis::Towards(towards.map(T::from)),
                };
                self.level
                    .demand(LevelDemand::Stiffness(demand_nm_per_rad.into(), axis));
            }
            Command::Level(_) | Command::Stiffness { .. } => self.refused = true,
            Command::Compensation(compensation) => self.compensation = compensation,
            Command::Stop => {
                self.supervisor.happen(Event::Stop);
            }
            Command::Disarm => {
                self.supervisor.happen(Event::Disarm);
            }
            Command::Clear => {
                self.refused = false;
                self.bad_frames = 0;
                self.supervisor.clear(self.zero_m.is_some());
            }
        }
        let state = self.supervisor.state();
        if state != before {
            self.entered(state, measured);
        }
    }

    /// A move inside the workspace; another is refused.
    fn go(&mut self, x: T, y: T) {
        if self.supervisor.state() != State::Active {
            return;
        }
        let reach = self.limits.tilt_max_sine;
        let inside = x * x + y * y <= reach * reach;
        match Direction::from_xy(x, y) {
            Ok(direction) if inside => {
                self.refused = false;
                self.trajectory.go(direction.half_tangent());
            }
            _ => self.refused = true,
        }
    }
}
