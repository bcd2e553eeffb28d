//! A motor and the swing of the leg, as their user measures them.

use super::controls::{button, drivers_off, faint, payload_off, sentence};
use super::picture::{self, StepPicture};
use super::tune::{Outcome, Tune, TuneStep};
use crate::places::place;
use crate::setup::editor::Editor;
use crate::shown_leg::ShownLeg;
use crate::theme::palette;
use egui::{Label, RichText, ScrollArea, Spinner, Ui};
use leg_rig::number::plain;
use leg_rig::tune::{certain_values, plan_text, table};

pub(super) fn show(ui: &mut Ui, tune: &mut Tune, editor: &mut Editor, leg: &mut ShownLeg) {
    // What was measured needs the room.
    if !matches!(tune.step(), TuneStep::Done(_)) {
        let simulated = leg.live().is_none();
        picture::show(
            ui,
            &StepPicture {
                tendon: Some(usize::from(tune.motor) - 1),
                both_ways: true,
                swings: tune.swings && simulated,
                no_payload: true,
                ..StepPicture::default()
            },
        );
    }
    match tune.step() {
        TuneStep::Choose => choose(ui, tune, editor, leg),
        TuneStep::Measuring => measuring(ui, tune, leg),
        TuneStep::Done(outcome) => {
            let outcome = outcome.clone();
            done(ui, tune, &outcome, editor, leg);
        }
    }
}

fn choose(ui: &mut Ui, tune: &mut Tune, editor: &Editor, leg: &mut ShownLeg) {
    tune.ask_supply(leg);
    sentence(ui, 1, "Which motor, and is the leg to swing, too?");
    ui.horizontal_wrapped(|ui| {
        for motor in 1..=3 {
            let chosen = ui.selectable_value(&mut tune.motor, motor, format!("Motor {motor}"));
            place(&chosen, format!("tune_motor_{motor}"));
        }
        if leg.live().is_none() {
            let swings = ui.checkbox(&mut tune.swings, "Home it, and let it swing");
            place(&swings, "tune_swings");
        }
    });
    if leg.live().is_some() {
        faint(
            ui,
            "The motor alone: a page hears too few reports of a live leg to see it swing. `leg tune` measures that.",
        );
        faint(ui, &gear_words(tune.motor, editor));
    }
    sentence(
        ui,
        2,
        "Take the payload off, let the leg hang free, and keep hands away. This will happen:",
    );
    let plan = tune.plan(leg);
    let words = plan.as_ref().map_or_else(
        || "The voltage of the supply is asked for.\n".into(),
        |(jogs, swing)| plan_text(jogs, swing.as_ref()),
    );
    let words =
        format!("{words}any fault, space, Esc and STOP end it: the motors are off or held then");
    let shown = ui.add(Label::new(RichText::new(words).monospace().size(11.5)).wrap());
    place(&shown, "tune_plan");
    let off = drivers_off(ui, leg);
    let free = payload_off(ui, leg, "the first mode would be that of the leg with it.");
    let why = leg
        .locked()
        .or((!off).then_some("Disarm the leg first."))
        .or((!free).then_some("Take the payload off first."))
        .or(plan.is_none().then_some("Wait until the supply is known."));
    if button(ui, "Measure it", "tune_start", why).clicked() {
        tune.start(leg, editor.rig());
    }
}

/// From which gear and screw the constants of a motor are computed.
fn gear_words(motor: u8, editor: &Editor) -> String {
    let own = usize::from(motor).saturating_sub(1);
    let actuators = &editor.rig().actuators;
    actuators.get(own).map_or_else(String::new, |actuator| {
        format!(
            "The motor's constants are computed from gear_ratio {} and lead_m {} in [actuator] of {}. A board does not store them: enter those of the leg first.",
            plain(actuator.gear_ratio),
            plain(actuator.lead_m),
            editor.name()
        )
    })
}

fn measuring(ui: &mut Ui, tune: &mut Tune, leg: &mut ShownLeg) {
    ui.horizontal(|ui| {
        ui.add(Spinner::new());
        ui.label("It is measured. Space, Esc and STOP end it.");
    });
    let seen = ui.label(RichText::new(tune.seen()).monospace());
    place(&seen, "tune_seen");
    if button(ui, "Give up", "tune_cancel", None).clicked() {
        tune.cancel(leg);
    }
}

fn done(ui: &mut Ui, tune: &mut Tune, outcome: &Outcome, editor: &mut Editor, leg: &mut ShownLeg) {
    let palette = palette(ui.ctx());
    if let Some(words) = &outcome.failure {
        let words = RichText::new(words).monospace().color(palette.error);
        place(&ui.add(Label::new(words).wrap()), "tune_failed");
    }
    if let Some(words) = &outcome.servo_finding {
        let words = RichText::new(words).color(palette.warning);
        place(&ui.add(Label::new(words).wrap()), "tune_finding");
    }
    if !outcome.rows.is_empty() {
        let scroll = ScrollArea::horizontal().id_salt("tune");
        scroll.show(ui, |ui| {
            let text = RichText::new(table(&outcome.rows)).monospace().size(11.5);
            place(&ui.add(Label::new(text).extend()), "tune_result");
        });
        faint(
            ui,
            "± holds in 95 of 100 cases. What is certain, and has a key in the rig file, is put into the settings.",
        );
        if button(ui, "Put it into the settings", "tune_take", None).clicked() {
            for (section, key, value) in certain_values(&outcome.rows) {
                editor.set(&section, key, &value);
            }
            tune.cancel(leg);
            return;
        }
    }
    if button(ui, "Once more", "tune_again", None).clicked() {
        tune.cancel(leg);
    }
}
