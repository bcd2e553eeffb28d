//! A leg on a port, on CAN or on an emulated board, through `leg ui`: what it reported, and what it is asked.
//!
//! It is only watched until it is unlocked. While it follows commands it is told all the time that the page is there: a page that
//! is hidden, closed or stuck falls silent, and the leg then holds by itself.

pub mod board;
#[cfg(target_arch = "wasm32")]
pub mod browser_line;
pub mod frames;
pub mod line;
pub mod messages;
pub mod opening;
#[cfg(test)]
pub(crate) mod tests;

use crate::history::{History, Snapshot};
use crate::orders::{Order, Orders, refused};
use crate::recorder::Recorder;
use crate::wall_clock;
use board::Board;
use frames::{Frames, Numbers};
use leg_base::description::WITHOUT_HOST;
use leg_base::tick_time::seconds;
use leg_firmware::command::{Command, Compensation};
use leg_firmware::host_link::{HostId, HostRefusal, HostReply, TelemetryReport};
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use leg_rig::control_settings;
use leg_rig::rig_file::{RigFile, RigText};
use leg_sim::signals::{LegConstants, Report};
use line::{Heard, Line, Said};
use messages::{PageWord, Role, ServerWord};

/// From one sign of life to the next at least, s. The leg holds by itself after 0.2 s without one.
const ALIVE_S: f64 = 0.02;

/// Longest time from one frame of the window to the next, s: nobody sees what the leg does in one that stands still.
const FRAME_MAX_S: f64 = 0.5;

/// Time after which a leg that reports nothing is said not to answer, s.
const SILENCE_S: f64 = 1.0;

/// Time after which a command is taken for lost, s.
const ANSWER_S: f64 = 1.0;

/// The page, as the leg knows it: chosen at random, so that no two pages are taken for one.
#[derive(Clone, Copy, Debug)]
pub struct PageIdentity {
    /// As a host of the leg.
    pub host: HostId,
    /// Where the numbers of its requests begin.
    pub first_number: u16,
}

/// A live leg.
pub struct LiveLeg {
    line: Box<dyn Line>,
    name: String,
    source: RigText,
    rig: RigFile,
    board: Board,
    constants: LegConstants,
    frames: Frames,
    numbers: Numbers,
    host: HostId,
    role: Role,
    orders: Orders,
    /// When the last command was sent, s.
    sent_s: f64,
    alive_s: f64,
    /// When the last report came, s.
    heard_s: Option<f64>,
    now_s: f64,
    telemetry: Option<Telemetry<f32>>,
    history: History,
    commanded: Option<[f64; 2]>,
    compensation: Option<Compensation>,
    refusal: Option<String>,
    /// What is recorded of it, if it is.
    pub recorder: Option<Recorder>,
    /// Why nothing comes any more.
    lost: Option<String>,
}

impl LiveLeg {
    /// A leg of this name and with these settings at the other end of a line, which is not heard yet.
    #[must_use]
    pub fn new(line: Box<dyn Line>, page: PageIdentity, source: RigText, rig: RigFile) -> Self {
        let settings = control_settings::settings(&rig, &rig.gains, None);
        Self {
            line,
            name: source.name.clone(),
            source,
            constants: LegConstants::new(&settings),
            rig,
            board: Board::default(),
            frames: Frames::default(),
            numbers: Numbers::new(page.first_number),
            host: page.host,
            role: Role::default(),
            orders: Orders::default(),
            sent_s: 0.0,
            alive_s: 0.0,
            heard_s: None,
            now_s: 0.0,
            telemetry: None,
            history: History::live(),
            commanded: None,
            compensation: None,
            refusal: None,
            recorder: None,
            lost: None,
        }
    }

    /// Takes what has come until now, and sends what is due.
    pub fn advance(&mut self, now_s: f64) {
        self.now_s = now_s;
        self.heard_s.get_or_insert(now_s);
        self.listen();
        if self.orders.unanswered() && now_s - self.sent_s > ANSWER_S {
            self.orders = Orders::default();
            self.commanded = None;
            self.refusal = Some("the last command was not answered; command again".into());
        }
        self.look_at_board();
        self.show_life(now_s);
    }

