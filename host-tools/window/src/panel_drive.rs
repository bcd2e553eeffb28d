//! Commands to the leg: buttons with what each will do, and sliders.

use crate::places::place;
use crate::simulation::Simulation;
use crate::theme::palette;
use eframe::egui::{Button, Label, RichText, Slider, Ui, vec2};
use leg_firmware::command::{Command, Compensation};
use leg_firmware::supervisor::{Event, State};

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
    let range = 0.0..=PAYLOAD_MAX_KG;
    let slider = Slider::new(&mut payload_kg, range)
        .step_by(0.05)
        .fixed_decimals(2);
    if row(ui, "Payload", "payload", slider.suffix(" kg")) {
        simulation.hang(payload_kg);
    }
    let Some(telemetry) = simulation.telemetry().copied() else {
        return;
    };
    let rig = simulation.rig();
    let mut pretension_n = f64::from(telemetry.pretension_n);
    let range = rig.f_min_n..=rig.f_max_n;
    let slider = Slider::new(&mut pretension_n, range)
        .step_by(1.0)
        .fixed_decimals(1);
    if row(ui, "Pretension", "pretension", slider.suffix(" N")) {
        simulation.command(Command::Pretension(pretension_n as f32), "pretension");
    }
    let mut stiffness = f64::from(telemetry.stiffness_nm_per_rad);
    let slider = Slider::new(&mut stiffness, 20.0..=170.0)
        .step_by(1.0)
        .fixed_decimals(1);
    if row(ui, "Stiffness", "stiffness", slider.suffix(" N·m/rad")) {
        let demand = Command::Stiffness {
            demand_nm_per_rad: stiffness as f32,
            towards: None,
        };
        simulation.command(demand, "stiffness");
    }
}

/// Whether it was changed.
fn row(ui: &mut Ui, text: &str, name: &'static str, slider: Slider<'_>) -> bool {
    ui.horizontal(|ui| {
        ui.add_sized(
            vec2(72.0, 24.0),
            Label::new(text).halign(eframe::egui::Align::LEFT),
        );
        let response = ui.add(slider);
        place(&response, name);
        response.changed()
    })
    .inner
}
