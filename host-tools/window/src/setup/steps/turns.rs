//! The encoders: every motor is turned once by hand, and its counter is read before and after.

use crate::setup::editor::Editor;
use crate::shown_leg::ShownLeg;
use leg_rig::motor_turn::MotorTurn;

/// Time in which a hand turns the motor of a simulated leg, s of the leg.
const REHEARSED_S: f64 = 1.5;

/// How far it has come.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum TurnStep {
    /// Nothing was read.
    #[default]
    Begin,
    /// The counter before the turn is read.
    Before,
    /// The motor is to be turned.
    Turn(u16),
    /// A simulated leg's is turned, until a time of the leg, s.
    Rehearse(u16, f64),
    /// The counter after the turn is read.
    After(u16),
    /// All of them were turned.
    Done,
}

/// The turns of all motors.
#[derive(Clone, Debug, Default)]
pub struct Turns {
    step: TurnStep,
    turns: Vec<MotorTurn>,
}

impl Turns {
    /// How far it has come.
    #[must_use]
    pub const fn step(&self) -> TurnStep {
        self.step
    }

    /// The motor whose turn it is, from 0.
    #[must_use]
    pub fn motor(&self) -> usize {
        self.turns.len().min(2)
    }

    /// Those that were turned.
    #[must_use]
    pub fn turns(&self) -> &[MotorTurn] {
        &self.turns
    }

    /// Begins with the first motor.
    pub fn start(&mut self, leg: &mut ShownLeg) {
        leg.take_sensors();
        *self = Self {
            step: TurnStep::Before,
            turns: Vec::new(),
        };
    }

    /// The motor was turned; a simulated leg's is turned by that.
    pub fn turned(&mut self, leg: &mut ShownLeg) {
        let TurnStep::Turn(before) = self.step else {
            return;
        };
        leg.take_sensors();
        let motor = self.motor();
        self.step = match leg.simulated_mut() {
            None => TurnStep::After(before),
            Some(simulation) => {
                simulation.turn_motor(motor);
                TurnStep::Rehearse(before, simulation.leg().time_s() + REHEARSED_S)
            }
        };
    }

    /// Ends it.
    pub fn cancel(&mut self) {
        *self = Self::default();
    }

    /// Takes the counters that have come; by what is set.
    pub(super) fn advance(&mut self, leg: &mut ShownLeg, editor: &Editor) {
        if let TurnStep::Rehearse(before, until_s) = self.step
            && leg.time_s() >= until_s
        {
            self.step = TurnStep::After(before);
        }
        if !matches!(self.step, TurnStep::Before | TurnStep::After(_)) {
            return;
        }
        if leg.failure().is_some() || leg.locked().is_some() {
            self.cancel();
            return;
        }
        let Some(sensors) = leg.take_sensors() else {
            leg.ask_sensors();
            return;
        };
        let motor = self.motor();
        let count = sensors.encoder_counts[motor];
        self.step = match self.step {
            TurnStep::After(before) => {
                let axes = editor.settings().axes;
                let counts_per_turn = editor.counts_per_turn();
                let turn =
                    MotorTurn::new(motor, [before, count], counts_per_turn[motor], &axes[motor]);
                self.turns.push(turn);
                let done = self.turns.len() == axes.len();
                if done {
                    TurnStep::Done
                } else {
                    TurnStep::Before
                }
            }
            _ => TurnStep::Turn(count),
        };
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{TurnStep, Turns};
    use crate::setup::editor::Editor;
    use crate::shown_leg::ShownLeg;
    use crate::simulation::Simulation;
    use leg_firmware::command::Command;
    use leg_firmware::supervisor::State;
    use leg_rig::motor_turn::signs;

    #[test]
    fn every_motor_is_rehearsed_on_the_simulated_leg() {
        let mut leg = ShownLeg::Simulated(Box::new(Simulation::new().unwrap()));
        let editor = Editor::new(leg.source()).unwrap();
        let mut turns = Turns::default();
        leg.command(Command::Disarm, "disarm");
        while leg.state() != State::Disarmed {
            leg.advance(0.02, 0.0);
        }
        // The motors run out.
        for _ in 0..50 {
            leg.advance(0.02, 0.0);
        }
        turns.start(&mut leg);
        for _ in 0..2000 {
            leg.advance(0.02, 0.0);
            turns.advance(&mut leg, &editor);
            turns.turned(&mut leg);
        }
        assert_eq!(turns.step(), TurnStep::Done);
        assert!(
            turns.turns().iter().all(|turn| turn.passed),
            "{:?}",
            turns.turns()
        );
        assert_eq!(signs(turns.turns()).as_deref(), Some("[1, 1, 1]"));
    }
}
