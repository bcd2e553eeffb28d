//! The leg that the window shows: one simulated in the page, or a live one. Panels that are for both know this alone.

use crate::history::History;
use crate::live_leg::LiveLeg;
use crate::live_leg::board::Errand;
use crate::recorder::Recorder;
use crate::seen_leg::{self, SeenLeg};
use crate::simulation::{Push, Simulation};
use leg_firmware::command::Command;
use leg_firmware::host_link::HostRequest;
use leg_firmware::jog::JogReport;
use leg_firmware::sensors::Sensors;
use leg_firmware::supervisor::{FaultSet, State};
use leg_firmware::telemetry::Telemetry;
use leg_rig::rig_file::{RigFile, RigText};
use leg_sim::plant::Defect;
use nalgebra::Vector3;

/// Ticks from one look at a simulated leg to the next: what a host on a serial line sees of one, 500 times a second.
const WATCH_TICKS: u32 = 16;

/// Either.
pub enum ShownLeg {
    /// Firmware and mechanism run in the page.
    Simulated(Box<Simulation>),
    /// The page hears what it reports.
    Live(Box<LiveLeg>),
}

impl ShownLeg {
    /// Lets time pass: so much since the last frame, until a time of the window, s.
    pub fn advance(&mut self, elapsed_s: f64, now_s: f64) {
        match self {
            Self::Simulated(leg) => leg.advance(elapsed_s),
            Self::Live(leg) => leg.advance(now_s),
        }
    }

    /// The same, and calls `watch` whenever the leg has gone on for some ticks, or was heard.
    pub fn advance_watched(
        &mut self,
        elapsed_s: f64,
        now_s: f64,
        watch: &mut dyn FnMut(&mut Self),
    ) {
        let Self::Simulated(leg) = self else {
            self.advance(elapsed_s, now_s);
            return watch(self);
        };
        let mut left = leg.pace.ticks(elapsed_s);
        while left > 0 {
            let ticks = left.min(WATCH_TICKS);
            left -= ticks;
            if let Self::Simulated(leg) = self {
                leg.run(ticks);
            }
            watch(self);
        }
    }

    /// Whether it has answered every command.
    #[must_use]
    pub fn answered(&self) -> bool {
        match self {
            Self::Simulated(leg) => leg.answered(),
            Self::Live(leg) => leg.answered(),
        }
    }

    /// Commands it; `name` is what the window calls that. A locked leg is only stopped.
    pub fn command(&mut self, command: Command, name: &'static str) {
        match self {
            Self::Simulated(leg) => leg.command(command, name),
            Self::Live(leg) => leg.command(command, name),
        }
    }

