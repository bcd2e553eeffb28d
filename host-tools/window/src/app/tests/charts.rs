//! Charts, as their user reads them.

use super::Window;
use crate::charts::ChartsState;
use egui::{Event, Modifiers, PointerButton, Pos2, pos2};
use std::collections::BTreeMap;

impl Window {
    fn charts(&self) -> ChartsState {
        self.app.views.charts.state()
    }

    /// A place in a chart.
    fn chart_position(&self, name: &str, part: f32) -> Pos2 {
        let rect = self.app.places.rects[name];
        pos2(rect.left() + part * rect.width(), rect.center().y)
    }

    fn drag(&mut self, from: Pos2, to: Pos2) {
        let button = |pos, pressed| Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        self.frame(vec![Event::PointerMoved(from)]);
        self.frame(vec![button(from, true)]);
        for step in 1..=8_u8 {
            let at = from + (to - from) * (f32::from(step) / 8.0);
            self.frame(vec![Event::PointerMoved(at)]);
        }
        self.frame(vec![button(to, false)]);
        self.frame(vec![Event::PointerMoved(Pos2::ZERO)]);
        self.frames(2);
    }
}

#[test]
fn two_cursors_are_dragged_and_stay_on_the_screen() {
    let mut window = Window::new();
    window.frames(100);
    window.press("cursors");
    let before = window.charts();
    assert!(before.paused && window.shows("cursor_times") && window.shows("values_tensions_n"));
    let [a_s, b_s] = before.cursors_s.unwrap();
    assert!(a_s < b_s);
    let [from, to] = [0.25, 0.15].map(|part| window.chart_position("tensions_n", part));
    window.drag(from, to);
    let after = window.charts().cursors_s.unwrap();
    assert_eq!(after[0], a_s);
    assert!(after[1] < b_s, "{after:?}");
    assert!(window.app.places.rects["charts"].bottom() <= 720.0);
    window.press("pause");
    assert!(window.charts().cursors_s.is_none() && !window.charts().paused);
}

/// A slow page sees that a cursor is let go and where the pointer went then in one frame.
#[test]
fn a_cursor_stays_where_it_was_let_go() {
    let mut window = Window::new();
    window.frames(100);
    window.press("cursors");
    let [from, to] = [0.7, 0.8].map(|part| window.chart_position("tensions_n", part));
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    window.frame(vec![Event::PointerMoved(from)]);
    window.frame(vec![button(from, true)]);
    window.frame(vec![Event::PointerMoved(to)]);
    let [a_s, b_s] = window.charts().cursors_s.unwrap();
    window.frame(vec![button(to, false), Event::PointerMoved(pos2(2.0, 2.0))]);
    window.frames(3);
    assert_eq!(window.charts().cursors_s, Some([a_s, b_s]));
    assert!(b_s > a_s && a_s > 0.0);
}

#[test]
fn axes_have_the_units_of_their_signals() {
    let mut window = Window::new();
    window.press("guide_payload");
    window.frames(60);
    for end in [" mm", " N", " s"] {
        let labels = window.texts.iter().filter(|text| {
            let number = text.strip_suffix(end);
            number.is_some_and(|number| number.parse::<f64>().is_ok())
        });
        assert!(labels.count() >= 2, "{end}: {:?}", window.texts);
    }
}

#[test]
fn a_chart_that_stands_still_is_zoomed_and_a_double_click_shows_it_whole() {
    let mut window = Window::new();
    window.frames(200);
    window.press("pause");
    let width_s = |window: &Window| window.charts().zoomed_s.map(|[a, b]| b - a);
    let before_s = width_s(&window).unwrap();
    let at = window.chart_position("tensions_n", 0.5);
    window.frame(vec![Event::PointerMoved(at)]);
    window.frame(vec![Event::Zoom(2.0)]);
    window.frames(3);
    let after_s = width_s(&window).unwrap();
    assert!(
        (before_s / after_s - 2.0).abs() < 0.1,
        "{before_s} {after_s}"
    );
    // Later than a third click would count.
    window.frames(30);
    for pressed in [true, false, true, false] {
        window.frame(vec![Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        }]);
        // A page that is slow: 0.4 s from one click to the next.
        window.frames(9);
    }
    assert_eq!(width_s(&window), None);
}

#[test]
fn a_trigger_catches_the_load_and_the_chart_stands_still_around_it() {
    let mut window = Window::new();
    window.frames(20);
    window.press("trigger");
    window.press("trigger_tip_error_mm_1");
    window.type_value("trigger_level", "4.5");
    window.press("trigger_arm");
    window.press("trigger");
    assert!(window.charts().armed && !window.charts().paused);
    window.press("guide_payload");
    window.frames(150);
    assert!(!window.charts().paused);
    window.frames(200);
    let caught = window.charts();
    assert!(caught.paused && !caught.armed, "{caught:?}");
    let at_s = caught.caught_s.unwrap();
    let [since_s, until_s] = caught.zoomed_s.unwrap();
    assert!(
        (0.5 * (since_s + until_s) - at_s).abs() < 0.05,
        "{caught:?}"
    );
    assert!((until_s - since_s - 10.0).abs() < 0.05, "{caught:?}");
    window.press("trigger");
    window.press("trigger_arm");
    assert!(window.charts().armed && !window.charts().paused);
    window.press("pause");
    window.press("pause");
    assert!(!window.charts().armed);
}

/// Nothing of the row of controls moves when their words change.
#[test]
fn controls_stay_in_their_places() {
    let mut window = Window::new();
    let controls = [
        "pause",
        "trigger",
        "cursors",
        "spectra",
        "record",
        "recording_open",
    ];
    let places = |window: &Window| -> BTreeMap<_, _> {
        let rects = &window.app.places.rects;
        controls.map(|name| (name, rects[name])).into()
    };
    let before = places(&window);
    window.press("trigger");
    window.press("trigger_tip_error_mm_1");
    window.press("trigger_arm");
    window.press("trigger");
    window.press("pause");
    assert_eq!(places(&window), before);
}

#[test]
fn a_spectrum_names_its_highest_peak() {
    let mut window = Window::new();
    window.frames(300);
    window.press("spectra");
    window.frames(3);
    assert!(window.shows("spectrum_tensions_n") && window.shows("peak_tensions_n"));
    let [hz, amplitude_n] = window.charts().peaks["tensions_n"];
    assert!(
        hz > 0.0 && hz <= 100.0 && amplitude_n > 0.0,
        "{hz} {amplitude_n}"
    );
    assert!(window.app.places.rects["charts"].bottom() <= 720.0);
    window.press("spectra");
    assert!(window.shows("tensions_n") && window.charts().peaks.is_empty());
}

#[test]
fn the_stiffness_of_the_tip_is_drawn_with_its_scale() {
    let mut window = Window::new();
    assert!(!window.shows("stiffness_words"));
    window.press("stiffness_ellipse");
    assert!(window.shows("stiffness_words"));
}
