//! The state of the leg, the stop, and how the window looks.

use crate::pace::Pace;
use crate::places::place;
use crate::shown_leg::ShownLeg;
use crate::theme::{Palette, palette};
use egui::{
    Align, Align2, Button, Color32, ComboBox, FontId, Frame, Label, Layout, Margin, Pos2, RichText,
    Sense, Stroke, StrokeKind, Theme, Ui, pos2, vec2,
};
use leg_base::description;
use leg_firmware::command::Command;
use leg_firmware::supervisor::State;

/// How fast the leg's time goes beside the clock's: the value, its text, the same where there is little room, its name for tests.
const RATES: [(f64, &str, &str, &str); 5] = [
    (8.0, "×8", "×8", "rate_8"),
    (1.0, "real time", "×1", "rate_1"),
    (0.1, "1/10", "1/10", "rate_tenth"),
    (0.01, "1/100", "1/100", "rate_hundredth"),
    (0.0, "stand still", "×0", "rate_0"),
];

/// What is said of a leg that is not heard.
pub const NOT_KNOWN: &str = "not known";

/// What is said of a leg that is none.
const SIMULATED: &str = "SIMULATED";

/// Height of the bar, points.
const HEIGHT: f32 = 38.0;

/// Below this width there is no room for everything, points.
const ROOMY: f32 = 760.0;

/// Below this one there is none for what the window is, points.
const WIDE: f32 = 1100.0;

/// Below this one everything is smaller, points.
const SLIM: f32 = 385.0;

/// Less time that was left out is not shown, s.
const LEFT_OUT_MIN_S: f64 = 0.005;

/// Shows the bar, with the time and the switch between the leg and what it is set to where these are not elsewhere.
pub fn show(ui: &mut Ui, leg: &mut ShownLeg, side_by_side: bool, setup: Option<&mut bool>) {
    let palette = palette(ui.ctx());
    let roomy = ui.available_width() > ROOMY;
    let wide = ui.available_width() > WIDE;
    let slim = is_slim(ui);
    if slim {
        ui.spacing_mut().item_spacing.x = 4.0;
        ui.spacing_mut().button_padding.x = 5.0;
    }
    let size = vec2(ui.available_width(), HEIGHT);
    ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_size(size);
        if wide || roomy && !side_by_side {
            ui.label(RichText::new("Tendon-driven leg").size(18.0).strong());
            ui.add_space(8.0);
        }
        let beside = roomy || leg.live().is_some();
        if beside {
            origin(ui, leg, roomy, &palette);
        }
        let above = (!beside).then_some(SIMULATED);
        chip(ui, leg.known_state(), above, &palette);
        if side_by_side {
            time(ui, leg);
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            stop(ui, leg, &palette, roomy);
            appearance(ui);
            if let Some(open) = setup {
                let button = ui.add(Button::new("Set up").selected(*open));
                place(&button, "setup");
                let hint = "Rig files and settings, in the place of the leg.";
                if button.on_hover_text(hint).clicked() {
                    *open = !*open;
                }
            }
            if let Some(simulated) = leg.simulated_mut() {
                rate(ui, &mut simulated.pace, slim);
                if wide {
                    let what = "firmware and simulated leg run in this window";
                    ui.label(RichText::new(what).small().color(palette.faint));
                }
            }
        });
    });
}

/// The time of the leg, and what was left out of it.
pub fn time(ui: &mut Ui, leg: &ShownLeg) {
    let words = format!("{:8.2} s", leg.time_s());
    let shown = ui.label(RichText::new(words).monospace());
    place(&shown, "time");
    let left_out_s = leg
        .simulated()
        .map_or(0.0, |simulation| simulation.pace.left_out_s());
    if left_out_s < LEFT_OUT_MIN_S {
        return;
    }
    let words = RichText::new(format!("left out: {left_out_s:.2} s"));
    let shown = ui.label(words.small().color(palette(ui.ctx()).warning));
    place(&shown, "left_out");
    shown.on_hover_text(
        "Time that the leg is behind the clock: the window was hidden, or this machine is too slow.",
    );
}

