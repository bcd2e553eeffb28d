//! What to try first, in three steps.

use crate::places::place;
use crate::simulation::Simulation;
use crate::theme::palette;
use egui::{Button, Frame, Label, Margin, RichText, Ui, vec2};
use leg_firmware::command::{Command, Compensation};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigText;
use leg_sim::plant::Defect;

/// The payload of the first step, kg.
const PAYLOAD_KG: f64 = 2.0;

/// A step.
struct GuideStep {
    number: u8,
    /// What its button says, and its name for tests.
    action: [&'static str; 2],
    /// What will be seen.
    effect: &'static str,
    done: bool,
}

/// What came of the guide.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Wish {
    /// Nothing.
    None,
    /// A new leg.
    StartAgain,
    /// A new leg with the rig of this file.
    Simulate(RigText),
}

/// Shows the steps, and does the one that is pressed.
pub fn show(ui: &mut Ui, simulation: &mut Simulation) -> Wish {
    ui.heading("Try this");
    let cut = Defect::TendonCut(0);
    let steps = [
        GuideStep {
            number: 1,
            action: ["Hang 2 kg on the tip", "guide_payload"],
            effect: if simulation.source().text == READY_RIGS[0].text {
                "The tip sags to some 7 mm."
            } else {
                "The tip sags."
            },
            done: simulation.payload_kg() >= PAYLOAD_KG,
        },
        GuideStep {
            number: 2,
            action: ["Switch compensation on", "guide_compensation"],
            effect: "The leg estimates the load from its tendons' tensions, and brings the tip back to its target.",
            done: simulation.compensated(),
        },
        GuideStep {
            number: 3,
            action: ["Cut a tendon", "guide_cut"],
            effect: "The tip falls. The supervisor stops the motors, and says why.",
            done: simulation.has(cut),
        },
    ];
    for step in &steps {
        if !row(ui, step) {
            continue;
        }
        match step.number {
            1 => simulation.hang(PAYLOAD_KG),
            2 => simulation.command(
                Command::Compensation(Compensation::Estimated),
                "compensation on",
            ),
            _ => simulation.set_defect(cut, true),
        }
    }
    let again = ui
        .button("Start again")
        .on_hover_text("A new leg, as the window found it.");
    place(&again, "start_again");
    if again.clicked() {
        Wish::StartAgain
    } else {
        Wish::None
    }
}

/// Whether its button was pressed.
fn row(ui: &mut Ui, step: &GuideStep) -> bool {
    let palette = palette(ui.ctx());
    let mut pressed = false;
    ui.horizontal(|ui| {
        let (mark, colour) = if step.done {
            ("✔".to_owned(), palette.good)
        } else {
            (step.number.to_string(), palette.target)
        };
        let size = vec2(16.0, 28.0);
        ui.add_sized(
            size,
            Label::new(RichText::new(mark).color(colour).strong().size(16.0)),
        );
        let [text, name] = step.action;
        let width = ui.available_width();
        let button = ui.add_enabled(!step.done, Button::new(text).min_size(vec2(width, 30.0)));
        place(&button, name);
        pressed = button.clicked();
    });
    let indented = Frame::NONE.inner_margin(Margin {
        left: 24,
        ..Margin::ZERO
    });
    indented.show(ui, |ui| {
        let effect = RichText::new(step.effect).small().color(palette.faint);
        ui.add(Label::new(effect).wrap());
    });
    pressed
}
