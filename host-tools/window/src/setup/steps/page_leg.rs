//! The leg that is measured, as a page asks it: what is asked goes out after a look at the leg, and is answered by a later one.

use leg_base::description::{self, remedies_and_clear};
use leg_base::failure::Failure;
use leg_base::longest_times::{longest_homing, longest_move};
use leg_base::settling::{Settling, same_direction};
use leg_firmware::command::{Command, Compensation};
use leg_firmware::jog::{JogDemand, JogReport};
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::{FaultSet, State};
use leg_firmware::telemetry::Telemetry;
use leg_rig::tune::{LegError, TunedLeg};
use std::cell::RefCell;
use std::future::poll_fn;
use std::rc::Rc;
use std::task::Poll;
use std::time::Duration;

/// The longest times that things take, s of the leg.
const RELAXING_S: f64 = 30.0;
const JOG_S: f64 = 120.0;
const INTERRUPTED_S: f64 = 5.0;

/// What a page asks a leg.
#[derive(Clone, Copy, Debug)]
pub(super) enum LegRequest {
    /// To do something, which is called so.
    Command(Command, &'static str),
    /// What the last jog saw.
    JogReport,
}

/// What passes between the leg and what measures it.
#[derive(Debug, Default)]
pub(super) struct Mailbox {
    /// What it reported, once.
    pub report: Option<Telemetry<f32>>,
    /// Whether it has answered every command.
    pub answered: bool,
    /// What it has refused.
    pub refusal: Option<String>,
    /// What the last jog saw, once.
    pub jog: Option<JogReport<f32>>,
    /// Why nothing comes from it any more.
    pub failure: Option<String>,
    /// What it is asked.
    pub wishes: Vec<LegRequest>,
}

/// Why it did not do what it was asked.
#[derive(Debug)]
pub(super) enum PageError {
    Faulted(&'static str, FaultSet),
    Stopped(&'static str, State),
    Refused(String),
    Lost(String),
    TimedOut(&'static str),
    OtherPose,
}

impl LegError for PageError {
    fn faulted(asked: &'static str, telemetry: &Telemetry<f32>) -> Self {
        Self::Faulted(asked, telemetry.faults)
    }

    fn stopped(asked: &'static str, state: State) -> Self {
        Self::Stopped(asked, state)
    }

    fn failure(&self) -> Failure {
        match self {
            Self::Faulted(asked, faults) => Failure::failed(
                format!(
                    "to {asked} was ended by a fault: {}",
                    description::faults(*faults)
                ),
                format!(
                    "{}; then disarm, and measure again",
                    remedies_and_clear(*faults, "Clear")
                ),
            ),
            Self::Stopped(asked, state) => Failure::failed(
                format!(
                    "to {asked} was stopped: the leg is {}",
                    description::state(*state)
                ),
                "disarm the leg, and measure again",
            ),
            Self::Refused(words) => {
                Failure::failed(words.clone(), "disarm the leg, and measure again")
            }
            Self::Lost(words) => {
                Failure::failed(words.clone(), "see that the leg answers, and measure again")
            }
            Self::TimedOut(asked) => Failure::failed(
                format!("to {asked} takes too long"),
                "see that nothing touches the leg, and measure again",
            ),
            Self::OtherPose => Failure::failed(
                "the leg does not come to hang straight down",
                "see that nothing touches the leg, and measure again",
            ),
        }
    }
}

/// The leg.
pub(super) struct PageLeg {
    mailbox: Rc<RefCell<Mailbox>>,
    /// Longest homing and move by its settings, s.
    homing_s: f64,
    move_s: f64,
}

type Result<T> = std::result::Result<T, PageError>;

impl PageLeg {
    pub(super) fn new(mailbox: Rc<RefCell<Mailbox>>, settings: &Settings) -> Self {
        Self {
            mailbox,
            homing_s: longest_homing(settings).as_secs_f64(),
            move_s: longest_move(settings).as_secs_f64(),
        }
    }

    /// What it reports next.
    async fn report(&self) -> Result<Telemetry<f32>> {
        poll_fn(|_| {
            let mut mailbox = self.mailbox.borrow_mut();
            if let Some(words) = &mailbox.failure {
                return Poll::Ready(Err(PageError::Lost(words.clone())));
            }
            let report = mailbox.report.take();
            report.map_or(Poll::Pending, |report| Poll::Ready(Ok(report)))
        })
        .await
    }

    fn wish(&self, wish: LegRequest) {
        self.mailbox.borrow_mut().wishes.push(wish);
    }

    async fn command(&self, command: Command, name: &'static str) -> Result<()> {
        self.wish(LegRequest::Command(command, name));
        loop {
            self.report().await?;
            let mailbox = self.mailbox.borrow();
            if mailbox.answered {
                let refusal = mailbox.refusal.clone();
                return refusal.map_or(Ok(()), |words| Err(PageError::Refused(words)));
            }
        }
    }

    /// Waits until `done` says so.
    async fn wait(
        &self,
        asked: &'static str,
        longest_s: f64,
        mut done: impl FnMut(&Telemetry<f32>) -> Result<bool>,
    ) -> Result<Telemetry<f32>> {
        let first = self.report().await?;
        let mut report = first;
        while !done(&report)? {
            if report.tick.wrapping_sub(first.tick) > ticks(longest_s) {
                return Err(PageError::TimedOut(asked));
            }
            report = self.report().await?;
        }
        Ok(report)
    }

    /// The same of a leg that follows commands all the while.
    async fn follow(
        &self,
        asked: &'static str,
        longest_s: f64,
        mut done: impl FnMut(&Telemetry<f32>) -> bool,
    ) -> Result<Telemetry<f32>> {
        let followed = |report: &Telemetry<f32>| {
            if report.state.follows() {
                Ok(done(report))
            } else {
                Err(not_following(asked, report))
            }
        };
        self.wait(asked, longest_s, followed).await
    }

    async fn settle(&self, asked: &'static str) -> Result<Telemetry<f32>> {
        let mut settling = Settling::default();
        self.follow(asked, self.move_s, |report| settling.take(report))
            .await
    }

    /// Waits while it starts or relaxes, and refuses one with a fault.
    async fn settle_state(&self, asked: &'static str) -> Result<Telemetry<f32>> {
        let still =
            |report: &Telemetry<f32>| Ok(!matches!(report.state, State::Boot | State::RampingDown));
        let report = self.wait(asked, RELAXING_S, still).await?;
        let faults = report.faults.stopping();
        if faults.any() {
            return Err(PageError::Faulted(asked, faults));
        }
        Ok(report)
    }

    /// Makes a homed leg follow commands.
    async fn activate(&self, asked: &'static str) -> Result<()> {
        match self.settle_state(asked).await?.state {
            State::Disarmed => {
                self.compensate().await?;
                self.command(Command::Arm, "arm").await?;
                self.settle(asked).await?;
            }
            State::KeepingStation => self.command(Command::Arm, "arm").await?,
            State::Held | State::Off => {
                self.compensate().await?;
                self.command(Command::Clear, "clear").await?;
            }
            _ => {}
        }
        Ok(())
    }

    /// A leg whose load is left out is measured with it.
    async fn compensate(&self) -> Result<()> {
        let compensated = Command::Compensation(Compensation::Estimated);
        self.command(compensated, "compensation on").await
    }
}

fn ticks(time_s: f64) -> u32 {
    (time_s * f64::from(TICK_HZ)) as u32
}

fn not_following(asked: &'static str, report: &Telemetry<f32>) -> PageError {
    let faults = report.faults.stopping();
    if faults.any() {
        PageError::Faulted(asked, faults)
    } else {
        PageError::Stopped(asked, report.state)
    }
}

impl TunedLeg for PageLeg {
    type Error = PageError;

    async fn telemetry(&mut self) -> Result<Telemetry<f32>> {
        self.report().await
    }

    async fn telemetry_after(&mut self, _: Option<&PageError>) -> Option<Telemetry<f32>> {
        self.report().await.ok()
    }

    async fn jog(&mut self, demand: &JogDemand) -> Result<(JogReport<f32>, Telemetry<f32>)> {
        let asked = "jog a motor";
        self.settle_state(asked).await?;
        self.command(Command::Jog(*demand), "jog").await?;
        let rests = |report: &Telemetry<f32>| Ok(report.state != State::Jogging);
        let telemetry = self.wait(asked, JOG_S, rests).await?;
        // What an earlier jog saw is not asked for.
        self.mailbox.borrow_mut().jog = None;
        loop {
            self.wish(LegRequest::JogReport);
            self.report().await?;
            if let Some(report) = self.mailbox.borrow_mut().jog.take() {
                return Ok((report, telemetry));
            }
        }
    }

    async fn home(&mut self) -> Result<()> {
        let asked = "home";
        let state = self.settle_state(asked).await?.state;
        if matches!(state, State::Held | State::KeepingStation) {
            self.command(Command::Disarm, "disarm").await?;
            let off =
                |report: &Telemetry<f32>| Ok(matches!(report.state, State::Disarmed | State::Off));
            self.wait(asked, RELAXING_S, off).await?;
        }
        self.command(Command::Home, "home").await?;
        self.follow(asked, self.homing_s, |report| report.state == State::Active)
            .await?;
        self.settle(asked).await?;
        self.stop().await
    }

    async fn hang_straight(&mut self, pretension_n: f32) -> Result<()> {
        let asked = "change the pretension";
        self.activate(asked).await?;
        self.command(Command::Pretension(pretension_n), "pretension")
            .await?;
        self.command(Command::Move { x: 0.0, y: 0.0 }, "move")
            .await?;
        let report = self.settle(asked).await?;
        let limits = report.faults.limits();
        if limits.any() {
            return Err(PageError::Faulted(asked, limits));
        }
        if same_direction(&report.target, &[0.0; 2]) {
            Ok(())
        } else {
            Err(PageError::OtherPose)
        }
    }

    async fn interrupt(
        &mut self,
        command: Command,
        passed: &mut dyn FnMut(&Telemetry<f32>) -> bool,
        time: Duration,
    ) -> Result<Vec<Telemetry<f32>>> {
        let asked = "swing";
        self.activate(asked).await?;
        self.command(command, asked).await?;
        let mut recorded = Vec::new();
        let keep = |report: &Telemetry<f32>| {
            recorded.push(*report);
            Ok(passed(report) || report.state != State::Active)
        };
        self.wait(asked, INTERRUPTED_S, keep).await?;
        self.wish(LegRequest::Command(Command::Stop, "stop"));
        let longest_s = time.as_secs_f64();
        let mut first = None;
        let keep = |report: &Telemetry<f32>| {
            recorded.push(*report);
            let first = *first.get_or_insert(report.tick);
            Ok(report.tick.wrapping_sub(first) >= ticks(longest_s))
        };
        let last = self.wait(asked, 2.0 * longest_s, keep).await?;
        if last.state == State::Held && !last.faults.stopping().any() {
            Ok(recorded)
        } else {
            Err(not_following(asked, &last))
        }
    }

    async fn stop(&mut self) -> Result<()> {
        self.command(Command::Stop, "stop").await
    }
}
