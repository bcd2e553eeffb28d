//! A simulated leg that is commanded and stepped: tick by tick, without the interpreter's lock.

use crate::signal_log::SignalLog;
use crate::signals::Snapshot;
use leg_base::longest_times::{longest_disarm, longest_homing, longest_move};
use leg_base::settling::Settling;
use leg_base::timed_path::TimedPath;
use leg_firmware::command::{Command, CommandRefusal, Compensation};
use leg_firmware::drive::Drive;
use leg_firmware::frame::FrameError;
use leg_firmware::host_link::HostRefusal;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::set_point::PointRefusal;
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::{FaultSet, State};
use leg_host::signals::LegConstants;
use leg_rig::control_settings;
use leg_rig::plant_settings::PlantSettings;
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::{EmulatedLeg, EmulationError};
use leg_sim::hosted_leg::HostedLeg;
use leg_sim::path_sender::PathSender;
use leg_sim::plant::Start;
use pyo3::PyErr;

/// Ticks within which a command is answered: a leg that brakes executes none until it stands. 1 s.
const ANSWER_TICKS: u32 = TICK_HZ as u32;

/// Ticks from one look at a leg that settles to the next: 10 ms, what [`Settling`] compares.
const LOOK_TICKS: u64 = TICK_HZ as u64 / 100;

/// Ticks from one look for Ctrl-C to the next: about a tenth of a second of this machine's time.
const INTERRUPT_TICKS: u64 = 40_000;

/// Why a leg did not do what it was asked.
#[derive(Debug)]
pub enum SessionError {
    /// The simulation cannot go on.
    Emulation(EmulationError),
    /// The command cannot be sent.
    Frame(FrameError),
    /// The leg refuses a command.
    Refused(HostRefusal),
    /// Nothing came back.
    NoAnswer,
    /// A point of a path is refused: its time, s, and why.
    Point(f64, PointRefusal),
    /// Faults keep the leg from it.
    Faulted(FaultSet, State),
    /// It came to another state, and no fault says why.
    NotFollowing(State),
    /// It was not done in time: what, and how long was waited, s.
    TimedOut(&'static str, f64),
    /// There is no room for more of a recording.
    RecordingFull,
    /// The user ended it.
    Interrupted(PyErr),
}

impl From<EmulationError> for SessionError {
    fn from(error: EmulationError) -> Self {
        Self::Emulation(error)
    }
}

type Result<T> = std::result::Result<T, SessionError>;

/// A simulated leg, its host, and what is recorded of it.
#[derive(Clone)]
pub struct Session {
    leg: HostedLeg,
    settings: Settings,
    constants: LegConstants,
    motors: Drive<f32>,
    /// Whether the leg holds its load.
    compensated: bool,
    /// The path that is being sent.
    path: Option<PathSender>,
    signal_log: Option<SignalLog>,
    /// Fails if the user wants an end.
    interrupted: fn() -> std::result::Result<(), PyErr>,
}

impl Session {
    /// A leg of a rig at a start, which has booted. Its noise follows from the seed. One with a zero has its load cells tared.
    pub fn new(
        rig: &RigFile,
        start: Start,
        seed: u64,
        interrupted: fn() -> std::result::Result<(), PyErr>,
    ) -> Result<Self> {
        let plant = if start.is_slack() {
            rig.plant
        } else {
            PlantSettings {
                cell_offset_n: [0.0; 3],
                ..rig.plant
            }
        };
        let leg = EmulatedLeg::start_in_process(rig, &plant, start, seed)?;
        let settings = control_settings::settings(rig, &rig.gains, None);
        let mut session = Self {
            leg: HostedLeg::new(leg, rig, start.direction(), seed),
            constants: LegConstants::new(&settings),
            settings,
            motors: Drive {
                duty: [0.0; 3],
                enabled: false,
            },
            compensated: true,
            path: None,
            signal_log: None,
            interrupted,
        };
        while session.leg.state() == State::Boot {
            session.tick()?;
        }
        Ok(session)
    }

    /// The leg with its host.
    pub fn leg(&self) -> &HostedLeg {
        &self.leg
    }

    /// What its reports need of its settings.
    pub fn constants(&self) -> &LegConstants {
        &self.constants
    }

    /// The same, for what is done to it from outside.
    pub fn leg_mut(&mut self) -> &mut HostedLeg {
        &mut self.leg
    }

