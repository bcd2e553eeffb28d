//! Values that are typed beside their sliders.

use super::Window;
use egui::{Event, Key, pos2};
use leg_firmware::command::Command;

/// A window in which a text stands in the field of a value, and is not chosen yet.
fn typed(name: &str, text: &str) -> Window {
    let mut window = Window::new();
    window.frames(50);
    let rect = window.rect(name);
    window.press_at(pos2(rect.right() - 12.0, rect.center().y));
    for letter in text.chars() {
        window.frame(vec![Event::Text(letter.into())]);
        window.frames(5);
    }
    window
}

fn pretension_n(window: &Window) -> f32 {
    window.leg().telemetry().unwrap().pretension_n
}

/// Its first digit would be the least pretension that a leg may have.
#[test]
fn a_value_is_chosen_when_it_is_typed_to_its_end() {
    let mut window = typed("pretension", "90");
    assert!((pretension_n(&window) - 70.0).abs() < 0.5);
    window.key(Key::Enter);
    window.frames(150);
    assert!((pretension_n(&window) - 90.0).abs() < 0.5);
}

/// The leg reports another stiffness in every frame.
#[test]
fn what_is_typed_stays_while_the_leg_reports() {
    let mut window = typed("stiffness", "100");
    assert!(window.texts.contains(&"100".to_owned()));
    window.key(Key::Enter);
    window.frames(150);
    let stiffness = window.leg().telemetry().unwrap().stiffness_nm_per_rad;
    assert!((stiffness - 100.0).abs() < 2.0, "{stiffness} N·m/rad");
    // The field shows what the leg reports again.
    let leg = window.app.stage.leg_mut();
    leg.command(Command::Pretension(60.0), "pretension");
    window.frames(150);
    let reported = window.leg().telemetry().unwrap().stiffness_nm_per_rad;
    assert!((reported - 100.0).abs() > 10.0, "{reported} N·m/rad");
    let shown = format!("{reported:.1}");
    assert!(window.texts.contains(&shown), "{shown}: {:?}", window.texts);
}

#[test]
fn what_is_no_number_and_what_is_too_large_hang_nothing_wrong() {
    for (text, expected_kg) in [
        ("NaN", 0.0),
        ("inf", 0.0),
        ("two", 0.0),
        ("1.5", 1.5),
        ("99", 2.0),
    ] {
        let mut window = typed("payload", text);
        window.key(Key::Enter);
        window.frames(10);
        assert_eq!(window.leg().payload_kg(), expected_kg, "{text}");
    }
}
