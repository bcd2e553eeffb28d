//! What a motor, its gear and the tendons are, measured by the leg itself: what `leg tune` does, by the same code.

use super::page_leg::{LegRequest, Mailbox, PageLeg};
use crate::shown_leg::ShownLeg;
use leg_firmware::command::Command;
use leg_firmware::settings::Settings;
use leg_rig::control_settings;
use leg_rig::rig_file::RigFile;
use leg_rig::tune::{
    ComparisonRow, JogPlan, Jogged, Swing, SwingPlan, comparison, measure_motor, measure_swing,
};
use std::cell::RefCell;
use std::fmt;
use std::pin::Pin;
use std::rc::Rc;
use std::task::{Context, Poll, Waker};

/// What was measured beside what is set, and why it is not more.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The motor, from 1.
    pub motor: u8,
    /// What was measured; nothing where the motor itself could not be.
    pub rows: Vec<ComparisonRow>,
    /// What is wrong with its servo.
    pub servo_finding: Option<String>,
    /// Why it was not measured to the end.
    pub failure: Option<String>,
}

/// How far it has come.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum TuneStep {
    /// The motor is chosen.
    #[default]
    Choose,
    /// It is measured.
    Measuring,
    /// It was.
    Done(Outcome),
}

/// Which rigs a measurement uses.
struct Rigs {
    /// By which the leg is driven.
    of_leg: RigFile,
    /// With which the result is compared.
    compared: RigFile,
}

impl Rigs {
    /// A board stores neither gear nor screw: for a live leg these are taken from the settings of the page. All else is what the leg runs
    /// with.
    fn new(leg: &ShownLeg, set: &RigFile) -> Self {
        let of_leg = *leg.rig();
        let actuators = if leg.live().is_some() {
            set.actuators
        } else {
            of_leg.actuators
        };
        let compared = RigFile {
            actuators,
            ..of_leg
        };
        Self { of_leg, compared }
    }
}

/// The measurement under way.
struct Work(Pin<Box<dyn Future<Output = Outcome>>>);

impl fmt::Debug for Work {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Work")
    }
}

/// A measurement of one motor, and of the swing of the leg.
#[derive(Debug)]
pub struct Tune {
    /// From 1.
    pub motor: u8,
    /// Whether the leg is homed then, and swings.
    pub swings: bool,
    step: TuneStep,
    work: Option<Work>,
    mailbox: Rc<RefCell<Mailbox>>,
    /// What is seen of it.
    seen: Rc<RefCell<String>>,
    supply_v: Option<f32>,
    /// The tick of the last report that was taken.
    tick: Option<u32>,
}

impl Default for Tune {
    fn default() -> Self {
        Self {
            motor: 1,
            swings: true,
            step: TuneStep::default(),
            work: None,
            mailbox: Rc::default(),
            seen: Rc::default(),
            supply_v: None,
            tick: None,
        }
    }
}

impl Tune {
    /// How far it has come.
    #[must_use]
    pub const fn step(&self) -> &TuneStep {
        &self.step
    }

    /// Why it was not measured to the end.
    #[must_use]
    pub fn failure(&self) -> Option<&str> {
        match &self.step {
            TuneStep::Done(outcome) => outcome.failure.as_deref(),
            _ => None,
        }
    }

    /// What is seen of it.
    #[must_use]
    pub fn seen(&self) -> String {
        self.seen.borrow().clone()
    }

    /// What it will do: none before the supply is known. The swing is seen by 500 reports a second, which a live leg does not send
    /// to a page.
    #[must_use]
    pub fn plan(&self, leg: &ShownLeg) -> Option<(JogPlan, Option<SwingPlan>)> {
        let jogs = JogPlan::new(self.motor, &settings(leg.rig()), self.supply_v?);
        let swings = self.swings && leg.live().is_none();
        Some((jogs, swings.then(|| SwingPlan::new(leg.rig()))))
    }

    /// Asks for the voltage of the supply until it is known.
    pub(super) fn ask_supply(&mut self, leg: &mut ShownLeg) {
        if self.supply_v.is_some() || leg.locked().is_some() {
            return;
        }
        match leg.take_sensors() {
            Some(sensors) => {
                let v_per_code = settings(leg.rig()).board.supply_v_per_code;
                self.supply_v = Some(f32::from(sensors.supply_code) * v_per_code);
            }
            None => leg.ask_sensors(),
        }
    }