    /// What is recorded.
    pub fn signal_log(&self) -> Option<&SignalLog> {
        self.signal_log.as_ref()
    }

    /// Records from now on; what was recorded before is forgotten.
    pub fn record(&mut self, signal_log: Option<SignalLog>) {
        self.signal_log = signal_log;
    }

    /// The leg now. There is one: it has booted.
    pub fn snapshot(&self) -> Option<Snapshot> {
        Snapshot::new(&self.leg, &self.constants, &self.motors, self.is_on_path())
    }

    /// Some ticks.
    pub fn step(&mut self, ticks: u64) -> Result<()> {
        for _ in 0..ticks {
            self.tick()?;
        }
        Ok(())
    }

    fn tick(&mut self) -> Result<()> {
        self.send_points()?;
        let (_, reply) = self.leg.tick()?;
        self.motors = reply.motors;
        self.note_commanded();
        self.take_row()?;
        self.look_at_points()?;
        if self.leg.ticks().is_multiple_of(INTERRUPT_TICKS) {
            (self.interrupted)().map_err(SessionError::Interrupted)?;
        }
        Ok(())
    }

    /// Records the tick, if a row is due.
    fn take_row(&mut self) -> Result<()> {
        let Some(signal_log) = &mut self.signal_log else {
            return Ok(());
        };
        if !signal_log.due() {
            return Ok(());
        }
        let on_path = is_on_path(self.path.as_ref(), &self.leg);
        let snapshot = Snapshot::new(&self.leg, &self.constants, &self.motors, on_path);
        if snapshot.is_some_and(|snapshot| !signal_log.take(&snapshot)) {
            self.signal_log = None;
            return Err(SessionError::RecordingFull);
        }
        Ok(())
    }

    /// Sends the points of the path that are due.
    fn send_points(&mut self) -> Result<()> {
        let (Some(path), Some(telemetry)) = (&mut self.path, self.leg.telemetry().copied()) else {
            return Ok(());
        };
        for command in path.due(&telemetry) {
            self.leg.send(&command).map_err(SessionError::Frame)?;
        }
        Ok(())
    }

    /// Notes where the path has the leg now, and whether it is over and the leg rests.
    fn note_commanded(&mut self) {
        let (Some(path), Some(telemetry)) = (&self.path, self.leg.telemetry().copied()) else {
            return;
        };
        let Some(time_s) = path.time_s(&telemetry) else {
            return;
        };
        let over = path.is_over(time_s);
        if over || path.motion(time_s).is_some() {
            // After its end the leg comes to rest where it may.
            let at = path.motion(time_s).map(|at| at.position);
            self.leg.set_commanded(at);
        }
        if over && !telemetry.moving {
            self.path = None;
        }
    }

    /// Gives a path up if one of its points was refused, or the leg follows no commands any more: a fault does not raise an
    /// error by itself.
    fn look_at_points(&mut self) -> Result<()> {
        let Some(path) = &self.path else {
            return Ok(());
        };
        let telemetry = self.leg.telemetry();
        let time_s = telemetry.and_then(|telemetry| path.time_s(telemetry));
        let mut refusals = self.leg.answers().iter().filter_map(|a| a.result.err());
        let refused = refusals.next();
        let follows = self.leg.state().follows();
        if follows && refused.is_none() {
            return Ok(());
        }
        self.leave_path();
        match refused {
            // What ended it shows in its state and its faults.
            _ if !follows => Ok(()),
            Some(HostRefusal::Command(CommandRefusal::Point(refusal))) => {
                Err(SessionError::Point(time_s.unwrap_or(0.0), refusal))
            }
            Some(refusal) => Err(SessionError::Refused(refusal)),
            None => Ok(()),
        }
    }

    /// Commands the leg, and lets it tick until it has obeyed or refused.
    pub fn command(&mut self, command: &Command) -> Result<()> {
        let number = self.leg.send(command).map_err(SessionError::Frame)?;
        for _ in 0..ANSWER_TICKS {
            self.tick()?;
            let mut answers = self.leg.answers().iter();
            let Some(answer) = answers.find(|answer| answer.number == number) else {
                continue;
            };
            return match answer.result {
                Ok(()) => {
                    match command {
                        Command::Compensation(compensation) => {
                            self.compensated = *compensation != Compensation::Off;
                        }
                        // A leg that homes compensates.
                        Command::Home => self.compensated = true,
                        _ => {}
                    }
                    Ok(())
                }
                Err(HostRefusal::Command(CommandRefusal::Faulted)) => {
                    Err(SessionError::Faulted(self.faults(), self.leg.state()))
                }
                Err(refusal) => Err(SessionError::Refused(refusal)),
            };
        }
        Err(SessionError::NoAnswer)
    }

