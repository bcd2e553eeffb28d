//! Commands to the leg: buttons with what each will do, and sliders.

use crate::places::place;
use crate::shown_leg::ShownLeg;
use crate::text::why;
use crate::theme::palette;
use crate::value_slider::ValueSlider;
use egui::{Button, Checkbox, Label, RichText, Ui, vec2};
use leg_firmware::command::{Command, Compensation};
use leg_firmware::supervisor::{Event, State};
use std::ops::RangeInclusive;

/// The stiffness that the slider reaches: that of the paper's rig within the bounds of its tensions.
const STIFFNESS_NM_PER_RAD: RangeInclusive<f64> = 20.0..=170.0;

/// The heaviest payload of its slider, kg.
const PAYLOAD_MAX_KG: f64 = 2.0;

const PAYLOAD: ValueSlider = ValueSlider {
    name: "payload",
    text: "Payload",
    unit: " kg",
    decimals: 2,
    step: 0.05,
};
const PRETENSION: ValueSlider = ValueSlider {
    name: "pretension",
    text: "Pretension",
    unit: " N",
    decimals: 1,
    step: 0.0,
};
const STIFFNESS: ValueSlider = ValueSlider {
    name: "stiffness",
    text: "Stiffness",
    unit: " N·m/rad",
    decimals: 1,
    step: 0.0,
};

/// A command that a button sends.
struct Choice {
    name: &'static str,
    text: &'static str,
    /// What it will do.
    effect: &'static str,
    command: Command,
    /// Whether it means something now.
    useful: fn(&ShownLeg) -> bool,
}

/// What homing does to a leg with a payload.
const ZERO_SPOILED: &str = "finds a wrong zero: take the payload off first";

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
        effect: "leads it straight down, slackens the tendons, switches the drivers off",
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
            leg.faults().stopping().any() || matches!(leg.state(), State::Held | State::Off)
        },
    },
];

/// Shows the commands.
pub fn show(ui: &mut Ui, leg: &mut ShownLeg) {
    ui.heading("Drive it");
    let locked = leg.locked();
    for choice in &CHOICES {
        let useful = locked.is_none() && (choice.useful)(leg);
        ui.horizontal(|ui| {
            let button =
                ui.add_enabled(useful, Button::new(choice.text).min_size(vec2(72.0, 28.0)));
            place(&button, choice.name);
            let button = why(button, locked);
            let palette = palette(ui.ctx());
            let spoils = useful && choice.command == Command::Home && is_loaded(leg);
            let (effect, colour) = if spoils {
                (ZERO_SPOILED, palette.warning)
            } else {
                (choice.effect, palette.faint)
            };
            let effect = RichText::new(effect).small().color(colour);
            ui.add(Label::new(effect).wrap());
            if button.clicked() {
                leg.command(choice.command, choice.text);
            }
        });
    }
    refusal(ui, leg);
    compensation(ui, leg);
    sliders(ui, leg);
}

/// Whether a simulated leg has a payload: a live one may have a push.
fn is_loaded(leg: &ShownLeg) -> bool {
    leg.simulated().is_some_and(|leg| leg.payload_kg() > 0.0)
}

/// What was refused takes its room whether there is something or not: nothing moves.
fn refusal(ui: &mut Ui, leg: &ShownLeg) {
    let words = leg.refusal().unwrap_or_default();
    let text = RichText::new(words).small().color(palette(ui.ctx()).error);
    let size = vec2(ui.available_width(), 30.0);
    ui.allocate_ui(size, |ui| {
        ui.set_min_size(size);
        ui.add(Label::new(text).wrap());
    });
}

fn compensation(ui: &mut Ui, leg: &mut ShownLeg) {
    let on = leg.compensated();
    let mut chosen = on.unwrap_or_default();
    let toggle = Checkbox::new(&mut chosen, "Compensate the load").indeterminate(on.is_none());
    let locked = leg.locked();
    let toggle = ui.add_enabled(locked.is_none(), toggle);
    place(&toggle, "compensation");
    let clicked = toggle.clicked();
    why(toggle, locked).on_hover_text(match on {
        Some(_) => "The leg estimates the load from its tendons' tensions, and brings the tip back to its target.",
        None => "A leg does not report whether it does: a press switches it on.",
    });
    if !clicked {
        return;
    }
    let (compensation, name) = if chosen || on.is_none() {
        (Compensation::Estimated, "compensation on")
    } else {
        (Compensation::Off, "compensation off")
    };
    leg.command(Command::Compensation(compensation), name);
}

fn sliders(ui: &mut Ui, leg: &mut ShownLeg) {
    if let Some(simulation) = leg.simulated_mut() {
        let payload_kg = simulation.payload_kg();
        if let Some(payload_kg) = PAYLOAD.show(ui, payload_kg, 0.0..=PAYLOAD_MAX_KG, None) {
            simulation.hang(payload_kg);
        }
    }
    let Some(telemetry) = leg.telemetry().copied() else {
        return;
    };
    let (rig, locked) = (leg.rig(), leg.locked());
    let bounds_n = rig.f_min_n..=rig.f_max_n;
    let pretension_n = PRETENSION.show(ui, telemetry.pretension_n.into(), bounds_n, locked);
    if let Some(pretension_n) = pretension_n {
        leg.command(Command::Pretension(pretension_n as f32), "pretension");
    }
    let reported = telemetry.stiffness_nm_per_rad.into();
    if let Some(stiffness) = STIFFNESS.show(ui, reported, STIFFNESS_NM_PER_RAD, locked) {
        let demand = Command::Stiffness {
            demand_nm_per_rad: stiffness as f32,
            towards: None,
        };
        leg.command(demand, "stiffness");
    }
}
