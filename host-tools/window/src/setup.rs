//! What leg there is, and what it is set to: rig files, the table of settings, and the steps of a calibration.

pub mod document;
pub mod editor;
mod panel_actions;
mod panel_rig;
mod panel_table;
pub mod rows;
pub mod state;
pub mod steps;

use crate::files::{Files, GivenFile};
use crate::notice::{self, Notice};
use crate::places::place;
use crate::rig_intake;
use crate::scrolled;
use crate::shown_leg::ShownLeg;
use editor::Editor;
use egui::{Button, CentralPanel, Context, Panel, Ui, vec2};
use leg_rig::rig_file::RigText;
use panel_actions::SettingsWish;
use panel_table::Table;
use state::SetupState;
use steps::Steps;

/// From this width on the table has something beside it, points.
const WIDE: f32 = 760.0;

/// What is shown of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Page {
    #[default]
    Rig,
    Settings,
    Steps,
}

const PAGES: [(Page, &str, &str); 3] = [
    (Page::Rig, "Rig", "setup_rig"),
    (Page::Settings, "Settings", "setup_settings"),
    (Page::Steps, "Calibrate", "setup_steps"),
];

/// All of it.
#[derive(Default)]
pub struct Setup {
    /// Whether it is shown in the place of the leg.
    pub open: bool,
    /// Whether something of it is to be shown now.
    wanted: bool,
    page: Page,
    files: Files,
    notice: Option<Notice>,
    /// None until it is looked at.
    editor: Option<Editor>,
    /// How often a live leg's settings had come when they were looked at, and how often they had been read.
    seen: [u64; 2],
    table: Table,
    steps: Steps,
    /// What is typed where there is no dialog.
    path: String,
}

impl Setup {
    /// Looks at the files that were given. A rig of which the simulated leg is to be made, if there is one.
    pub fn take_files(&mut self, ctx: &Context, leg: Option<&ShownLeg>) -> Option<RigText> {
        self.files.take_dropped(ctx);
        let mut wanted = None;
        while let Some(GivenFile { name, bytes }) = self.files.next() {
            let opened = bytes.and_then(|bytes| rig_intake::open(&name, bytes));
            match opened {
                Err(failure) => self.refuse(&name, failure.render(false)),
                Ok(opened) if leg.is_some_and(|leg| leg.live().is_some()) => {
                    self.load_for_board(&opened.source, &opened.notes);
                }
                Ok(opened) => wanted = Some(opened.source),
            }
        }
        wanted
    }

    fn refuse(&mut self, name: &str, text: String) {
        self.notice = Some(Notice {
            good: false,
            title: format!("{name} is refused. The leg stays as it was."),
            text,
        });
    }

    /// A file for a live leg is shown first: the user sends it.
    fn load_for_board(&mut self, source: &RigText, notes: &[String]) {
        match Editor::new(source) {
            Err(failure) => self.refuse(&source.name, failure.render(false)),
            Ok(editor) => {
                self.editor = Some(editor);
                (self.wanted, self.page) = (true, Page::Settings);
                self.notice = Some(Notice {
                    good: true,
                    title: format!(
                        "{} is shown in Settings. The board is not set to it yet.",
                        source.name
                    ),
                    text: notes.join("\n"),
                });
            }
        }
    }

    /// Shows a message, whatever it is about.
    pub fn note(&mut self, notice: Notice) {
        self.notice = Some(notice);
    }

    /// Shows no message any more.
    pub fn close_notice(&mut self) {
        self.notice = None;
    }

    /// Whether something of it is to be shown now, once.
    pub const fn take_wanted(&mut self) -> bool {
        std::mem::replace(&mut self.wanted, false)
    }

    /// Notes that a simulated leg was made of a file.
    pub fn note_simulated(&mut self, source: &RigText, notes: &[String]) {
        let edited = |editor: &Editor| editor.name() == source.name && editor.text() == source.text;
        if !self.editor.as_ref().is_some_and(edited) {
            self.editor = None;
        }
        self.notice = Some(Notice {
            good: true,
            title: format!(
                "The leg is that of {} now. It has started anew.",
                source.name
            ),
            text: notes.join("\n"),
        });
    }

    /// Notes that no leg could be made of a file.
    pub fn note_refused(&mut self, source: &RigText, words: String) {
        self.refuse(&source.name, words);
    }