    /// Takes what has come.
    fn listen(&mut self) {
        while let Some(heard) = self.line.heard() {
            match heard {
                Heard::Text(text) => self.take_word(&text),
                Heard::Bytes(bytes) => self.take_bytes(&bytes),
                Heard::Ended(why) => self.end(why),
            }
        }
    }

    fn take_word(&mut self, text: &str) {
        match ServerWord::new(text) {
            Some(ServerWord::Role(role)) => self.take_role(role),
            Some(ServerWord::Lost(why)) => self.end(why),
            // The leg is known already, and what is unknown is from a later version of the same protocol.
            Some(ServerWord::Hello(_)) | None => {}
        }
    }

    fn take_role(&mut self, role: Role) {
        if self.role.drives && !role.drives {
            self.orders = Orders::default();
            self.commanded = None;
        }
        self.role = role;
    }

    fn end(&mut self, why: String) {
        // The first reason is the cause of the others.
        self.lost.get_or_insert(why);
        self.take_role(Role::default());
    }

    fn take_bytes(&mut self, bytes: &[u8]) {
        for (number, reply) in self.frames.take(bytes) {
            if self.take_board_reply(number, &reply) {
                continue;
            }
            match (number, reply) {
                (_, HostReply::Telemetry(report)) => self.take_report(&report),
                (number, HostReply::Done) => self.take_answer(number, Ok(())),
                (number, HostReply::Refused(refusal)) => self.take_answer(number, Err(refusal)),
                _ => {}
            }
        }
    }

    fn take_report(&mut self, report: &TelemetryReport) {
        let telemetry = report.telemetry;
        if self
            .telemetry
            .is_some_and(|last| telemetry.tick < last.tick)
        {
            // Its board has started anew: time begins again.
            self.history = History::live();
            self.commanded = None;
            self.compensation = None;
        }
        // Also where another host homed it or sent it off.
        if matches!(telemetry.state, State::Homing | State::KeepingStation) {
            self.compensation = Some(Compensation::Estimated);
        }
        self.telemetry = Some(telemetry);
        self.heard_s = Some(self.now_s);
        let report = Report::new(&telemetry, &self.constants);
        let wall_time_s = wall_clock::system();
        let snapshot = Snapshot {
            report: report.received(wall_time_s.unwrap_or(f64::NAN), self.frames.damaged()),
            simulated: None,
        };
        let time_s = self.time_s();
        self.history.take(time_s, &snapshot);
        if let Some(recorder) = &mut self.recorder {
            recorder.take(time_s, telemetry.tick, wall_time_s, &snapshot);
        }
    }

    fn take_answer(&mut self, number: u16, result: Result<(), HostRefusal>) {
        let Some(order) = self.orders.answered(number) else {
            return;
        };
        match result {
            Ok(()) => self.note_done(order.command),
            Err(HostRefusal::Busy) => self.orders.repeat(order),
            Err(refusal) => {
                self.refusal = Some(refused(order.name, &refusal));
                self.commanded = None;
            }
        }
        self.send();
    }

    fn note_done(&mut self, command: Command) {
        self.refusal = None;
        match command {
            Command::Compensation(compensation) => self.compensation = Some(compensation),
            Command::Arm | Command::Clear | Command::Disarm | Command::Hold => {
                self.commanded = None;
            }
            _ => {}
        }
    }

    /// Commands it; `name` is what the window calls that. A locked leg is only stopped.
    pub fn command(&mut self, command: Command, name: &'static str) {
        if command == Command::Stop {
            self.orders = Orders::default();
            self.commanded = None;
            self.say(PageWord::Stop);
            return;
        }
        if self.locked().is_some() {
            return;
        }
        match command {
            Command::Move { x, y } => self.commanded = Some([x, y].map(f64::from)),
            Command::Home => self.commanded = Some([0.0; 2]),
            _ => {}
        }
        self.orders.take(Order { command, name });
        self.send();
    }

