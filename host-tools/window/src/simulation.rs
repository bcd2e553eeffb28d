//! The leg in this window: firmware and simulated mechanism, stepped in real time.

mod acts;
mod questions;
mod start_error;
#[cfg(test)]
mod tests;

pub use questions::Questions;
pub use start_error::StartError;

use crate::history::{History, SAMPLE_HZ, Snapshot};
use crate::orders::{Order, Orders, refused};
use crate::pace::Pace;
use crate::recorder::Recorder;
use leg_firmware::command::{Command, Compensation};
use leg_firmware::drive::Drive;
use leg_firmware::host_link::HostRefusal;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::supervisor::{FaultSet, State};
use leg_firmware::telemetry::Telemetry;
use leg_rig::control_settings;
use leg_rig::plant_settings::PlantSettings;
use leg_rig::rig_file::{RigFile, RigText};
use leg_sim::emulated_leg::{EmulatedLeg, EmulationError};
use leg_sim::hosted_leg::HostedLeg;
use leg_sim::plant::Start;
use leg_sim::signals::{LegConstants, Report, Simulated};

/// Where the leg is when the window opens: as in the paper's Fig. 9, where a load shows most.
const START_AZIMUTH_DEG: f64 = 30.0;
const START_TILT_DEG: f64 = 30.0;

/// How far a leg that cannot lean so far leans at the start, as a part of its greatest tilt.
const START_PART: f64 = 0.99;

/// Time in which the leg comes to rest before the window opens, s.
const SETTLE_S: f64 = 1.0;

/// Every run of the window has the same noise.
const SEED: u64 = 1;

/// A push that is going on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// Where it pushes to, degrees.
    pub azimuth_deg: f64,
    /// N.
    pub force_n: f64,
    /// When it ends, s.
    pub until_s: f64,
}

/// A leg with its host, what is done to it, and what it was like in the last seconds.
pub struct Simulation {
    leg: HostedLeg,
    source: RigText,
    rig: RigFile,
    constants: LegConstants,
    motors: Drive<f32>,
    /// How fast it goes.
    pub pace: Pace,
    /// What its signals were.
    pub history: History,
    compensation: Compensation,
    payload_kg: f64,
    push: Option<Push>,
    orders: Orders,
    /// Why the last one was refused, if it was.
    refusal: Option<String>,
    /// What it was asked besides.
    questions: Questions,
    /// What is recorded of it, if it is.
    pub recorder: Option<Recorder>,
    /// Why the simulation cannot go on.
    failure: Option<EmulationError>,
}

impl Simulation {
    /// The paper's rig, armed and leaning, with its compensation off: it sags under what is hung on it.
    ///
    /// # Errors
    /// A rig that is refused; there is none as long as the ready rigs pass their tests.
    pub fn new() -> Result<Self, StartError> {
        Self::with_rig_file(RigText::load(None).map_err(StartError::Rig)?)
    }

    /// The same with the rig of a file.
    ///
    /// # Errors
    /// A rig that is refused, or that cannot be held where it starts.
    pub fn with_rig_file(source: RigText) -> Result<Self, StartError> {
        let (rig, _) = source.read().map_err(StartError::Rig)?;
        let tilt_deg = if rig.tilt_deg < START_TILT_DEG {
            START_PART * rig.tilt_deg
        } else {
            START_TILT_DEG
        };
        let start = Start::Held {
            azimuth_deg: START_AZIMUTH_DEG,
            tilt_deg,
            pretension_n: rig.pretension_n,
            payload_kg: 0.0,
        };
        let tared = PlantSettings {
            cell_offset_n: [0.0; 3],
            ..rig.plant
        };
        let leg = EmulatedLeg::start_in_process(&rig, &tared, start, SEED);
        let leg = leg.map_err(StartError::Emulation)?;
        let settings = control_settings::settings(&rig, &rig.gains, None);
        let mut simulation = Self {
            leg: HostedLeg::new(leg, &rig, start.direction(), SEED),
            constants: LegConstants::new(&settings),
            source,
            rig,
            motors: Drive {
                duty: [0.0; 3],
                enabled: false,
            },
            pace: Pace::default(),
            history: History::default(),
            compensation: Compensation::Estimated,
            payload_kg: 0.0,
            push: None,
            orders: Orders::default(),
            refusal: None,
            questions: Questions::default(),
            recorder: None,
            failure: None,
        };
        simulation.begin(tilt_deg);
        match simulation.failure.take() {
            Some(error) => Err(StartError::Emulation(error)),
            None => Ok(simulation),
        }
    }

    /// Boots the leg, arms it, and lets it come to rest.
    fn begin(&mut self, tilt_deg: f64) {
        while self.leg.state() == State::Boot && self.failure.is_none() {
            self.tick();
        }
        for (command, name) in [
            (Command::Arm, "arm"),
            (Command::Compensation(Compensation::Off), "compensation off"),
        ] {
            self.command(command, name);
            self.run(u32::from(TICK_HZ) / 100);
        }
        let direction = leg_base::angles::direction(START_AZIMUTH_DEG, tilt_deg);
        let [x, y] = direction.map(|part| part as f32);
        self.command(Command::Move { x, y }, "move");
        self.run((SETTLE_S * f64::from(TICK_HZ)) as u32);
    }

    /// Lets as much time pass as the clock says, bounded.
    pub fn advance(&mut self, elapsed_s: f64) {
        let ticks = self.pace.ticks(elapsed_s);
        self.run(ticks);
    }

    /// Lets so many ticks pass.
    pub fn run(&mut self, ticks: u32) {
        for _ in 0..ticks {
            if self.failure.is_some() {
                return;
            }
            self.tick();
        }
    }

