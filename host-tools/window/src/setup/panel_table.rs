//! The table of settings: a part of it at a time, by section or by search, each value in a field of its own.

use super::editor::Editor;
use super::rows::{Row, with_unit};
use crate::places::place;
use crate::theme::{Palette, palette};
use egui::{ComboBox, Frame, Label, RichText, TextEdit, Ui};
use leg_rig::number::plain;

/// Settings that are shown at a time: more are found by more letters.
const SHOWN_MAX: usize = 40;

/// Widths of the fields for one number and for several, points.
const NUMBER_WIDTH: f32 = 120.0;
const ARRAY_WIDTH: f32 = 300.0;

/// What is shown of the table.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Part {
    /// Its first section.
    First,
    Section(String),
    /// What is not as in the file.
    Changed,
}

/// A value that is typed and not taken yet.
struct Typing {
    section: String,
    key: String,
    text: String,
}

/// The table, as the user looks at it.
pub(super) struct Table {
    search: String,
    part: Part,
    typing: Option<Typing>,
}

impl Default for Table {
    fn default() -> Self {
        Self {
            search: String::new(),
            part: Part::First,
            typing: None,
        }
    }
}

impl Table {
    pub fn forget_typing(&mut self) {
        self.typing = None;
    }

    /// What is searched, or which section is shown.
    pub fn choice(&mut self, ui: &mut Ui, editor: &Editor) {
        ui.horizontal_wrapped(|ui| {
            let search = TextEdit::singleline(&mut self.search).hint_text("search");
            place(&ui.add(search.desired_width(150.0)), "settings_search");
            let sections = sections(editor);
            let shown = match &self.part {
                _ if !self.search.trim().is_empty() => "all sections".into(),
                Part::First => sections.first().cloned().unwrap_or_default(),
                Part::Section(name) => name.clone(),
                Part::Changed => "changed".into(),
            };
            let choice = ComboBox::from_id_salt("section")
                .selected_text(shown)
                .width(170.0);
            let choice = choice.show_ui(ui, |ui| {
                let changed = ui.selectable_value(&mut self.part, Part::Changed, "changed");
                place(&changed, "section_changed");
                for name in sections {
                    let text = title(editor, &name);
                    let item = Part::Section(name.clone());
                    let item = ui.selectable_value(&mut self.part, item, text);
                    place(&item, format!("section_{name}"));
                }
            });
            place(&choice.response, "section");
        });
        ui.add_space(4.0);
    }

    fn is_shown(&self, row: &Row, editor: &Editor) -> bool {
        if !self.search.trim().is_empty() {
            return row.contains(&self.search);
        }
        match &self.part {
            Part::First => editor
                .rows()
                .first()
                .is_some_and(|first| first.section == row.section),
            Part::Section(name) => row.section == *name,
            Part::Changed => editor.is_changed(row),
        }
    }

    /// The settings.
    pub fn show(&mut self, ui: &mut Ui, editor: &mut Editor) {
        let palette = palette(ui.ctx());
        let found = editor
            .rows()
            .iter()
            .filter(|row| self.is_shown(row, editor));
        let found: Vec<Row> = found.cloned().collect();
        if found.is_empty() {
            let words = if self.search.trim().is_empty() {
                "Every value is as in the file. Choose a section, and change one."
            } else {
                "No key and no meaning has these words. Take some away."
            };
            ui.label(RichText::new(words).color(palette.faint));
        }
        for row in found.iter().take(SHOWN_MAX) {
            self.row(ui, editor, row, &palette);
        }
        if let Some(more) = found.len().checked_sub(SHOWN_MAX + 1) {
            let words = format!("… and {} more: search for more letters.", more + 1);
            ui.label(RichText::new(words).color(palette.faint));
        }
    }

