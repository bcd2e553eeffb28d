//! The encoders, as their user checks them.

use super::controls::{button, drivers_off, faint, sentence};
use super::picture::{self, StepPicture};
use super::turns::{TurnStep, Turns};
use crate::places::place;
use crate::setup::editor::Editor;
use crate::shown_leg::ShownLeg;
use crate::theme::palette;
use egui::{Label, RichText, Spinner, Ui};
use leg_rig::motor_turn;
use leg_rig::rig_settings::written;

pub(super) fn show(ui: &mut Ui, turns: &mut Turns, editor: &mut Editor, leg: &mut ShownLeg) {
    let shown = match turns.step() {
        TurnStep::Begin | TurnStep::Done => StepPicture::default(),
        _ => StepPicture {
            tendon: Some(turns.motor()),
            turned: true,
            ..StepPicture::default()
        },
    };
    picture::show(ui, &shown);
    match turns.step() {
        TurnStep::Begin => begin(ui, turns, editor, leg),
        TurnStep::Before | TurnStep::After(_) | TurnStep::Rehearse(..) => {
            ui.horizontal(|ui| {
                ui.add(Spinner::new());
                ui.label("The counter is read.");
            });
        }
        TurnStep::Turn(_) => {
            let words = motor_turn::step(turns.motor());
            sentence(ui, turns.motor() as u8 + 1, &format!("By hand: {words}."));
            ui.horizontal(|ui| {
                if button(ui, "It is turned", "turns_turned", leg.locked()).clicked() {
                    turns.turned(leg);
                }
                if button(ui, "Give up", "turns_cancel", None).clicked() {
                    turns.cancel();
                }
            });
        }
        TurnStep::Done => {}
    }
    table(ui, turns);
    if turns.step() == TurnStep::Done {
        done(ui, turns, editor);
    }
}

fn begin(ui: &mut Ui, turns: &mut Turns, editor: &Editor, leg: &mut ShownLeg) {
    sentence(
        ui,
        1,
        "Each motor is turned once by hand: way and counts of its encoder are checked. Nothing moves by itself.",
    );
    let counts = editor.counts_per_turn();
    let words = format!(
        "A turn has {} counts: counts_per_turn in [actuator] of {}.",
        written(&counts),
        editor.name()
    );
    faint(ui, &words);
    let refused = counts
        .into_iter()
        .try_for_each(motor_turn::require_countable)
        .err()
        .map(|failure| failure.to_string());
    let off = drivers_off(ui, leg);
    let why = leg
        .locked()
        .or(refused.as_deref())
        .or((!off).then_some("Disarm the leg first."));
    if let Some(words) = &refused {
        faint(ui, words);
    }
    if button(ui, "Start", "turns_start", why).clicked() {
        turns.start(leg);
    }
}

fn table(ui: &mut Ui, turns: &Turns) {
    let palette = palette(ui.ctx());
    for turn in turns.turns() {
        let colour = if turn.passed {
            palette.good
        } else {
            palette.error
        };
        let words = format!(
            "motor {}: {} counts, expected {:.0}: {}",
            turn.motor,
            turn.counts,
            turn.expected,
            turn.verdict()
        );
        let words = RichText::new(words).monospace().color(colour);
        place(
            &ui.add(Label::new(words).wrap()),
            format!("turn_{}", turn.motor),
        );
    }
}

fn done(ui: &mut Ui, turns: &mut Turns, editor: &mut Editor) {
    match motor_turn::signs(turns.turns()) {
        Some(signs) => {
            if button(
                ui,
                "Put the directions into the settings",
                "turns_take",
                None,
            )
            .clicked()
            {
                editor.set("calibration", "counts_sign", &signs);
                turns.cancel();
                return;
            }
        }
        None => faint(
            ui,
            "An encoder counted nothing: mend it, then turn the motors once more.",
        ),
    }
    if button(ui, "Once more", "turns_again", None).clicked() {
        turns.cancel();
    }
}
