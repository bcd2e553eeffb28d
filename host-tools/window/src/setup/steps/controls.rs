//! What all steps are made of: sentences, buttons, and the button that switches the drivers off.

use crate::places::place;
use crate::shown_leg::ShownLeg;
use crate::theme::palette;
use egui::{Button, Label, Response, RichText, Ui, vec2};
use leg_firmware::command::Command;
use leg_firmware::supervisor::Event;

/// Text of less weight.
pub(super) fn faint(ui: &mut Ui, words: &str) {
    let words = RichText::new(words).color(palette(ui.ctx()).faint);
    ui.add(Label::new(words).wrap());
}

/// A numbered sentence: what is done next.
pub(super) fn sentence(ui: &mut Ui, number: u8, words: &str) {
    ui.horizontal_top(|ui| {
        let colour = palette(ui.ctx()).target;
        ui.label(RichText::new(format!("{number}.")).color(colour).strong());
        ui.add(Label::new(words).wrap());
    });
}

/// A button of the steps; `why` disables it, and is said beside it.
pub(super) fn button(ui: &mut Ui, text: &str, name: &'static str, why: Option<&str>) -> Response {
    ui.horizontal(|ui| {
        let button = Button::new(text).min_size(vec2(150.0, 30.0));
        let button = ui.add_enabled(why.is_none(), button);
        place(&button, name);
        if let Some(words) = why {
            let words = RichText::new(words).color(palette(ui.ctx()).faint);
            ui.add(Label::new(words).wrap());
        }
        button
    })
    .inner
}

/// Whether no payload hangs on the tip, as far as that is known; if one does, why that is wrong, and the button that takes it off.
pub(super) fn payload_off(ui: &mut Ui, leg: &mut ShownLeg, why: &str) -> bool {
    let Some(simulation) = leg.simulated_mut() else {
        return true;
    };
    let hung_kg = simulation.leg().truth().payload_kg;
    if hung_kg <= 0.0 {
        return true;
    }
    let words = format!("{hung_kg:.2} kg hang on the tip: {why}");
    let words = RichText::new(words).color(palette(ui.ctx()).warning);
    ui.add(Label::new(words).wrap());
    if button(ui, "Take the payload off", "steps_payload_off", None).clicked() {
        simulation.hang(0.0);
    }
    false
}

/// Whether the drivers are off; if not, the button that switches them off. Nobody reaches into a leg that is driven.
pub(super) fn drivers_off(ui: &mut Ui, leg: &mut ShownLeg) -> bool {
    let state = leg.state();
    if !state.driven() {
        return true;
    }
    let palette = palette(ui.ctx());
    let words =
        "The drivers are on. Disarm the leg first: it slackens its tendons, and is off then.";
    ui.add(Label::new(RichText::new(words).color(palette.warning)).wrap());
    let useful = state.next(Event::Disarm).is_some() || state.next(Event::LeadDown).is_some();
    let why = leg
        .locked()
        .or((!useful).then_some("Wait until it has ended what it does."));
    if button(ui, "Disarm", "steps_disarm", why).clicked() {
        leg.command(Command::Disarm, "disarm");
    }
    false
}