    fn row(&mut self, ui: &mut Ui, editor: &mut Editor, row: &Row, palette: &Palette) {
        let changed = editor.is_changed(row);
        let edge = if changed {
            palette.warning
        } else {
            palette.line
        };
        let frame = Frame::group(ui.style()).stroke(egui::Stroke::new(1.0, edge));
        frame.inner_margin(6.0).show(ui, |ui| {
            ui.set_width(ui.available_width());
            ui.horizontal_wrapped(|ui| {
                let mark = if changed { "●" } else { "○" };
                ui.label(RichText::new(mark).color(edge));
                ui.label(RichText::new(&row.key).monospace().strong());
                let where_ = format!("[{}]", row.section);
                ui.label(RichText::new(where_).small().color(palette.faint));
                if changed {
                    let words = was(editor, row);
                    ui.label(RichText::new(words).small().color(palette.warning));
                }
            });
            ui.horizontal_wrapped(|ui| {
                self.field(ui, editor, row, palette);
                ui.label(&row.unit);
                ui.label(RichText::new(bounds(row)).small().color(palette.faint));
                self.back(ui, editor, row, changed);
            });
            let meaning = RichText::new(&row.meaning).small().color(palette.faint);
            ui.add(Label::new(meaning).wrap());
            let refused = editor
                .refused()
                .filter(|refused| row.is(&refused.section, &refused.key));
            if let Some(refused) = refused {
                let words = RichText::new(&refused.words).small().color(palette.error);
                place(&ui.add(Label::new(words).wrap()), "settings_refused");
            }
        });
    }

    /// The value; what is typed is taken by Enter, or by leaving the field.
    fn field(&mut self, ui: &mut Ui, editor: &mut Editor, row: &Row, palette: &Palette) {
        let is_this = |typing: &&mut Typing| row.is(&typing.section, &typing.key);
        let typed = self.typing.as_mut().filter(is_this);
        let mut text = typed.map_or_else(|| row.value.clone(), |typing| typing.text.clone());
        let refused = editor
            .refused()
            .is_some_and(|refused| row.is(&refused.section, &refused.key));
        let width = if row.value.starts_with('[') {
            ARRAY_WIDTH
        } else {
            NUMBER_WIDTH
        };
        let width = width.min(ui.available_width());
        let mut field = TextEdit::singleline(&mut text)
            .id_salt((&row.section, &row.key))
            .desired_width(width);
        if refused {
            field = field.text_color(palette.error);
        }
        let response = ui.add(field);
        place(&response, format!("value_{}.{}", row.section, row.key));
        if response.changed() {
            self.typing = Some(Typing {
                section: row.section.clone(),
                key: row.key.clone(),
                text: text.clone(),
            });
            editor.forget_refusal();
        }
        let typing = self.typing.as_ref();
        let typing = typing.is_some_and(|typing| row.is(&typing.section, &typing.key));
        // A refused value stays in its field, to be mended.
        if response.lost_focus() && typing && editor.set(&row.section, &row.key, &text) {
            self.typing = None;
        }
    }

    /// The ways back.
    fn back(&mut self, ui: &mut Ui, editor: &mut Editor, row: &Row, changed: bool) {
        let typing = self.typing.as_ref();
        let typing = typing.is_some_and(|typing| row.is(&typing.section, &typing.key));
        if changed || typing {
            let file = ui.small_button("File").on_hover_text("As it was loaded.");
            place(&file, format!("file_{}.{}", row.section, row.key));
            if file.clicked() {
                self.typing = None;
                editor.forget_refusal();
                editor.reset_to_file(&row.section, &row.key);
            }
        }
        if row.given && row.default.is_some() {
            let default = ui.small_button("Default");
            place(&default, format!("default_{}.{}", row.section, row.key));
            let hint = "Taken out of the file: by default, or by what the motors ask for.";
            if default.on_hover_text(hint).clicked() {
                self.typing = None;
                editor.forget_refusal();
                editor.reset_to_default(&row.section, &row.key);
            }
        }
    }
}

/// The sections in their order.
fn sections(editor: &Editor) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for row in editor.rows() {
        if !found.contains(&row.section) {
            found.push(row.section.clone());
        }
    }
    found
}

fn title(editor: &Editor, section: &str) -> String {
    let rows = editor.rows().iter();
    let changed = rows.filter(|row| row.section == section && editor.is_changed(row));
    match changed.count() {
        0 => section.into(),
        count => format!("{section}  ({count} changed)"),
    }
}

fn was(editor: &Editor, row: &Row) -> String {
    match editor.loaded(row) {
        Some(loaded) => format!("was {}", with_unit(&loaded.value, &row.unit)),
        None => "was not there".into(),
    }
}

fn bounds(row: &Row) -> String {
    let range = row.range.map_or_else(
        || "checked by the model".into(),
        |range| {
            let [low, high] = range.map(plain);
            with_unit(&format!("{low} to {high}"), &row.unit)
        },
    );
    match &row.default {
        Some(default) => format!("{range}, by default {}", with_unit(default, &row.unit)),
        None => range,
    }
}
