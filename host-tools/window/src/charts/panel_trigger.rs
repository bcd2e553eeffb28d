//! How the trigger is set.

use super::SignalSource;
use super::trigger::{Edge, Mode, Trigger};
use crate::places::place;
use egui::{ComboBox, DragValue, PopupCloseBehavior, RichText, Ui};

/// What a drag of the level is worth, as a part of its size, and at least.
const LEVEL_PART: f64 = 0.01;
const LEVEL_STEP: f64 = 0.01;

/// Shows it, for the signals that are charted. Whether it was armed: the charts go on.
pub(super) fn show(
    ui: &mut Ui,
    trigger: &mut Trigger,
    chosen: &[&'static str],
    source: &SignalSource<'_>,
) -> bool {
    let menu = ComboBox::from_id_salt("trigger")
        .selected_text(
            RichText::new(format!("Trigger {}", trigger.words()))
                .monospace()
                .size(11.5),
        )
        .width(205.0)
        // All of it, without a scroll bar.
        .height(420.0)
        .close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let menu = menu.show_ui(ui, |ui| {
        ui.set_min_width(240.0);
        signals(ui, trigger, chosen, source);
        ui.separator();
        conditions(ui, trigger, source);
        ui.separator();
        arming(ui, trigger, source)
    });
    place(&menu.response, "trigger");
    let hint = "The charts stand still around the time at which a signal passes a level.";
    menu.response.on_hover_text(hint);
    menu.inner.unwrap_or(false)
}

/// Which number of which signal.
fn signals(ui: &mut Ui, trigger: &mut Trigger, chosen: &[&'static str], source: &SignalSource<'_>) {
    let columns = chosen.iter().filter_map(|name| source.history.named(name));
    for column in columns {
        for number in 0..column.width {
            let text = if column.width > 1 {
                format!("{} {}", column.name(), number + 1)
            } else {
                column.name().into()
            };
            let this = trigger.signal == Some(column.name()) && trigger.number == number;
            let choice = ui.radio(this, RichText::new(text).monospace());
            place(&choice, format!("trigger_{}_{}", column.name(), number + 1));
            if choice.clicked() && !this {
                trigger.disarm();
                (trigger.signal, trigger.number) = (Some(column.name()), number);
                // A level at which it is now is passed soon.
                let now = source.history.last(column).get(number);
                let now = now.map_or(0.0, |value| f64::from(*value));
                trigger.level = if now.is_finite() { now } else { 0.0 };
            }
        }
    }
}

/// When it has passed.
fn conditions(ui: &mut Ui, trigger: &mut Trigger, source: &SignalSource<'_>) {
    let column = trigger.signal.and_then(|name| source.history.named(name));
    let unit = column.map_or_else(String::new, |column| format!(" {}", column.unit()));
    ui.horizontal(|ui| {
        for (edge, text, name) in [
            (Edge::Rising, "rises above", "trigger_rising"),
            (Edge::Falling, "falls below", "trigger_falling"),
        ] {
            place(&ui.selectable_value(&mut trigger.edge, edge, text), name);
        }
        let speed = LEVEL_PART * trigger.level.abs() + LEVEL_STEP;
        let level = DragValue::new(&mut trigger.level)
            .speed(speed)
            .suffix(unit)
            .max_decimals(4);
        place(&ui.add(level), "trigger_level");
    });
    ui.horizontal(|ui| {
        for (mode, text, name) in [
            (Mode::Once, "once", "trigger_once"),
            (Mode::Again, "again and again", "trigger_again"),
        ] {
            place(&ui.selectable_value(&mut trigger.mode, mode, text), name);
        }
    });
}

/// Whether it was armed.
fn arming(ui: &mut Ui, trigger: &mut Trigger, source: &SignalSource<'_>) -> bool {
    if trigger.signal.is_none() {
        ui.label("Choose a signal.");
        return false;
    }
    let text = if trigger.armed() {
        "Disarm"
    } else if trigger.caught_s().is_some() {
        "Rearm"
    } else {
        "Arm"
    };
    let button = ui.button(text);
    place(&button, "trigger_arm");
    if !button.clicked() {
        return false;
    }
    if trigger.armed() {
        trigger.disarm();
        return false;
    }
    trigger.arm(source.now_s);
    true
}
