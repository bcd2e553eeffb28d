//! The choice of a calibration.

use super::controls::faint;
use super::{Guide, panel_cells, panel_jog, panel_tune, panel_turns, panel_zero};
use crate::places::place;
use crate::setup::Setup;
use crate::shown_leg::ShownLeg;
use egui::{Button, Ui, vec2};

const GUIDES: [(Guide, &str, &str); 5] = [
    (Guide::Cells, "Load cells", "guide_cells"),
    (Guide::Turns, "Encoders", "guide_turns"),
    (Guide::Motor, "One motor", "guide_motor"),
    (Guide::Zero, "Zero", "guide_zero"),
    (Guide::Tune, "Tune", "guide_tune"),
];

/// Shows it.
pub fn show(ui: &mut Ui, setup: &mut Setup, leg: &mut ShownLeg) {
    let Setup { steps, editor, .. } = setup;
    let Some(editor) = editor.as_mut() else {
        return;
    };
    ui.horizontal_wrapped(|ui| {
        for (guide, text, name) in GUIDES {
            let chosen = Button::selectable(steps.guide == guide, text);
            let chosen = ui.add(chosen.min_size(vec2(96.0, 30.0)));
            place(&chosen, name);
            if chosen.clicked() {
                steps.guide = guide;
            }
        }
    });
    if leg.live().is_none() {
        faint(
            ui,
            "A rehearsal on the simulated leg: it does the same steps, and what is done by hand is done for you.",
        );
    }
    ui.add_space(4.0);
    match steps.guide {
        Guide::Cells => panel_cells::show(ui, &mut steps.cells, editor, leg),
        Guide::Turns => panel_turns::show(ui, &mut steps.turns, editor, leg),
        Guide::Motor => panel_jog::show(ui, &mut steps.jog, editor, leg),
        Guide::Zero => panel_zero::show(ui, &mut steps.homing, editor, leg),
        Guide::Tune => panel_tune::show(ui, &mut steps.tune, editor, leg),
    }
}
