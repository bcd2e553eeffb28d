//! What a live leg's board is asked besides commands: its settings, read, replaced and kept; its sensors; what a jog saw.
//!
//! One thing is asked at a time. Only the page that drives asks; what is answered is heard by every page.

use super::line::Said;
use super::{LiveLeg, frames};
use crate::orders::refused;
use leg_firmware::host_link::{HostReply, HostRequest};
use leg_firmware::jog::JogReport;
use leg_firmware::sensors::Sensors;
use leg_firmware::settings::Settings;
use leg_rig::control_settings;
use leg_rig::rig_file::RigText;
use leg_rig::settings_difference::setting_differences;
use leg_rig::settings_text;
use leg_sim::signals::LegConstants;

/// Time after which an answer is taken for lost, s: a board takes the longest to erase a page of its flash.
const ANSWER_S: f64 = 1.5;
const SAVE_S: f64 = 4.0;

/// Settings that are named of those that differ.
const NAMED_MAX: usize = 4;

/// What the board is asked.
#[derive(Clone, Debug)]
pub enum Errand {
    /// Its settings.
    Read,
    /// To take other ones, and then to be read and compared.
    Write(Box<Settings>),
    /// Its settings, which have to be these.
    Compare(Box<Settings>),
    /// To keep them over a reset.
    Save,
    /// The codes of its sensors.
    Sensors,
    /// What the last jog saw.
    Jog,
}

impl Errand {
    fn request(&self) -> HostRequest {
        match self {
            Self::Read | Self::Compare(_) => HostRequest::GetSettings,
            Self::Write(settings) => HostRequest::SetSettings((**settings).clone()),
            Self::Save => HostRequest::SaveSettings,
            Self::Sensors => HostRequest::Sensors,
            Self::Jog => HostRequest::JogReport,
        }
    }

    const fn name(&self) -> &'static str {
        match self {
            Self::Read => "reading the settings",
            Self::Write(_) => "setting the board",
            Self::Compare(_) => "reading the settings back",
            Self::Save => "keeping the settings",
            Self::Sensors => "reading the sensors",
            Self::Jog => "reading what the jog saw",
        }
    }

    /// Whether it changes something on the board.
    const fn changes(&self) -> bool {
        matches!(self, Self::Write(_) | Self::Save)
    }

    const fn patience_s(&self) -> f64 {
        if self.changes() { SAVE_S } else { ANSWER_S }
    }
}

/// An errand on its way.
#[derive(Debug)]
struct Asked {
    number: u16,
    errand: Errand,
    at_s: f64,
}

/// What the board was asked, and what came of it.
#[derive(Debug, Default)]
pub struct Board {
    asked: Option<Asked>,
    told: Option<Result<String, String>>,
    /// How often its settings have come.
    settings_seen: u64,
    /// How often this page has read them.
    settings_read: u64,
    sensors: Option<Sensors>,
    jog: Option<JogReport<f32>>,
}

impl Board {
    /// What it is busy with.
    #[must_use]
    pub fn busy(&self) -> Option<&'static str> {
        self.asked.as_ref().map(|asked| asked.errand.name())
    }

    /// What became of what it was asked last.
    #[must_use]
    pub fn told(&self) -> Option<Result<&str, &str>> {
        let told = self.told.as_ref()?;
        Some(told.as_ref().map(String::as_str).map_err(String::as_str))
    }

    /// How often its settings have come, whoever asked, and how often this page has read them.
    #[must_use]
    pub const fn settings_seen(&self) -> [u64; 2] {
        [self.settings_seen, self.settings_read]
    }

    /// The codes that have come, once.
    pub const fn take_sensors(&mut self) -> Option<Sensors> {
        self.sensors.take()
    }

    /// What the last jog saw, once.
    pub const fn take_jog(&mut self) -> Option<JogReport<f32>> {
        self.jog.take()
    }
}

impl LiveLeg {
    /// What its board was asked.
    #[must_use]
    pub const fn board(&self) -> &Board {
        &self.board
    }

    /// The same, to take its answers.
    pub const fn board_mut(&mut self) -> &mut Board {
        &mut self.board
    }