    /// Gives up a path that is followed: another command takes its place.
    pub fn leave_path(&mut self) {
        if self.path.take().is_some() {
            self.leg.set_commanded(None);
        }
    }

    /// Sends the leg along a path: to its run-up first. What becomes of it shows in later ticks.
    pub fn follow(&mut self, path: TimedPath) -> Result<()> {
        let sender = PathSender::new(path, true, &self.settings);
        let sender = sender.map_err(|(time_s, refusal)| SessionError::Point(time_s, refusal))?;
        self.leave_path();
        self.command(&sender.approach())?;
        self.path = Some(sender);
        Ok(())
    }

    /// Longest move, with all that belongs to it, by the leg's settings, s.
    pub fn move_s(&self) -> f64 {
        longest_move(&self.settings).as_secs_f64()
    }

    /// The same of a disarm.
    pub fn disarm_s(&self) -> f64 {
        longest_disarm(&self.settings).as_secs_f64()
    }

    /// The same of a homing.
    pub fn homing_s(&self) -> f64 {
        longest_homing(&self.settings).as_secs_f64()
    }

    /// Whether a path is followed, the way to its start included.
    pub fn following(&self) -> bool {
        self.path.is_some()
    }

    fn is_on_path(&self) -> bool {
        is_on_path(self.path.as_ref(), &self.leg)
    }

    /// Lets the leg tick until it has been for 0.3 s where it shall be, at the end of its path.
    pub fn settle(&mut self, timeout_s: f64) -> Result<()> {
        let mut settling = if self.compensated {
            Settling::default()
        } else {
            Settling::uncompensated()
        };
        self.wait("come to rest where it shall be", timeout_s, |session| {
            session.require_following()?;
            let telemetry = session.leg.telemetry();
            let settled = telemetry.is_some_and(|telemetry| settling.take(telemetry));
            Ok(settled && session.path.is_none())
        })?;
        let limits = self.reported().limits();
        if limits.any() {
            return Err(SessionError::Faulted(limits, self.leg.state()));
        }
        Ok(())
    }

    /// Lets the leg tick until it is in a state.
    pub fn reach(&mut self, state: State, what: &'static str, timeout_s: f64) -> Result<()> {
        self.wait(what, timeout_s, |session| {
            let now = session.leg.state();
            let faults = session.faults();
            if now != state && faults.any() {
                return Err(SessionError::Faulted(faults, now));
            }
            Ok(now == state)
        })
    }

    fn wait(
        &mut self,
        what: &'static str,
        timeout_s: f64,
        mut done: impl FnMut(&Self) -> Result<bool>,
    ) -> Result<()> {
        let until_s = self.leg.time_s() + timeout_s;
        while !done(self)? {
            if self.leg.time_s() >= until_s {
                return Err(SessionError::TimedOut(what, timeout_s));
            }
            self.step(LOOK_TICKS)?;
        }
        Ok(())
    }

    /// Fails if the leg does not follow commands, with the reason.
    fn require_following(&self) -> Result<()> {
        let state = self.leg.state();
        if state.follows() {
            return Ok(());
        }
        let faults = self.faults();
        Err(if faults.any() {
            SessionError::Faulted(faults, state)
        } else {
            SessionError::NotFollowing(state)
        })
    }

    /// Faults that do more than limit.
    fn faults(&self) -> FaultSet {
        self.reported().stopping()
    }

    /// Every fault that is reported.
    pub fn reported(&self) -> FaultSet {
        let telemetry = self.leg.telemetry();
        telemetry.map_or(FaultSet::NONE, |telemetry| telemetry.faults)
    }
}

/// Whether a leg is on a path, not on the way to it or to rest after it.
fn is_on_path(path: Option<&PathSender>, leg: &HostedLeg) -> bool {
    let at = |(path, telemetry): (&PathSender, _)| path.motion(path.time_s(telemetry)?);
    path.zip(leg.telemetry()).and_then(at).is_some()
}
