//! What is done with edited settings: taken back, compared, saved, given to the leg or to its board.

use super::editor::{Change, Editor};
use crate::files::DIALOG;
use crate::live_leg::LiveLeg;
use crate::live_leg::board::Errand;
use crate::places::place;
use crate::shown_leg::ShownLeg;
use crate::theme::{Palette, palette};
use egui::{Button, Key, Label, Modifiers, Response, RichText, Ui};
use leg_rig::control_settings;
use leg_rig::rig_file::RigText;
use leg_rig::settings_difference::setting_differences;

/// Differences that are listed.
const LISTED_MAX: usize = 30;

/// What is wanted of the window.
pub(super) enum SettingsWish {
    /// A simulated leg of that file.
    Simulate(RigText),
    /// That file.
    Save(RigText),
}

/// Shows it.
pub(super) fn show(ui: &mut Ui, editor: &mut Editor, leg: &mut ShownLeg) -> Option<SettingsWish> {
    let palette = palette(ui.ctx());
    steps(ui, editor);
    let save = save(ui, editor);
    ui.separator();
    let applied = match leg {
        ShownLeg::Simulated(simulation) => {
            let same = simulation.source().text == editor.text();
            simulated(ui, editor, same, &palette)
        }
        ShownLeg::Live(live) => {
            board(ui, editor, live, &palette);
            None
        }
    };
    ui.separator();
    changes(ui, editor, &palette);
    save.or(applied)
}

fn faint(ui: &mut Ui, words: &str, palette: &Palette) {
    ui.add(Label::new(RichText::new(words).small().color(palette.faint)).wrap());
}

/// Back and forth, by buttons and by the usual keys.
fn steps(ui: &mut Ui, editor: &mut Editor) {
    let [can_undo, can_redo] = editor.steps();
    let typing = ui.memory(|memory| memory.focused().is_some());
    let pressed = |ui: &Ui, modifiers, key| {
        !typing && ui.input_mut(|input| input.consume_key(modifiers, key))
    };
    let again = pressed(ui, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z)
        || pressed(ui, Modifiers::COMMAND, Key::Y);
    let back = pressed(ui, Modifiers::COMMAND, Key::Z);
    ui.horizontal_wrapped(|ui| {
        if button(ui, can_undo, "Undo", "settings_undo").clicked() || back {
            editor.undo();
        }
        if button(ui, can_redo, "Redo", "settings_redo").clicked() || again {
            editor.redo();
        }
        let any = !editor.changes().is_empty();
        if button(ui, any, "All as in the file", "settings_all").clicked() {
            editor.all_to_file();
        }
    });
}

fn button(ui: &mut Ui, enabled: bool, text: &str, name: &'static str) -> Response {
    let button = ui.add_enabled(enabled, Button::new(text));
    place(&button, name);
    button
}

fn save(ui: &mut Ui, editor: &Editor) -> Option<SettingsWish> {
    let mut wish = None;
    ui.horizontal_wrapped(|ui| {
        let save = button(ui, true, "Save as a rig file", "settings_save");
        let hint = if DIALOG {
            "Every command takes it as --rig FILE. The browser asks where to."
        } else {
            "Every command takes it as --rig FILE. It is written where this window was started."
        };
        if save.on_hover_text(hint).clicked() {
            wish = Some(SettingsWish::Save(RigText {
                name: file_name(editor.name()),
                text: editor.text(),
            }));
        }
    });
    wish
}

/// The last part of a path, with the ending of a rig file.
fn file_name(name: &str) -> String {
    let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
    let stem = last.strip_suffix(".toml").unwrap_or(last);
    let stem = if stem.is_empty() { "leg" } else { stem };
    format!("{stem}.toml")
}

fn simulated(ui: &mut Ui, editor: &Editor, same: bool, palette: &Palette) -> Option<SettingsWish> {
    let apply = button(ui, !same, "Apply to the simulated leg", "settings_apply");
    let words = if same {
        "The leg runs with these settings. Change one, then apply it here."
    } else {
        "The leg starts anew with these settings: payload, defects and charts go."
    };
    faint(ui, words, palette);
    apply
        .clicked()
        .then(|| SettingsWish::Simulate(editor.source()))
}

fn board(ui: &mut Ui, editor: &Editor, live: &mut LiveLeg, palette: &Palette) {
    ui.heading("The board");
    let rig = live.rig();
    let in_use = control_settings::settings(rig, &rig.gains, None);
    let differences = setting_differences(&editor.settings(), &in_use);
    let words = match differences.len() {
        0 => "It is set as the table says.".into(),
        1 => format!("It has another value of {}.", differences[0].name),
        count => format!("It has other values of {count} settings."),
    };
    place(&ui.add(Label::new(words).wrap()), "board_differences");
    for (errand, text, name, changes) in [
        (Errand::Read, "Read from the board", "board_read", false),
        (
            Errand::Write(Box::new(editor.settings())),
            "Set the board",
            "board_set",
            true,
        ),
        (Errand::Save, "Keep over a reset", "board_keep", true),
    ] {
        let locked = live.board_locked(changes);
        let button = button(ui, locked.is_none(), text, name);
        if button.clicked() {
            live.ask(errand);
        }
        if let Some(words) = locked {
            button.on_disabled_hover_text(words);
        }
    }
    let (words, colour) = match (
        live.board().busy(),
        live.board().told(),
        live.board_locked(true),
    ) {
        (Some(busy), ..) => (format!("{busy} …"), palette.faint),
        (None, Some(Ok(told)), _) => (told.into(), palette.good),
        (None, Some(Err(told)), _) => (told.into(), palette.error),
        (None, None, Some(locked)) => (locked.into(), palette.faint),
        (None, None, None) => (
            "Set the board replaces all its settings. The leg has to home then.".into(),
            palette.faint,
        ),
    };
    let told = Label::new(RichText::new(words).color(colour)).wrap();
    place(&ui.add(told), "board_told");
}

/// The difference to the file that was loaded.
fn changes(ui: &mut Ui, editor: &Editor, palette: &Palette) {
    ui.heading("Changed");
    let name = format!("against {}", editor.name());
    faint(ui, &name, palette);
    let changes = editor.changes();
    if changes.is_empty() {
        faint(
            ui,
            "Nothing. Choose a section, type a value, press Enter.",
            palette,
        );
    }
    for change in changes.iter().take(LISTED_MAX) {
        let words = RichText::new(line(change)).monospace().size(11.5);
        let words = if change.follows {
            words.color(palette.faint)
        } else {
            words
        };
        ui.add(Label::new(words).wrap());
    }
    if changes.len() > LISTED_MAX {
        faint(
            ui,
            &format!("… and {} more", changes.len() - LISTED_MAX),
            palette,
        );
    }
}

fn line(change: &Change) -> String {
    let text = |value: &Option<String>| value.clone().unwrap_or_else(|| "—".into());
    let follows = if change.follows { " (follows)" } else { "" };
    format!(
        "{}: {} → {}{follows}",
        change.name,
        text(&change.was),
        text(&change.now)
    )
}

#[cfg(test)]
mod tests {
    use super::file_name;

    #[test]
    fn a_file_is_saved_under_its_last_name() {
        for (name, expected) in [
            ("rigs/table1.toml", "table1.toml"),
            ("C:\\legs\\mine.toml", "mine.toml"),
            ("/dev/ttyACM0", "ttyACM0.toml"),
            ("sim", "sim.toml"),
            ("", "leg.toml"),
        ] {
            assert_eq!(file_name(name), expected);
        }
    }
}
