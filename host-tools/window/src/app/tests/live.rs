//! A live leg, as its user sees it.

use super::Window;
use crate::app::{App, Stage};
use crate::layout::Views;
use crate::live_leg::tests::{Server, leg};
use crate::shown_leg::ShownLeg;
use crate::simulation::Simulation;
use egui::{Context, vec2};
use leg_firmware::supervisor::{Fault, FaultSet, State};
use leg_firmware::telemetry::Telemetry;
use leg_recording::read_samples;

/// A window with a live leg that reports something.
fn live() -> (Window, Server) {
    let (leg, server) = leg();
    let stage = Stage::Leg(ShownLeg::Live(Box::new(leg)));
    let ctx = Context::default();
    let app = App::show_stage(&ctx, stage, Views::new(true));
    let mut window = Window::with(app, ctx, vec2(1280.0, 720.0));
    report(&mut window, &server);
    (window, server)
}

fn report(window: &mut Window, server: &Server) {
    let telemetry = *Simulation::new().unwrap().telemetry().unwrap();
    server.report(Telemetry {
        state: State::Active,
        faults: FaultSet::single(Fault::BadFrame),
        ..telemetry
    });
    window.frames(3);
}

#[test]
fn tendons_that_stretch_otherwise_are_told() {
    let (mut window, server) = live();
    assert!(!window.says("elongation"));
    let telemetry = *Simulation::new().unwrap().telemetry().unwrap();
    server.report(Telemetry {
        elongation_factor: 1.183,
        ..telemetry
    });
    window.frames(3);
    assert!(window.says("elongation") && window.says("1.18 ×"));
}

fn spoken(window: &Window) -> String {
    let state = serde_json::to_value(window.app.state()).unwrap();
    state["spoken"].as_str().unwrap().into()
}

#[test]
fn nothing_is_said_to_be_known_of_a_leg_that_is_lost() {
    for lost in [true, false] {
        let (mut window, server) = live();
        assert!(window.says("active") && window.says("bad frames"));
        assert_eq!(spoken(&window), "The leg is active. Faults: bad frames.");
        if lost {
            server.text(r#"{"lost":"unplugged"}"#);
        } else {
            // Silent.
            window.time_s += 2.0;
        }
        window.frames(3);
        assert!(!window.says("active") && !window.says("✔ none") && !window.says("bad frames"));
        let told = window.texts.iter().filter(|text| *text == "not known");
        assert_eq!(told.count(), 2, "{:?}", window.texts);
        assert!(window.says("as last heard"));
        let spoken = spoken(&window);
        assert!(
            spoken.starts_with("The state of the leg is not known."),
            "{spoken}"
        );
        window.size = vec2(390.0, 844.0);
        window.frames(3);
        assert!(window.says("Faults: not known"), "{:?}", window.texts);
    }
    let (mut window, server) = live();
    window.time_s += 2.0;
    window.frames(3);
    report(&mut window, &server);
    assert!(window.says("active"), "{:?}", window.texts);
}

/// As those of `leg log`.
#[test]
fn a_recording_of_it_begins_at_the_time_of_the_day() {
    let (mut window, server) = live();
    window.app.views.recordings.wall_clock = || Some(1_700_000_000.250_7);
    window.press("record");
    report(&mut window, &server);
    let bytes = window.recorded();
    let about = read_samples("leg.mcap", &bytes).unwrap().about;
    assert_eq!(about.begin_wall_time_s, Some(1_700_000_000.25));
}