    /// Forgets the steps with a leg that is not there any more.
    pub fn forget_leg(&mut self) {
        self.steps = Steps::default();
    }

    /// Goes on with a calibration that was begun, whatever is shown.
    pub fn advance(&mut self, leg: &mut ShownLeg) {
        self.steps.advance(leg, self.editor.as_ref());
    }

    /// Looks at a leg that has reported something, many times in a frame.
    pub fn look(&mut self, leg: &mut ShownLeg) {
        self.steps.look(leg);
    }

    /// Gives the user a file.
    fn save(&mut self, name: &str, text: &str) {
        let saved = Files::save(name, text.as_bytes());
        self.notice = Some(Notice {
            good: saved.is_ok(),
            title: saved.unwrap_or_else(|words| words),
            text: String::new(),
        });
    }

    /// What it shows, as data.
    #[must_use]
    pub fn state(&self, leg: Option<&ShownLeg>) -> SetupState {
        SetupState::new(
            self.notice.as_ref(),
            self.editor.as_ref(),
            leg,
            self.steps.measure_failed(),
        )
    }

    /// Shows what became of what was done last.
    pub fn show_notice(&mut self, ui: &mut Ui) {
        notice::show(ui, &mut self.notice);
    }

    /// Shows all of it where the leg would be. A rig of which the simulated leg is to be made, if that is wanted.
    pub fn show(&mut self, ui: &mut Ui, leg: &mut ShownLeg) -> Option<RigText> {
        CentralPanel::default()
            .show(ui, |ui| self.show_inside(ui, leg))
            .inner
    }

    /// The same in a place that is given.
    pub fn show_inside(&mut self, ui: &mut Ui, leg: &mut ShownLeg) -> Option<RigText> {
        self.follow(leg);
        ui.horizontal(|ui| {
            for (page, text, name) in PAGES {
                let button = Button::selectable(self.page == page, text);
                let response = ui.add(button.min_size(vec2(86.0, 30.0)));
                place(&response, name);
                if response.clicked() {
                    self.page = page;
                }
            }
        });
        ui.separator();
        match self.page {
            Page::Rig => scrolled::whole(ui, "rig", |ui| panel_rig::show(ui, self, leg)),
            Page::Settings => self.settings(ui, leg),
            Page::Steps => {
                scrolled::whole(ui, "steps", |ui| steps::show(ui, self, leg));
                None
            }
        }
    }

    /// Takes the settings of the leg that is shown: the first time, when they were read from its board, and when that has told them
    /// while nothing is edited here.
    fn follow(&mut self, leg: &ShownLeg) {
        let seen = leg
            .live()
            .map_or([0; 2], |live| live.board().settings_seen());
        let read = seen[1] != self.seen[1];
        let is_free =
            |editor: &Editor| editor.name() == leg.source().name && editor.changes().is_empty();
        let free = self.editor.as_ref().is_none_or(is_free);
        if self.editor.is_none() || read || seen != self.seen && free {
            self.table.forget_typing();
            // What the leg has in use was read before.
            self.editor = Editor::new(leg.source()).ok();
        }
        self.seen = seen;
    }

    fn settings(&mut self, ui: &mut Ui, leg: &mut ShownLeg) -> Option<RigText> {
        let wish = self.table_and_actions(ui, leg)?;
        match wish {
            SettingsWish::Simulate(source) => return Some(source),
            SettingsWish::Save(source) => self.save(&source.name, &source.text),
        }
        None
    }

    fn table_and_actions(&mut self, ui: &mut Ui, leg: &mut ShownLeg) -> Option<SettingsWish> {
        let Self { editor, table, .. } = self;
        let editor = editor.as_mut()?;
        if ui.available_width() >= WIDE {
            let side = Panel::right("changes").resizable(false).exact_size(330.0);
            let wish = side.show(ui, |ui| {
                scrolled::whole(ui, "changes", |ui| panel_actions::show(ui, editor, leg))
            });
            CentralPanel::no_frame().show(ui, |ui| {
                table.choice(ui, editor);
                scrolled::whole(ui, "table", |ui| table.show(ui, editor));
            });
            return wish.inner;
        }
        scrolled::whole(ui, "table", |ui| {
            table.choice(ui, editor);
            table.show(ui, editor);
            ui.separator();
            panel_actions::show(ui, editor, leg)
        })
    }
}