    /// Begins; `set` are the settings of the page.
    pub fn start(&mut self, leg: &ShownLeg, set: &RigFile) {
        let Some((jogs, swing)) = self.plan(leg) else {
            return;
        };
        self.mailbox = Rc::default();
        self.seen = Rc::default();
        self.tick = None;
        let page_leg = PageLeg::new(self.mailbox.clone(), &settings(leg.rig()));
        let rigs = Rigs::new(leg, set);
        let work = measure(page_leg, jogs, swing, rigs, self.seen.clone());
        self.work = Some(Work(Box::pin(work)));
        self.step = TuneStep::Measuring;
    }

    /// Ends it, and stops the leg if it is driven.
    pub fn cancel(&mut self, leg: &mut ShownLeg) {
        self.work = None;
        self.step = TuneStep::Choose;
        stop(leg);
    }

    /// Looks at the leg, which has reported something, and asks what is wished.
    pub(super) fn look(&mut self, leg: &mut ShownLeg) {
        let Some(Work(work)) = &mut self.work else {
            return;
        };
        {
            let mut mailbox = self.mailbox.borrow_mut();
            let report = leg.telemetry().copied();
            mailbox.report = report.filter(|report| self.tick != Some(report.tick));
            self.tick = report.map(|report| report.tick);
            mailbox.answered = leg.answered();
            mailbox.refusal = leg.refusal().map(Into::into);
            mailbox.failure = leg.failure().or(leg.locked().map(Into::into));
            if let Some(jog) = leg.take_jog() {
                mailbox.jog = Some(jog);
            }
        }
        let polled = work.as_mut().poll(&mut Context::from_waker(Waker::noop()));
        for wish in std::mem::take(&mut self.mailbox.borrow_mut().wishes) {
            match wish {
                LegRequest::Command(command, name) => leg.command(command, name),
                LegRequest::JogReport => leg.ask_jog(),
            }
        }
        if let Poll::Ready(outcome) = polled {
            if outcome.failure.is_some() {
                stop(leg);
            }
            self.step = TuneStep::Done(outcome);
            self.work = None;
        }
    }
}

fn settings(rig: &RigFile) -> Settings {
    control_settings::settings(rig, &rig.gains, None)
}

fn stop(leg: &mut ShownLeg) {
    if leg.state().follows() {
        leg.command(Command::Stop, "stop");
    }
}

/// What `leg tune` does, with the leg of a page.
async fn measure(
    mut leg: PageLeg,
    jogs: JogPlan,
    swing: Option<SwingPlan>,
    rigs: Rigs,
    seen: Rc<RefCell<String>>,
) -> Outcome {
    let motor = jogs.motor;
    let note = |words: String| *seen.borrow_mut() = words;
    note(format!(
        "Motor {motor} pays its tendon out until it is slack."
    ));
    let jogged = &mut |jogged: &Jogged| note(jogged_words(motor, jogged));
    let measured = measure_motor(&mut leg, &jogs, &settings(&rigs.of_leg), jogged).await;
    let measured = match measured {
        Ok(measured) => measured,
        Err(error) => {
            return Outcome {
                motor,
                rows: Vec::new(),
                servo_finding: None,
                failure: Some(error.failure().render(false)),
            };
        }
    };
    let servo_finding = measured
        .servo_finding
        .as_ref()
        .map(|finding| format!("{}: {}", finding.what, finding.remedy));
    let Some(plan) = swing else {
        return Outcome {
            motor,
            rows: comparison(&measured, None, &rigs.compared),
            servo_finding,
            failure: None,
        };
    };
    note("The leg is homed, and its pretension changed.".into());
    let swung = &mut |swing: &Swing| note(swing_words(swing));
    let (swings, failure) = match measure_swing(&mut leg, &plan, &rigs.of_leg, swung).await {
        Ok(swings) => (Some(swings), None),
        Err(error) => (None, Some(error.failure().render(false))),
    };
    // The motor may be why, as one with more friction than is configured: what it is must not be lost.
    Outcome {
        motor,
        rows: comparison(&measured, swings.as_ref(), &rigs.compared),
        servo_finding,
        failure,
    }
}

fn jogged_words(motor: u8, jogged: &Jogged) -> String {
    format!(
        "Motor {motor}: {:+.2} V, {:+.2} mm/s, {:+.3} A, {:.1} N",
        jogged.voltage_v,
        1000.0 * jogged.speed_m_per_s,
        jogged.current_a,
        jogged.tension_n
    )
}

fn swing_words(swing: &Swing) -> String {
    format!(
        "At {:.0} N the leg swings with {:.2} Hz.",
        swing.pretension_n, swing.frequency_hz.value
    )
}

#[cfg(test)]
mod tests;