    fn tick(&mut self) {
        let ticked = self.leg.tick();
        self.take_tick(ticked.map(|(_, reply)| reply.motors));
    }

    /// Goes on after a tick that gave the motors something, or failed.
    fn take_tick(&mut self, ticked: Result<Drive<f32>, EmulationError>) {
        match ticked {
            Ok(motors) => self.motors = motors,
            Err(error) => {
                self.failure = Some(error);
                return;
            }
        }
        self.look_at_answers();
        self.questions.take(self.leg.replies());
        if self
            .push
            .is_some_and(|push| push.until_s <= self.leg.time_s())
        {
            self.push = None;
        }
        if self
            .leg
            .ticks()
            .is_multiple_of(u64::from(u32::from(TICK_HZ) / SAMPLE_HZ))
        {
            self.sample();
        }
    }

    fn sample(&mut self) {
        if let Some(snapshot) = self.snapshot() {
            self.history.take(self.leg.time_s(), &snapshot);
            if let Some(recorder) = &mut self.recorder {
                let tick = snapshot.report.tick();
                recorder.take(self.leg.time_s(), tick, None, &snapshot);
            }
        }
    }

    /// The leg as it is now; none before its first tick.
    #[must_use]
    pub fn snapshot(&self) -> Option<Snapshot> {
        let telemetry = self.leg.telemetry()?;
        Some(Snapshot {
            report: Report::new(telemetry, &self.constants),
            simulated: Some(Simulated {
                truth: *self.leg.truth(),
                motors: self.motors,
                comparison: self.leg.comparison(),
            }),
        })
    }

    fn look_at_answers(&mut self) {
        for answer in self.leg.answers().to_vec() {
            let Some(order) = self.orders.answered(answer.number) else {
                continue;
            };
            match answer.result {
                Ok(()) => self.note_done(order.command),
                Err(HostRefusal::Busy) => self.orders.repeat(order),
                Err(refusal) => self.note_refused(&order, &refusal),
            }
            self.send();
        }
    }

    fn note_done(&mut self, command: Command) {
        self.refusal = None;
        match command {
            Command::Compensation(compensation) => self.compensation = compensation,
            // A leg that homes compensates.
            Command::Home => self.compensation = Compensation::Estimated,
            // The leg's target is where it is from now on, or there is none.
            Command::Arm | Command::Clear | Command::Disarm => self.leg.set_commanded(None),
            _ => {}
        }
    }

    fn note_refused(&mut self, order: &Order, refusal: &HostRefusal) {
        self.refusal = Some(refused(order.name, refusal));
        if matches!(order.command, Command::Move { .. } | Command::Home) {
            self.leg.set_commanded(None);
        }
    }

    /// Commands the leg; what becomes of it shows in later ticks. `name` is what the window calls it.
    pub fn command(&mut self, command: Command, name: &'static str) {
        self.orders.take(Order { command, name });
        self.send();
    }

    /// Whether every command was answered.
    #[must_use]
    pub fn answered(&self) -> bool {
        self.orders.answered_all()
    }

    /// Sends what may be sent now.
    fn send(&mut self) {
        while let Some(order) = self.orders.next_to_send() {
            match self.leg.send(&order.command) {
                Ok(number) => self.orders.note_sent(number, order),
                Err(error) => {
                    self.refusal = Some(format!("{} cannot be sent: {error}", order.name))
                }
            }
        }
        // The target on the screen is that of the newest command, sent or not.
        for order in self.orders.waiting() {
            match order.command {
                Command::Move { x, y } => self.leg.set_commanded(Some([x, y].map(f64::from))),
                Command::Home => self.leg.set_commanded(Some([0.0; 2])),
                Command::Hold => self.leg.set_commanded(None),
                _ => {}
            }
        }
    }

    /// The rig.
    #[must_use]
    pub const fn rig(&self) -> &RigFile {
        &self.rig
    }

    /// The file that describes it.
    #[must_use]
    pub const fn source(&self) -> &RigText {
        &self.source
    }

    /// The leg with its host.
    #[must_use]
    pub const fn leg(&self) -> &HostedLeg {
        &self.leg
    }

    /// Where it was sent, as horizontal components; where it takes its target to be, if it was not.
    #[must_use]
    pub fn target(&self) -> [f64; 2] {
        let target_m = self.leg.commanded_m() / self.leg.tip_length_m();
        [target_m.x, target_m.y]
    }

    /// What it reported last.
    #[must_use]
    pub fn telemetry(&self) -> Option<&Telemetry<f32>> {
        self.leg.telemetry()
    }

    /// What it may do.
    #[must_use]
    pub fn state(&self) -> State {
        self.leg.state()
    }

    /// What is wrong with it.
    #[must_use]
    pub fn faults(&self) -> FaultSet {
        self.telemetry()
            .map_or(FaultSet::NONE, |telemetry| telemetry.faults)
    }

    /// Whether it holds its load.
    #[must_use]
    pub fn compensated(&self) -> bool {
        self.compensation != Compensation::Off
    }

    /// The payload that was hung on it last, kg.
    #[must_use]
    pub const fn payload_kg(&self) -> f64 {
        self.payload_kg
    }

    /// What was refused last, and what to do about it.
    #[must_use]
    pub fn refusal(&self) -> Option<&str> {
        self.refusal.as_deref()
    }

    /// Why it cannot go on.
    #[must_use]
    pub const fn failure(&self) -> Option<&EmulationError> {
        self.failure.as_ref()
    }
}