/// Whether the leg is a machine, and which.
fn origin(ui: &mut Ui, leg: &ShownLeg, roomy: bool, palette: &Palette) {
    let (word, name, colour) = match leg.live() {
        Some(live) => ("LIVE", live.name(), palette.danger),
        None => (SIMULATED, "", palette.faint),
    };
    let label = Frame::NONE
        .fill(colour.gamma_multiply(0.3))
        .stroke(Stroke::new(1.0, colour))
        .corner_radius(3.0)
        .inner_margin(Margin::symmetric(5, 1));
    let shown = label.show(ui, |ui| {
        ui.label(RichText::new(word).small().strong());
    });
    place(&shown.response, "origin");
    if roomy && !name.is_empty() {
        let name = Label::new(RichText::new(name).monospace()).truncate();
        place(&ui.add(name), "name");
    }
}

fn is_slim(ui: &Ui) -> bool {
    ui.ctx().viewport_rect().width() < SLIM
}

/// What a leg may do, if that is known; with a word above it, if that has no other place.
pub fn chip(ui: &mut Ui, state: Option<State>, above: Option<&str>, palette: &Palette) {
    let colour = match state {
        Some(State::Active | State::KeepingStation | State::Homing) => palette.good,
        None | Some(State::Held | State::RampingDown | State::Off) => palette.error,
        Some(State::Boot | State::Disarmed | State::Jogging) => palette.faint,
    };
    let (width, size) = if is_slim(ui) {
        (84.0, 11.5)
    } else {
        (118.0, 14.0)
    };
    let height = if above.is_some() { HEIGHT } else { 30.0 };
    let (rect, chip) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
    let (line, painter) = (Stroke::new(1.5, colour), ui.painter());
    painter.rect_stroke(rect, 6.0, line, StrokeKind::Inside);
    let words = state.map_or(NOT_KNOWN, description::state);
    let write = |at: Pos2, words: &str, size: f32, colour: Color32| {
        let font = FontId::proportional(size);
        painter.text(at, Align2::CENTER_CENTER, words, font, colour);
    };
    match above {
        None => write(rect.center(), words, size, colour),
        Some(above) => {
            let [upper, lower] = [0.27, 0.66].map(|part| {
                let y = rect.top() + part * rect.height();
                pos2(rect.center().x, y)
            });
            write(upper, above, 9.5, palette.faint);
            write(lower, words, size, colour);
        }
    }
    place(&chip, "state");
}

fn stop(ui: &mut Ui, leg: &mut ShownLeg, palette: &Palette, roomy: bool) {
    let text = if roomy { "STOP (space)" } else { "STOP" };
    let text = RichText::new(text)
        .color(Color32::WHITE)
        .strong()
        .size(17.0);
    let width = if roomy { 150.0 } else { 84.0 };
    let button = ui.add(
        Button::new(text)
            .fill(palette.danger)
            .min_size(vec2(width, HEIGHT)),
    );
    place(&button, "stop");
    let hint = "Holds the leg where it is until Clear. The space bar and Esc do the same.";
    if button.on_hover_text(hint).clicked() {
        leg.command(Command::Stop, "stop");
    }
}

fn appearance(ui: &mut Ui) {
    let (text, next) = match ui.ctx().theme() {
        Theme::Dark => ("Light", Theme::Light),
        Theme::Light => ("Dark", Theme::Dark),
    };
    let button = ui.button(text).on_hover_text("Light or dark.");
    place(&button, "theme");
    if button.clicked() {
        ui.ctx().set_theme(next);
    }
}

fn rate(ui: &mut Ui, pace: &mut Pace, slim: bool) {
    let rate = &mut pace.rate;
    let shown = RATES.iter().find(|(value, ..)| value == rate);
    let text = shown.map_or("", |(_, text, short, _)| if slim { short } else { text });
    let choice = ComboBox::from_id_salt("rate")
        .selected_text(text)
        .width(if slim { 58.0 } else { 88.0 });
    let choice = choice.show_ui(ui, |ui| {
        for (value, text, _, name) in RATES {
            place(&ui.selectable_value(rate, value, text), name);
        }
    });
    place(&choice.response, "rate");
}
