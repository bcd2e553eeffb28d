//! Recordings that are made here, and those that are given to the window.

use crate::files::{DIALOG, FileKind, Files, GivenFile};
use crate::notice::Notice;
use crate::places::place;
use crate::recorder::Recorder;
use crate::shown_leg::ShownLeg;
use crate::theme::palette;
use crate::utc;
use crate::wall_clock::{self, WallClock};
use egui::{Button, Context, Label, RichText, TextEdit, Ui, vec2};
use leg_rig::control_settings;

/// Files on their way into the window and out of it.
pub struct Recordings {
    files: Files,
    /// What is typed where there is no dialog.
    path: String,
    /// What became of the last one, once.
    notice: Option<Notice>,
    /// Says when one begins and ends.
    pub wall_clock: WallClock,
}

impl Default for Recordings {
    fn default() -> Self {
        Self {
            files: Files::new(FileKind::Recording),
            path: String::new(),
            notice: None,
            wall_clock: wall_clock::system,
        }
    }
}

impl Recordings {
    /// The next one that was given.
    pub fn next(&mut self, ctx: &Context) -> Option<GivenFile> {
        self.files.take_dropped(ctx);
        self.files.next()
    }

    /// What became of the last one, once.
    pub const fn take_notice(&mut self) -> Option<Notice> {
        self.notice.take()
    }

    /// Saves a recording that cannot go on.
    pub fn advance(&mut self, leg: &mut ShownLeg) {
        let ended = leg.recorder().and_then(Recorder::ended);
        if let Some(why) = ended.map(ToString::to_string) {
            self.end(leg, &format!("The recording has ended: {why}."));
        }
    }

    /// Ends the recording of a leg, if there is one, and gives it to the user. `why` says so in words, if it was not the user.
    pub fn end(&mut self, leg: &mut ShownLeg, why: &str) {
        let Some(recorder) = leg.recorder_mut().take() else {
            return;
        };
        let saved = recorder
            .finish()
            .and_then(|bytes| Files::save(&self.name(), &bytes));
        self.notice = Some(Notice {
            good: saved.is_ok(),
            title: saved.unwrap_or_else(|words| format!("There is no recording: {words}.")),
            text: why.into(),
        });
    }

    fn begin(&mut self, leg: &mut ShownLeg) {
        let settings = control_settings::settings(leg.rig(), &leg.rig().gains, None);
        let now_s = (self.wall_clock)();
        // The messages of a simulated leg have its own time, from the zero of that on.
        let begin_s = match leg {
            ShownLeg::Simulated(leg) => now_s.map(|now_s| (now_s - leg.leg().time_s()).max(0.0)),
            ShownLeg::Live(_) => now_s,
        };
        let recorder = Recorder::new(&leg.source().name, &settings, begin_s);
        match recorder {
            Ok(recorder) => *leg.recorder_mut() = Some(recorder),
            Err(error) => {
                self.notice = Some(Notice {
                    good: false,
                    title: "The leg cannot be recorded.".into(),
                    text: error.to_string(),
                });
            }
        }
    }

    /// The name of a new one: that of the time at which it ends.
    fn name(&self) -> String {
        let now_s = (self.wall_clock)().unwrap_or_default();
        format!("leg-{}.mcap", utc::stamp(now_s as u64))
    }

    /// Lets the user record the leg, and open a recording.
    pub fn show(&mut self, ui: &mut Ui, leg: &mut ShownLeg) {
        let recorded = leg
            .recorder()
            .map(|recorder| (recorder.time_s(), recorder.bytes()));
        let (text, hint) = match recorded {
            None => (
                "Record",
                "Records every signal of the leg, as MCAP: `leg plot`, Foxglove and this window open it.",
            ),
            Some(_) => ("Stop, save", "Ends the recording, and saves it."),
        };
        let mut text = RichText::new(text);
        if recorded.is_some() {
            text = text.color(palette(ui.ctx()).error).strong();
        }
        let record = ui
            .add(Button::new(text).min_size(vec2(96.0, 0.0)))
            .on_hover_text(hint);
        place(&record, "record");
        if record.clicked() {
            if recorded.is_some() {
                self.end(leg, "");
            } else {
                self.begin(leg);
            }
        }
        // What is not recorded takes its room, too.
        let (time_s, bytes) = recorded.unwrap_or_default();
        let words = format!("{time_s:6.1} s {:5.1} MB", bytes as f64 / 1e6);
        let mut words = RichText::new(words).monospace().size(12.0);
        if recorded.is_none() {
            words = words.color(palette(ui.ctx()).faint);
        }
        ui.add(Label::new(words).extend());
        self.opening(ui);
    }

    fn opening(&mut self, ui: &mut Ui) {
        let hint = "Opens a recording, to be played here. Or drop one anywhere on the window.";
        if DIALOG {
            let open = ui.button("Open a recording …").on_hover_text(hint);
            place(&open, "recording_open");
            if open.clicked() {
                self.files.choose(ui.ctx());
            }
            return;
        }
        let path = TextEdit::singleline(&mut self.path).hint_text("path of a recording");
        place(&ui.add(path.desired_width(140.0)), "recording_path");
        let button = Button::new("Open");
        let open = ui.add_enabled(!self.path.is_empty(), button);
        place(&open, "recording_open");
        if open.on_hover_text(hint).clicked() {
            self.files.read_path(&self.path);
        }
    }
}
