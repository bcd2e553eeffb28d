#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::screen::draw;
use super::view::MonitorView;
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::{Fault, FaultSet, State};
use leg_firmware::telemetry::Telemetry;
use leg_rig::control_settings;
use leg_rig::rig_file::RigFile;
use ratatui::Terminal;
use ratatui::backend::TestBackend;

fn settings() -> Settings {
    let rig = RigFile::load(None).unwrap();
    control_settings::settings(&rig, &rig.gains, None)
}

fn telemetry() -> Telemetry<f32> {
    Telemetry {
        tick: 98_765,
        state: State::Held,
        faults: FaultSet::NONE,
        homed: true,
        failed_tendon: 0,
        moving: false,
        commanded: [0.25, 0.1],
        target: [0.25, 0.1],
        pose: [0.249, 0.101],
        residual_m: 1e-6,
        tensions_n: [7.5, 73.4, 149.0],
        target_tensions_n: [8.0, 73.0, 149.5],
        pulled_m: [0.001, 0.002, 0.003],
        reference_m: [0.001, 0.002, 0.003],
        motor_currents_a: [0.1, -0.2, 0.9],
        supply_v: 24.1,
        temperature_c: 31.4,
        pretension_commanded_n: Some(70.0),
        stiffness_commanded_nm_per_rad: None,
        pretension_n: 70.0,
        stiffness_nm_per_rad: 81.64,
        load_nm: [0.1, -0.4],
        payload_kg: 1.003,
        unstretched_at_zero_m: [0.038; 3],
        elongation_factor: 1.0,
    }
}

/// What a terminal of this size shows, line by line.
fn screen(view: &MonitorView, [width, height]: [u16; 2]) -> String {
    let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
    terminal.draw(|frame| draw(frame, view)).unwrap();
    let lines = terminal.backend().to_string();
    lines
        .lines()
        .map(|line| line.trim_matches('"').trim_end().to_string() + "\n")
        .collect()
}

/// Compares with what is stored; `LEG_SNAPSHOTS=overwrite` stores it anew.
fn compare(name: &str, shown: &str) {
    let file = format!(
        "{}/src/monitor/tests/{name}.txt",
        env!("CARGO_MANIFEST_DIR")
    );
    if std::env::var("LEG_SNAPSHOTS").is_ok_and(|what| what == "overwrite") {
        std::fs::write(&file, shown).unwrap();
    }
    assert_eq!(std::fs::read_to_string(&file).unwrap(), shown, "{name}");
}

#[test]
fn a_held_leg_with_two_faults() {
    let mut faults = FaultSet::single(Fault::CommandTimeout);
    faults.add(Fault::Unreachable, true);
    let mut view = MonitorView::new("the leg in this test, firmware 0.1.0", &settings());
    view.take(
        &Telemetry {
            faults,
            ..telemetry()
        },
        f64::NAN,
        0,
    );
    compare("held", &screen(&view, [80, 24]));
}

#[test]
fn a_leg_before_homing_on_a_narrow_terminal() {
    let mut view = MonitorView::new("/dev/ttyACM0, firmware 0.1.0", &settings());
    view.take(
        &Telemetry {
            state: State::Disarmed,
            homed: false,
            pretension_n: 0.0,
            stiffness_nm_per_rad: 0.0,
            payload_kg: 0.0,
            ..telemetry()
        },
        f64::NAN,
        3,
    );
    compare("not_homed", &screen(&view, [60, 24]));
}

#[test]
fn tendons_that_stretch_otherwise_are_told() {
    let told = |elongation_factor| {
        let mut view = MonitorView::new("a leg", &settings());
        let telemetry = Telemetry {
            elongation_factor,
            ..telemetry()
        };
        view.take(&telemetry, f64::NAN, 0);
        let screen = screen(&view, [80, 24]);
        screen.contains("elongation 1.183 of the settings'")
    };
    assert!(told(1.183) && !told(1.0));
}

#[test]
fn no_size_of_the_terminal_is_too_small() {
    let mut view = MonitorView::new("a leg", &settings());
    for size in [[1, 1], [10, 3], [20, 40]] {
        screen(&view, size);
        view.take(&telemetry(), f64::NAN, 0);
        screen(&view, size);
    }
}

#[test]
fn the_line_for_machines_holds_what_the_screen_shows() {
    let mut view = MonitorView::new("a leg", &settings());
    assert_eq!(view.json().unwrap(), None);
    view.take(
        &Telemetry {
            faults: FaultSet::single(Fault::Slack),
            ..telemetry()
        },
        1.7e9,
        2,
    );
    let line: serde_json::Value = serde_json::from_str(&view.json().unwrap().unwrap()).unwrap();
    assert_eq!(line["state"], "held");
    assert_eq!(line["damaged_frames"], 2);
    assert_eq!(line["faults"], serde_json::json!(["slack tendon"]));
    assert_eq!(line["wall_time_s"], 1.7e9);
    assert!(line["sag_m"].is_f64());
}

#[test]
fn the_sag_is_the_deviation_that_the_paper_has_for_the_pose() {
    let mut view = MonitorView::new("a leg", &settings());
    let (sine, azimuth) = (0.5, 30.0_f32.to_radians());
    view.take(
        &Telemetry {
            pose: [sine * azimuth.cos(), sine * azimuth.sin()],
            payload_kg: 2.0,
            ..telemetry()
        },
        f64::NAN,
        0,
    );
    // The maximum of Fig. 9 with 2 kg, which `leg paper` has as 8.417 mm.
    let sag_mm = view.sag_m().unwrap() * 1e3;
    assert!((sag_mm - 8.417).abs() < 0.01, "{sag_mm}");
}
