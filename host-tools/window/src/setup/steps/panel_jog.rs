//! One motor, turned slowly, as its user does it.

use super::controls::{button, drivers_off, faint, payload_off, sentence};
use super::jog::{Jog, JogStep, TRAVEL_MAX_MM};
use super::picture::{self, StepPicture};
use crate::places::place;
use crate::setup::editor::Editor;
use crate::shown_leg::ShownLeg;
use crate::theme::palette;
use egui::{Label, RichText, Slider, Spinner, Ui};
use leg_base::jog_report;

pub(super) fn show(ui: &mut Ui, jog: &mut Jog, editor: &Editor, leg: &mut ShownLeg) {
    picture::show(
        ui,
        &StepPicture {
            tendon: Some(usize::from(jog.motor) - 1),
            pull_mm: Some(jog.travel_mm),
            ..StepPicture::default()
        },
    );
    let settings = editor.settings();
    ui.add_enabled_ui(!jog.busy(), |ui| {
        sentence(
            ui,
            1,
            "Which motor, and how far? Below zero it pays its tendon out.",
        );
        ui.horizontal_wrapped(|ui| {
            for motor in 1..=3 {
                let chosen = ui.selectable_value(&mut jog.motor, motor, format!("Motor {motor}"));
                place(&chosen, format!("motor_{motor}"));
            }
            let travel =
                Slider::new(&mut jog.travel_mm, -TRAVEL_MAX_MM..=TRAVEL_MAX_MM).suffix(" mm");
            place(&ui.add(travel.step_by(0.5).fixed_decimals(1)), "jog_travel");
        });
        sentence(
            ui,
            2,
            "Take the payload off, and keep hands away. This will happen:",
        );
        let plan = jog_report::plan(&jog.demand(&settings), &settings);
        let plan = ui.add(Label::new(RichText::new(plan).monospace().size(11.5)).wrap());
        place(&plan, "jog_plan");
    });
    let off = jog.busy() || drivers_off(ui, leg);
    let free = jog.busy() || payload_off(ui, leg, "a single tendon would have to bear it.");
    let still = jog.travel_mm == 0.0;
    let why = leg
        .locked()
        .or((!off).then_some("Disarm the leg first."))
        .or((!free).then_some("Take the payload off first."))
        .or(still.then_some("Choose how far it turns."))
        .or(jog.busy().then_some("It turns."));
    if button(ui, "Turn it", "jog_start", why).clicked() {
        jog.start(leg, &settings);
    }
    outcome(ui, jog, leg);
}

fn outcome(ui: &mut Ui, jog: &Jog, leg: &ShownLeg) {
    let palette = palette(ui.ctx());
    match jog.step() {
        JogStep::Choose => faint(ui, "What the board saw will stand here."),
        JogStep::Commanded(_) | JogStep::Turning | JogStep::Asked => {
            ui.horizontal(|ui| {
                ui.add(Spinner::new());
                ui.label("The motor turns. Space, Esc and STOP end it.");
            });
        }
        JogStep::Refused => {
            let words = leg
                .refusal()
                .unwrap_or("It did not begin, or nothing was heard of it.");
            let words = RichText::new(words).color(palette.error);
            place(&ui.add(Label::new(words).wrap()), "jog_refused");
        }
        JogStep::Done(done) => {
            let (report, findings) = &**done;
            let text = jog_report::text(report, findings);
            let text = RichText::new(text).monospace().size(11.5);
            place(&ui.add(Label::new(text).wrap()), "jog_result");
            let (words, colour) = if findings.is_empty() {
                ("Motor, encoder and load cell fit each other.", palette.good)
            } else {
                ("Something does not fit: see the findings.", palette.error)
            };
            ui.label(RichText::new(words).color(colour));
        }
    }
}
