//! Commands to the leg: buttons with what each will do, and sliders.

use crate::places::place;
use crate::simulation::Simulation;
use crate::text::left;
use crate::theme::palette;
use eframe::egui::{Button, Label, RichText, Slider, SliderClamping, Ui, vec2};
use leg_firmware::command::{Command, Compensation};
use leg_firmware::supervisor::{Event, State};
use std::ops::RangeInclusive;

/// What a slider leaves for its name and its value, points.
const LABEL_WIDTH: f32 = 68.0;
const VALUE_WIDTH: f32 = 112.0;

/// The stiffness that the slider reaches: that of the paper's rig within the bounds of its tensions.
const STIFFNESS_NM_PER_RAD: RangeInclusive<f64> = 20.0..=170.0;

/// The heaviest payload of the slider, kg.
const PAYLOAD_MAX_KG: f64 = 2.0;

/// A command that a button sends.
struct Choice {
    name: &'static str,
    text: &'static str,
    /// What it will do.
    effect: &'static str,
    command: Command,
    /// Whether it means something now.
    useful: fn(&Simulation) -> bool,
}

const CHOICES: [Choice; 5] = [
    Choice {
        name: "home",
        text: "Home",
        effect: "finds the zero, then hangs straight down",
        command: Command::Home,
        useful: |leg| leg.state().next(Event::Home).is_some(),
    },
    Choice {
        name: "arm",
        text: "Arm",
        effect: "follows commands from where it is",
        command: Command::Arm,
        useful: |leg| leg.state().next(Event::Arm).is_some(),
    },
    Choice {
        name: "hold",
        text: "Hold",
        effect: "comes to rest on the way, stays armed",
        command: Command::Hold,
        useful: |leg| leg.state() == State::Active,
    },
    Choice {
        name: "disarm",
        text: "Disarm",
        effect: "slackens the tendons, switches the drivers off",
        command: Command::Disarm,
        useful: |leg| {
            let state = leg.state();
            state.next(Event::Disarm).is_some() || state.next(Event::LeadDown).is_some()
        },
    },
    Choice {
        name: "clear",
        text: "Clear",
        effect: "ends faults whose cause is gone",
        command: Command::Clear,
        useful: |leg| {
            leg.faults().without_limits().any() || matches!(leg.state(), State::Held | State::Off)
        },
    },
];

/// Shows the commands.
pub fn show(ui: &mut Ui, simulation: &mut Simulation) {
    ui.heading("Drive it");
    for choice in &CHOICES {
        let useful = (choice.useful)(simulation);
        ui.horizontal(|ui| {
            let button =
                ui.add_enabled(useful, Button::new(choice.text).min_size(vec2(72.0, 28.0)));
            place(&button, choice.name);
            let effect = RichText::new(choice.effect)
                .small()
                .color(palette(ui.ctx()).faint);
            ui.add(Label::new(effect).wrap());
            if button.clicked() {
                simulation.command(choice.command, choice.text);
            }
        });
    }
    refusal(ui, simulation);
    compensation(ui, simulation);
    sliders(ui, simulation);
}

/// What was refused takes its room whether there is something or not: nothing moves.
fn refusal(ui: &mut Ui, simulation: &Simulation) {
    let words = simulation.refusal().unwrap_or_default();
    let text = RichText::new(words).small().color(palette(ui.ctx()).error);
    let size = vec2(ui.available_width(), 30.0);
    ui.allocate_ui(size, |ui| {
        ui.set_min_size(size);
        ui.add(Label::new(text).wrap());
    });
}

fn compensation(ui: &mut Ui, simulation: &mut Simulation) {
    let on = simulation.compensated();
    let mut chosen = on;
    let toggle = ui.checkbox(&mut chosen, "Compensate the load");
    place(&toggle, "compensation");
    if chosen == on {
        return;
    }
    let (compensation, name) = if chosen {
        (Compensation::Estimated, "compensation on")
    } else {
        (Compensation::Off, "compensation off")
    };
    simulation.command(Command::Compensation(compensation), name);
}

fn sliders(ui: &mut Ui, simulation: &mut Simulation) {
    let mut payload_kg = simulation.payload_kg();
    let slider = Slider::new(&mut payload_kg, 0.0..=PAYLOAD_MAX_KG);
    let slider = slider.step_by(0.05).fixed_decimals(2).suffix(" kg");
    if row(ui, "Payload", "payload", slider) {
        simulation.hang(payload_kg);
    }
    let Some(telemetry) = simulation.telemetry().copied() else {
        return;
    };
    let rig = simulation.rig();
    let mut pretension_n = f64::from(telemetry.pretension_n);
    let slider = Slider::new(&mut pretension_n, rig.f_min_n..=rig.f_max_n).suffix(" N");
    if row(ui, "Pretension", "pretension", slider.fixed_decimals(1)) {
        simulation.command(Command::Pretension(pretension_n as f32), "pretension");
    }
    let mut stiffness = f64::from(telemetry.stiffness_nm_per_rad);
    let slider = Slider::new(&mut stiffness, STIFFNESS_NM_PER_RAD).suffix(" N·m/rad");
    if row(ui, "Stiffness", "stiffness", slider.fixed_decimals(1)) {
        let demand = Command::Stiffness {
            demand_nm_per_rad: stiffness as f32,
            towards: None,
        };
        simulation.command(demand, "stiffness");
    }
}

/// Whether it was changed by hand: what the leg reports may be beyond the slider's ends.
fn row(ui: &mut Ui, text: &str, name: &'static str, slider: Slider<'_>) -> bool {
    ui.horizontal(|ui| {
        left(ui, LABEL_WIDTH, text);
        ui.spacing_mut().slider_width = (ui.available_width() - VALUE_WIDTH).clamp(60.0, 220.0);
        let response = ui.add(slider.clamping(SliderClamping::Edits));
        place(&response, name);
        response.changed()
    })
    .inner
}
