//! One motor, turned slowly: what the board saw of it.

use crate::shown_leg::ShownLeg;
use leg_base::jog_report::{self, Finding};
use leg_firmware::command::Command;
use leg_firmware::jog::{JOG_TRAVEL_MAX_M, JogDemand, JogDrive, JogReport};
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::State;

/// How far it may be asked to pull, mm.
pub const TRAVEL_MAX_MM: f32 = 1000.0 * JOG_TRAVEL_MAX_M;

/// Frames in which a jog has to begin: another command, or a refusal, may come before it.
const FRAMES_TO_BEGIN: u32 = 120;

/// How far it has come.
#[derive(Clone, Debug, PartialEq)]
pub enum JogStep {
    /// The motor is chosen.
    Choose,
    /// It was commanded so many frames ago.
    Commanded(u32),
    /// It turns.
    Turning,
    /// The board is asked what it saw.
    Asked,
    /// What it saw, and what does not fit.
    Done(Box<(JogReport<f32>, Vec<Finding>)>),
    /// It did not begin.
    Refused,
}

/// A jog.
#[derive(Clone, Debug)]
pub struct Jog {
    /// From 1.
    pub motor: u8,
    /// How far its tendon is pulled in, mm; below zero it is paid out.
    pub travel_mm: f32,
    step: JogStep,
    /// What had been refused before it.
    before: Option<String>,
}

impl Default for Jog {
    fn default() -> Self {
        Self {
            motor: 1,
            travel_mm: -1.0,
            step: JogStep::Choose,
            before: None,
        }
    }
}

impl Jog {
    /// How far it has come.
    #[must_use]
    pub const fn step(&self) -> &JogStep {
        &self.step
    }

    /// Whether it goes on.
    #[must_use]
    pub const fn busy(&self) -> bool {
        matches!(
            self.step,
            JogStep::Commanded(_) | JogStep::Turning | JogStep::Asked
        )
    }

    /// What the board is asked to do: at a voltage that turns slowly.
    #[must_use]
    pub fn demand(&self, settings: &Settings) -> JogDemand {
        JogDemand {
            motor: self.motor,
            travel_m: self.travel_mm / 1000.0,
            drive: JogDrive::Voltage(jog_report::slow_voltage_v(self.motor, settings)),
        }
    }

    /// Begins.
    pub fn start(&mut self, leg: &mut ShownLeg, settings: &Settings) {
        leg.take_jog();
        self.before = leg.refusal().map(Into::into);
        leg.command(Command::Jog(self.demand(settings)), "jog");
        self.step = JogStep::Commanded(0);
    }

    /// Follows the leg.
    pub(super) fn advance(&mut self, leg: &mut ShownLeg) {
        let jogging = leg.state() == State::Jogging;
        match self.step {
            JogStep::Commanded(_) if jogging => self.step = JogStep::Turning,
            JogStep::Commanded(frames)
                if leg.refusal() != self.before.as_deref() || frames > FRAMES_TO_BEGIN =>
            {
                self.step = JogStep::Refused;
            }
            JogStep::Commanded(frames) => self.step = JogStep::Commanded(frames + 1),
            JogStep::Turning if leg.failure().is_some() => self.step = JogStep::Refused,
            JogStep::Turning if !jogging => {
                leg.ask_jog();
                self.step = JogStep::Asked;
            }
            JogStep::Asked => self.take(leg),
            _ => {}
        }
    }

    fn take(&mut self, leg: &mut ShownLeg) {
        let Some(report) = leg.take_jog() else {
            if leg.failure().is_some() {
                self.step = JogStep::Refused;
            } else {
                leg.ask_jog();
            }
            return;
        };
        let rig = leg.rig();
        let settings = leg_rig::control_settings::settings(rig, &rig.gains, None);
        let findings = jog_report::findings(&report, &settings);
        self.step = JogStep::Done(Box::new((report, findings)));
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{Jog, JogStep};
    use crate::setup::editor::Editor;
    use crate::shown_leg::ShownLeg;
    use crate::simulation::Simulation;
    use leg_firmware::command::Command;
    use leg_firmware::jog::JogEnd;
    use leg_firmware::supervisor::State;

    fn wait(leg: &mut ShownLeg, jog: &mut Jog, done: impl Fn(&ShownLeg, &Jog) -> bool) {
        for _ in 0..2000 {
            if done(leg, jog) {
                return;
            }
            leg.advance(0.02, 0.0);
            jog.advance(leg);
        }
        panic!("{:?}", jog.step());
    }

    #[test]
    fn a_motor_is_rehearsed_on_the_simulated_leg_and_refused_while_it_is_driven() {
        let mut leg = ShownLeg::Simulated(Box::new(Simulation::new().unwrap()));
        let settings = Editor::new(leg.source()).unwrap().settings();
        let mut jog = Jog {
            motor: 2,
            ..Jog::default()
        };
        jog.start(&mut leg, &settings);
        wait(&mut leg, &mut jog, |_, jog| *jog.step() == JogStep::Refused);
        leg.command(Command::Disarm, "disarm");
        wait(&mut leg, &mut jog, |leg, _| leg.state() == State::Disarmed);
        jog.start(&mut leg, &settings);
        wait(&mut leg, &mut jog, |_, jog| {
            matches!(jog.step(), JogStep::Done(_))
        });
        let JogStep::Done(done) = jog.step() else {
            panic!()
        };
        let (report, findings) = &**done;
        assert_eq!((report.end, report.demand.motor), (JogEnd::Arrived, 2));
        assert!((report.pulled_m[1] + 1e-3).abs() < 2e-4, "{report:?}");
        assert!(findings.is_empty(), "{findings:?}");
    }
}