    /// Why it takes no command but a stop; none if it takes them.
    #[must_use]
    pub fn locked(&self) -> Option<&'static str> {
        match self {
            Self::Simulated(_) => None,
            Self::Live(leg) => leg.locked(),
        }
    }

    /// The simulated one.
    #[must_use]
    pub fn simulated(&self) -> Option<&Simulation> {
        match self {
            Self::Simulated(leg) => Some(leg),
            Self::Live(_) => None,
        }
    }

    /// The simulated one, to be loaded and broken.
    pub fn simulated_mut(&mut self) -> Option<&mut Simulation> {
        match self {
            Self::Simulated(leg) => Some(leg),
            Self::Live(_) => None,
        }
    }

    /// The live one.
    #[must_use]
    pub fn live(&self) -> Option<&LiveLeg> {
        match self {
            Self::Simulated(_) => None,
            Self::Live(leg) => Some(leg),
        }
    }

    /// The live one, to be unlocked.
    pub fn live_mut(&mut self) -> Option<&mut LiveLeg> {
        match self {
            Self::Simulated(_) => None,
            Self::Live(leg) => Some(leg),
        }
    }

    /// Its settings.
    #[must_use]
    pub fn rig(&self) -> &RigFile {
        match self {
            Self::Simulated(leg) => leg.rig(),
            Self::Live(leg) => leg.rig(),
        }
    }

    /// The same as a rig file.
    #[must_use]
    pub fn source(&self) -> &RigText {
        match self {
            Self::Simulated(leg) => leg.source(),
            Self::Live(leg) => leg.source(),
        }
    }

    /// What its signals were.
    #[must_use]
    pub fn history(&self) -> &History {
        match self {
            Self::Simulated(leg) => &leg.history,
            Self::Live(leg) => leg.history(),
        }
    }

    /// Time since its board started, s.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        match self {
            Self::Simulated(leg) => leg.leg().time_s(),
            Self::Live(leg) => leg.time_s(),
        }
    }

    /// What it reported last.
    #[must_use]
    pub fn telemetry(&self) -> Option<&Telemetry<f32>> {
        match self {
            Self::Simulated(leg) => leg.telemetry(),
            Self::Live(leg) => leg.telemetry(),
        }
    }

    /// What it may do.
    #[must_use]
    pub fn state(&self) -> State {
        self.telemetry()
            .map_or(State::Boot, |telemetry| telemetry.state)
    }

    /// What is wrong with it.
    #[must_use]
    pub fn faults(&self) -> FaultSet {
        self.telemetry()
            .map_or(FaultSet::NONE, |telemetry| telemetry.faults)
    }

    /// Whether what it reported last still holds: nothing is known of a live leg that is not heard.
    #[must_use]
    pub fn is_heard(&self) -> bool {
        self.live()
            .is_none_or(|leg| leg.telemetry().is_some() && leg.failure().is_none())
    }

    /// What it may do, if that is known.
    #[must_use]
    pub fn known_state(&self) -> Option<State> {
        self.is_heard().then(|| self.state())
    }

    /// What is wrong with it, if that is known.
    #[must_use]
    pub fn known_faults(&self) -> Option<FaultSet> {
        self.is_heard().then(|| self.faults())
    }

    /// Whether it holds its load; none if nobody has said so: a live leg does not report it.
    #[must_use]
    pub fn compensated(&self) -> Option<bool> {
        match self {
            Self::Simulated(leg) => Some(leg.compensated()),
            Self::Live(leg) => leg.compensated(),
        }
    }

    /// What was refused last, and what to do about it.
    #[must_use]
    pub fn refusal(&self) -> Option<&str> {
        match self {
            Self::Simulated(leg) => leg.refusal(),
            Self::Live(leg) => leg.refusal(),
        }
    }

    /// Why what is shown does not go on.
    #[must_use]
    pub fn failure(&self) -> Option<String> {
        match self {
            Self::Simulated(leg) => leg.failure().map(ToString::to_string),
            Self::Live(leg) => leg.failure(),
        }
    }

    /// From the joint's centre to the tip, m.
    #[must_use]
    pub fn tip_length_m(&self) -> f64 {
        let rig = &self.rig().parameters;
        rig.joint_length_m + rig.leg_length_m
    }

    /// Along it, as it is drawn: the true direction of a simulated leg, the estimated one of a live leg.
    #[must_use]
    pub fn leg_axis(&self) -> Vector3<f64> {
        match self {
            Self::Simulated(leg) => {
                let leg_axis = leg.leg().truth().direction.vector();
                Vector3::new(leg_axis.x, leg_axis.y, leg_axis.z)
            }
            Self::Live(_) => self.reported(|telemetry| telemetry.pose),
        }
    }

    /// Where its trajectory has it.
    #[must_use]
    pub fn reference(&self) -> Vector3<f64> {
        self.reported(|telemetry| telemetry.target)
    }

    fn reported(&self, direction: fn(&Telemetry<f32>) -> [f32; 2]) -> Vector3<f64> {
        seen_leg::leg_axis(self.telemetry().map_or([0.0; 2], direction).map(f64::from))
    }

    /// Where it was sent, as horizontal components; where it takes its target to be, if it was not.
    #[must_use]
    pub fn target(&self) -> [f64; 2] {
        match self {
            Self::Simulated(leg) => leg.target(),
            Self::Live(leg) => leg.target(),
        }
    }

    /// Where its tip was sent, m.
    #[must_use]
    pub fn commanded_m(&self) -> Vector3<f64> {
        seen_leg::leg_axis(self.target()) * self.tip_length_m()
    }

    /// Distance of the tip, as it is drawn, from where it was sent, mm.
    #[must_use]
    pub fn error_mm(&self) -> f64 {
        match self {
            Self::Simulated(leg) => leg.leg().comparison().commanded_error_mm(),
            Self::Live(_) => {
                let tip_m = self.leg_axis() * self.tip_length_m();
                1000.0 * (tip_m - self.commanded_m()).norm()
            }
        }
    }

    /// The tensions as they are drawn, N: the true ones of a simulated leg, the measured ones of a live leg.
    #[must_use]
    pub fn tensions_n(&self) -> [f64; 3] {
        match self {
            Self::Simulated(leg) => leg.leg().truth().tensions_n,
            Self::Live(leg) => leg
                .telemetry()
                .map_or([0.0; 3], |telemetry| telemetry.tensions_n.map(f64::from)),
        }
    }

    /// The payload for which the model is asked, kg: the true one, or the estimated one.
    #[must_use]
    pub fn payload_kg(&self) -> f64 {
        match self {
            Self::Simulated(leg) => leg.leg().truth().payload_kg,
            Self::Live(leg) => leg
                .telemetry()
                .map_or(0.0, |telemetry| f64::from(telemetry.payload_kg).max(0.0)),
        }
    }

    /// The push on a simulated leg that is going on.
    #[must_use]
    pub fn pushed(&self) -> Option<Push> {
        self.simulated().and_then(Simulation::pushed)
    }

    /// The leg as it is drawn: the true one of a simulated leg, by its sensors a live one.
    #[must_use]
    pub fn seen(&self) -> SeenLeg<'_> {
        let truth = self.simulated().map(|leg| leg.leg().truth());
        let cut = |tendon| {
            self.simulated()
                .is_some_and(|leg| leg.has(Defect::TendonCut(tendon)))
        };
        SeenLeg {
            rig: self.rig(),
            telemetry: self.telemetry().copied(),
            is_true: truth.is_some(),
            is_heard: self.is_heard(),
            leg_axis: self.leg_axis(),
            reference: self.reference(),
            target: self.target(),
            torsion_rad: truth.map_or(0.0, |truth| truth.torsion_rad),
            tensions_n: self.tensions_n(),
            // What a live leg estimates may be a push.
            hung_kg: truth.map(|truth| truth.payload_kg),
            cut: [0, 1, 2].map(cut),
            push: self.pushed(),
            error_mm: self.error_mm(),
        }
    }

    /// What is recorded of it, if it is.
    #[must_use]
    pub fn recorder(&self) -> Option<&Recorder> {
        match self {
            Self::Simulated(leg) => leg.recorder.as_ref(),
            Self::Live(leg) => leg.recorder.as_ref(),
        }
    }

    /// The same, to be begun and ended.
    pub fn recorder_mut(&mut self) -> &mut Option<Recorder> {
        match self {
            Self::Simulated(leg) => &mut leg.recorder,
            Self::Live(leg) => &mut leg.recorder,
        }
    }

    /// Asks for the codes of its sensors, which come in a later frame.
    pub fn ask_sensors(&mut self) {
        match self {
            Self::Simulated(leg) => leg.ask(&HostRequest::Sensors),
            Self::Live(leg) => leg.ask(Errand::Sensors),
        }
    }

    /// The codes that have come, once.
    pub fn take_sensors(&mut self) -> Option<Sensors> {
        match self {
            Self::Simulated(leg) => leg.questions_mut().take_sensors(),
            Self::Live(leg) => leg.board_mut().take_sensors(),
        }
    }

    /// Asks what the last jog saw, which comes in a later frame.
    pub fn ask_jog(&mut self) {
        match self {
            Self::Simulated(leg) => leg.ask(&HostRequest::JogReport),
            Self::Live(leg) => leg.ask(Errand::Jog),
        }
    }

    /// What the last jog saw, once.
    pub fn take_jog(&mut self) -> Option<JogReport<f32>> {
        match self {
            Self::Simulated(leg) => leg.questions_mut().take_jog(),
            Self::Live(leg) => leg.board_mut().take_jog(),
        }
    }
}