    /// Why the board cannot be asked that now; none if it can.
    #[must_use]
    pub fn board_locked(&self, changes: bool) -> Option<&'static str> {
        if let Some(words) = self.locked() {
            return Some(words);
        }
        if self.board.asked.is_some() {
            return Some("The board is still busy with what it was asked before.");
        }
        let driven = self.telemetry.is_none_or(|last| last.state.driven());
        (changes && driven)
            .then_some("Settings change and are kept only while the drivers are off: Disarm first.")
    }

    /// Asks the board. What it may not be asked now is not.
    pub fn ask(&mut self, errand: Errand) {
        if self.board_locked(errand.changes()).is_none() {
            self.send_errand(errand);
        }
    }

    fn send_errand(&mut self, errand: Errand) {
        let number = self.numbers.next();
        let Some(bytes) = frames::framed_request(number, &errand.request()) else {
            self.tell(Err("The settings are too long for a message.".into()));
            return;
        };
        self.line.say(Said::Bytes(bytes));
        self.board.told = None;
        self.board.asked = Some(Asked {
            number,
            errand,
            at_s: self.now_s,
        });
    }

    fn tell(&mut self, told: Result<String, String>) {
        self.board.told = Some(told);
    }

    /// Ends what is not answered.
    pub(super) fn look_at_board(&mut self) {
        let lost = self.lost.is_some();
        let late = |asked: &Asked| lost || self.now_s - asked.at_s > asked.errand.patience_s();
        if self.board.asked.as_ref().is_some_and(late)
            && let Some(asked) = self.board.asked.take()
        {
            let remedy = if asked.errand.changes() {
                "read its settings to see whether it was done"
            } else {
                "ask it again"
            };
            let words = format!(
                "The board has not answered ({}): {remedy}.",
                asked.errand.name()
            );
            self.tell(Err(words));
        }
    }

    /// Takes a reply to what the board was asked. False for one to something else.
    pub(super) fn take_board_reply(&mut self, number: u16, reply: &HostReply) -> bool {
        // What another page or program reads is news here, too.
        if let HostReply::Settings(settings) = reply {
            self.adopt(settings);
        }
        let ours = self.board.asked.take_if(|asked| asked.number == number);
        let Some(Asked { errand, .. }) = ours else {
            return matches!(reply, HostReply::Settings(_));
        };
        match (errand, reply) {
            (Errand::Read, HostReply::Settings(_)) => {
                self.board.settings_read += 1;
                self.tell(Ok("Read from the board.".into()));
            }
            (Errand::Compare(wanted), HostReply::Settings(found)) => {
                self.tell(compared(&wanted, found));
            }
            (Errand::Write(settings), HostReply::Done) => {
                self.send_errand(Errand::Compare(settings));
            }
            (Errand::Save, HostReply::Done) => {
                self.tell(Ok(
                    "Kept over a reset; an emulated board keeps nothing when it ends.".into(),
                ));
            }
            (Errand::Sensors, HostReply::Sensors(sensors)) => {
                self.board.sensors = Some(sensors.codes)
            }
            (Errand::Jog, HostReply::Jog(report)) => self.board.jog = *report,
            (errand, HostReply::Refused(refusal)) => {
                self.tell(Err(refused(errand.name(), refusal)));
            }
            (errand, _) => self.tell(Err(format!(
                "The board answered something else ({}).",
                errand.name()
            ))),
        }
        true
    }

    /// Shows the leg with the settings that its board has.
    fn adopt(&mut self, settings: &Settings) {
        let source = RigText {
            name: self.name.clone(),
            text: settings_text::rig_file(settings),
        };
        // What a board has in use was checked by it.
        let Ok((rig, _)) = source.read() else { return };
        let settings = control_settings::settings(&rig, &rig.gains, None);
        self.constants = LegConstants::new(&settings);
        self.rig = rig;
        self.source = source;
        self.board.settings_seen += 1;
    }
}

fn compared(wanted: &Settings, found: &Settings) -> Result<String, String> {
    let differences = setting_differences(wanted, found);
    if differences.is_empty() {
        return Ok("Set, read back and found the same. Home the leg before it is armed.".into());
    }
    let names = differences.iter().take(NAMED_MAX).map(|found| &*found.name);
    Err(format!(
        "The board has other values than it was given: {}. Set it again.",
        names.collect::<Vec<_>>().join(", ")
    ))
}