    /// Whether every command was answered.
    #[must_use]
    pub fn answered(&self) -> bool {
        self.orders.answered_all()
    }

    fn send(&mut self) {
        while let Some(order) = self.orders.next_to_send() {
            let number = self.request(order.command);
            self.orders.note_sent(number, order);
            self.sent_s = self.now_s;
        }
    }

    fn request(&mut self, command: Command) -> u16 {
        let number = self.numbers.next();
        if let Some(bytes) = frames::framed(number, self.host, command) {
            self.line.say(Said::Bytes(bytes));
        }
        number
    }

    /// Tells the leg that the page is there, unless the page stands still. Called between frames, too: a slow one must not hold the
    /// leg, not even one that has begun to follow since the last frame.
    pub fn show_life(&mut self, now_s: f64) {
        self.listen();
        let follows = self.telemetry.is_some_and(|last| last.state.follows());
        let still = now_s - self.now_s > FRAME_MAX_S;
        if self.role.drives && follows && !still && now_s - self.alive_s >= ALIVE_S {
            self.alive_s = now_s;
            self.request(Command::KeepAlive);
        }
    }

    fn say(&mut self, word: PageWord) {
        self.line.say(Said::Text(word.text()));
    }

    /// Asks to drive it, or to leave it to others.
    pub fn unlock(&mut self, unlock: bool) {
        self.say(if unlock {
            PageWord::Drive
        } else {
            PageWord::Release
        });
    }

    /// Who drives it.
    #[must_use]
    pub const fn role(&self) -> Role {
        self.role
    }

    /// Why it takes no command but a stop; none if it takes them.
    #[must_use]
    pub const fn locked(&self) -> Option<&'static str> {
        if self.lost.is_some() {
            Some("The connection to the leg is lost.")
        } else if self.role.drives {
            None
        } else if self.role.other_drives {
            Some("Another page drives this leg. STOP works all the same.")
        } else {
            Some("The leg is locked: unlock it first.")
        }
    }

    /// What it is on.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its settings.
    #[must_use]
    pub const fn rig(&self) -> &RigFile {
        &self.rig
    }

    /// The same as a rig file.
    #[must_use]
    pub const fn source(&self) -> &RigText {
        &self.source
    }

    /// What its signals were.
    #[must_use]
    pub const fn history(&self) -> &History {
        &self.history
    }

    /// What it reported last.
    #[must_use]
    pub const fn telemetry(&self) -> Option<&Telemetry<f32>> {
        self.telemetry.as_ref()
    }

    /// Time since its board started, s.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        self.telemetry
            .map_or(0.0, |telemetry| seconds(telemetry.tick.into()))
    }

    /// Where it was sent from here, as horizontal components; where it has its target, if it was not.
    #[must_use]
    pub fn target(&self) -> [f64; 2] {
        let reported = || {
            self.telemetry
                .map_or([0.0; 2], |telemetry| telemetry.target.map(f64::from))
        };
        self.commanded.unwrap_or_else(reported)
    }

    /// Whether it holds its load, as far as this page has said it.
    #[must_use]
    pub fn compensated(&self) -> Option<bool> {
        self.compensation
            .map(|compensation| compensation != Compensation::Off)
    }

    /// What was refused last, and what to do about it.
    #[must_use]
    pub fn refusal(&self) -> Option<&str> {
        self.refusal.as_deref()
    }

    /// Why nothing comes from it.
    #[must_use]
    pub fn failure(&self) -> Option<String> {
        if let Some(why) = &self.lost {
            return Some(format!(
                "The connection is lost: {why}. Without its host {WITHOUT_HOST}."
            ));
        }
        let silent = self.now_s - self.heard_s.unwrap_or(self.now_s) > SILENCE_S;
        silent.then(|| "The leg does not answer: look at its power and its cable.".into())
    }
}
