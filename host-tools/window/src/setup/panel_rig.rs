//! Which leg it is: ready rigs, and rig files of one's own.

use super::Setup;
use crate::files::DIALOG;
use crate::places::place;
use crate::shown_leg::ShownLeg;
use crate::theme::palette;
use egui::{Button, CollapsingHeader, Label, RichText, TextEdit, Ui, vec2};
use leg_rig::ready_rigs::{READY_RIGS, ReadyRig};
use leg_rig::rig_file::RigText;
use leg_rig::rig_show;

/// Shows them. The one that was chosen for the simulated leg.
pub(super) fn show(ui: &mut Ui, setup: &mut Setup, leg: &ShownLeg) -> Option<RigText> {
    let live = leg.live().is_some();
    ui.heading("The leg that is shown");
    let name = ui.label(RichText::new(&leg.source().name).monospace().strong());
    place(&name, "rig_name");
    let made = CollapsingHeader::new("What the model makes of it").id_salt("rig made");
    let made = made.show(ui, |ui| {
        let words = RichText::new(rig_show::words(leg.rig()))
            .monospace()
            .size(11.5);
        ui.add(Label::new(words).wrap());
    });
    place(&made.header_response, "rig_made");
    ui.add_space(8.0);
    ui.heading("A rig file of your own");
    faint(
        ui,
        if live {
            "Its values are shown in Settings; nothing is sent to the board before you press Set the board."
        } else {
            "The simulated leg becomes that leg, and starts anew. Nothing is sent anywhere."
        },
    );
    own(ui, setup);
    ui.add_space(8.0);
    ui.heading("Ready rigs");
    let mut wanted = None;
    for rig in &READY_RIGS {
        if ready(ui, setup, rig, leg) {
            wanted = Some(source(rig));
        }
    }
    if live {
        let chosen = wanted.take()?;
        setup.load_for_board(&chosen, &[]);
    }
    wanted
}

fn source(rig: &ReadyRig) -> RigText {
    RigText {
        name: format!("{}.toml", rig.name),
        text: rig.text.into(),
    }
}

fn own(ui: &mut Ui, setup: &mut Setup) {
    if DIALOG {
        let open = ui.button("Open a rig file …");
        place(&open, "rig_open");
        if open.clicked() {
            setup.files.choose(ui.ctx());
        }
    } else {
        ui.horizontal(|ui| {
            let path = TextEdit::singleline(&mut setup.path).hint_text("path of a rig file");
            let typed = ui.add(path.desired_width(260.0));
            place(&typed, "rig_path");
            let open = ui.add_enabled(!setup.path.is_empty(), Button::new("Open"));
            place(&open, "rig_open");
            if open.clicked() {
                setup.files.read_path(&setup.path);
            }
        });
    }
    faint(
        ui,
        "Or drop one anywhere on the window. One with a mistake is refused with its line and what to do.",
    );
}

/// Whether it was chosen.
fn ready(ui: &mut Ui, setup: &mut Setup, rig: &ReadyRig, leg: &ShownLeg) -> bool {
    let mut chosen = false;
    ui.horizontal(|ui| {
        let shown = leg.source().text == rig.text;
        let button = Button::new(rig.name)
            .selected(shown)
            .min_size(vec2(180.0, 28.0));
        let button = ui.add(button);
        place(&button, format!("rig_{}", rig.name));
        chosen = button.clicked();
        if ui.available_width() > 230.0 {
            let save = ui.button("Save").on_hover_text("As a file, to be changed.");
            place(&save, format!("rig_save_{}", rig.name));
            if save.clicked() {
                setup.save(&format!("{}.toml", rig.name), rig.text);
            }
        }
        let words = match rig.figure_2 {
            "-" => rig.words.to_owned(),
            figure => format!("{} (the paper's Fig. 2: {figure})", rig.words),
        };
        let words = RichText::new(words).small().color(palette(ui.ctx()).faint);
        ui.add(Label::new(words).wrap());
    });
    chosen
}

fn faint(ui: &mut Ui, words: &str) {
    let words = RichText::new(words).small().color(palette(ui.ctx()).faint);
    ui.add(Label::new(words).wrap());
}
