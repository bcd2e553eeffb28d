//! Recordings, as their user makes and opens them.

use super::Window;
use super::setup::file;
use crate::app::Stage;
use crate::player::PlayerState;
use crate::recording_reader::MESSAGES_A_FRAME;
use egui::{Key, pos2};
use leg_firmware::supervisor::{Fault, State};
use leg_recording::{Samples, read_samples};
use leg_sim::plant::Defect;

impl Window {
    pub(super) fn recorded(&mut self) -> Vec<u8> {
        let Stage::Leg(leg) = &mut self.app.stage else {
            panic!("there is no leg");
        };
        let recorder = leg.recorder_mut().take();
        recorder.unwrap().finish().unwrap()
    }

    fn player(&self) -> PlayerState {
        self.app.player.as_ref().unwrap().state()
    }

    /// A recording of a leg that is loaded with 2 kg after some time.
    fn record_a_payload(&mut self) -> Vec<u8> {
        self.press("record");
        self.frames(50);
        self.press("guide_payload");
        self.frames(100);
        self.recorded()
    }

    /// Presses the slider of time at a part of its way.
    fn scrub(&mut self, part: f32) {
        let rect = self.app.places.rects["scrub"];
        let at = pos2(rect.left() + part * rect.width(), rect.center().y);
        self.press_at(at);
    }
}

#[test]
fn what_is_recorded_is_opened_and_scrubbed_and_the_leg_moves_along() {
    let mut window = Window::new();
    let bytes = window.record_a_payload();
    let now_kg = window.leg().payload_kg();
    window.drop_file(&file("made.mcap", &bytes));
    let start = window.player();
    assert_eq!(
        (start.name.ends_with("made.mcap"), start.finished),
        (true, true)
    );
    assert_eq!((start.payload_kg, start.state), (0.0, "active"));
    // Under its own weight.
    assert!(start.error_mm < 3.0, "{start:?}");
    let [begin_s, end_s] = start.span_s;
    assert!(end_s - begin_s > 2.0, "{start:?}");
    window.scrub(0.99);
    let end = window.player();
    assert!(end.at_s > begin_s + 0.9 * (end_s - begin_s), "{end:?}");
    assert!(end.payload_kg > 1.9 && end.error_mm > 5.0, "{end:?}");
    window.scrub(0.01);
    assert!(window.player().error_mm < 3.0);
    // The leg has gone on meanwhile, and is there again.
    assert!(!window.shows("guide_payload") && window.shows("stop"));
    window.press("back");
    assert!(window.shows("guide_payload") && !window.shows("scrub"));
    assert_eq!(window.leg().payload_kg(), now_kg);
}

/// The work of a frame is counted, not timed: no recording is so long that the window stands still.
#[test]
fn a_long_recording_is_read_in_parts_while_the_leg_goes_on() {
    let mut window = Window::new();
    window.press("record");
    window.frames(700);
    let bytes = window.recorded();
    let before_s = window.leg().leg().time_s();
    window.begin_to_read(&file("long.mcap", &bytes));
    let (mut read, mut frames, mut told) = (0, 0, false);
    while let Some(reader) = &window.app.reader {
        let messages = reader.messages();
        assert!(messages - read <= MESSAGES_A_FRAME + 1, "{messages} {read}");
        (read, frames) = (messages, frames + 1);
        told |= window.shows("notice");
        window.frames(1);
    }
    assert!(frames > 20 && told, "{frames} {read}");
    assert!(window.leg().leg().time_s() > before_s + 0.3);
    let [begin_s, end_s] = window.player().span_s;
    assert!(end_s - begin_s > 13.0, "{begin_s} {end_s}");
    window.frames(1);
    assert!(!window.shows("notice"));
}

#[test]
fn a_recording_is_played_to_its_end_and_then_from_its_beginning() {
    let mut window = Window::new();
    let bytes = window.record_a_payload();
    window.drop_file(&file("played.mcap", &bytes));
    let [begin_s, end_s] = window.player().span_s;
    window.press("play");
    window.frames(50);
    let before = window.player();
    window.frames(50);
    let after = window.player();
    assert!(
        after.playing && (after.at_s - before.at_s - 1.0).abs() < 0.05,
        "{before:?} {after:?}"
    );
    window.frames(200);
    let end = window.player();
    assert_eq!((end.playing, end.at_s), (false, end_s));
    window.press("play");
    let again = window.player();
    assert!(again.playing && again.at_s < begin_s + 1.0, "{again:?}");
}

#[test]
fn a_recorded_fault_is_named_and_a_key_stops_the_leg_behind_the_recording() {
    let mut window = Window::new();
    window.press("record");
    window.press("cut_1");
    window.frames(60);
    assert!(window.leg().has(Defect::TendonCut(0)));
    let faults = window.leg().faults();
    let bytes = window.recorded();
    window.press("start_again");
    assert_eq!(window.state(), State::Active);
    window.drop_file(&file("cut.mcap", &bytes));
    window.scrub(1.0);
    let names: Vec<_> = faults
        .faults()
        .map(|fault: Fault| fault.entry().name)
        .collect();
    assert!(!names.is_empty());
    assert_eq!(window.player().faults, names);
    assert_eq!(window.state(), State::Active);
    window.key(Key::Space);
    window.frames(5);
    assert_eq!(window.state(), State::Held);
    assert!(!window.player().playing);
}

#[test]
fn a_recording_is_one_of_leg_run_for_those_who_read_it() {
    let mut window = Window::new();
    let bytes = window.record_a_payload();
    let recorded = read_samples("leg.mcap", &bytes).unwrap();
    let name = &window.leg().source().name;
    assert_eq!(recorded.about.rig.as_ref(), Some(name));
    let Samples::Simulation(samples) = recorded.samples else {
        panic!("it is of a simulated leg");
    };
    assert!(samples.len() > 400, "{}", samples.len());
    for pair in samples.windows(2) {
        let step_s = pair[1].time_s - pair[0].time_s;
        assert!((step_s - 0.005).abs() < 1e-9, "{step_s}");
    }
    let last = samples.last().unwrap();
    assert!((f64::from(last.telemetry.tick - 1) / 8000.0 - last.time_s).abs() < 1e-9);
    assert!(last.comparison.commanded_error_mm() > 5.0);
}

/// Its messages have the leg's own time, whose zero is given a time of the day.
#[test]
fn a_recording_begins_at_the_time_of_the_day() {
    let mut window = Window::new();
    window.app.views.recordings.wall_clock = || Some(1_700_000_000.5);
    let began_s = window.leg().leg().time_s();
    let bytes = window.record_a_payload();
    let recorded = read_samples("leg.mcap", &bytes).unwrap();
    let zero_s = recorded.about.begin_wall_time_s.unwrap();
    let Samples::Simulation(samples) = recorded.samples else {
        panic!("it is of a simulated leg");
    };
    let first_s = zero_s + samples[0].time_s;
    // The record button is seen some frames after the leg's time was looked at.
    assert!(
        (0.0..0.2).contains(&(first_s - 1_700_000_000.5)),
        "{first_s}"
    );
    assert!(samples[0].time_s >= began_s);
}

#[test]
fn one_that_is_cut_off_goes_to_its_last_whole_message() {
    let mut window = Window::new();
    let bytes = window.record_a_payload();
    window.drop_file(&file("whole.mcap", &bytes));
    let whole = window.player();
    window.press("back");
    window.drop_file(&file("cut.mcap", &bytes[..bytes.len() / 2]));
    let cut = window.player();
    assert!(!cut.finished && window.shows("cut_off"));
    assert_eq!(cut.span_s[0], whole.span_s[0]);
    let parts = [&cut, &whole].map(|player| player.span_s[1] - player.span_s[0]);
    assert!(
        parts[0] > 0.3 * parts[1] && parts[0] < 0.7 * parts[1],
        "{parts:?}"
    );
}

#[test]
fn one_that_is_broken_is_refused_with_its_name_place_and_remedy_and_the_leg_stays() {
    let mut window = Window::new();
    let good = window.record_a_payload();
    let mut broken = good.clone();
    let middle = good.len() / 2;
    let digit = middle
        + good[middle..]
            .iter()
            .position(|byte| *byte == b'.')
            .unwrap()
        + 1;
    broken[digit] = if good[digit] == b'1' { b'2' } else { b'1' };
    for (bytes, place) in [
        (broken, "a part is damaged (its checksum is "),
        (Vec::new(), "is no whole MCAP file"),
        (b"PK\x03\x04".to_vec(), "is no whole MCAP file"),
        (good[..60].to_vec(), "holds no telemetry"),
    ] {
        window.drop_file(&file("given.mcap", &bytes));
        let state = serde_json::to_value(window.app.state()).unwrap();
        let words = [&state["setup"]["notice"], &state["setup"]["details"]];
        let [title, text] = words.map(|words| words.as_str().unwrap());
        assert!(title.contains("given.mcap is refused"), "{title}");
        assert!(
            text.contains("given.mcap") && text.contains(place),
            "{text}"
        );
        assert!(text.contains("help: "), "{text}");
        assert!(window.app.player.is_none());
        window.press("notice_close");
    }
}

#[test]
fn a_recording_does_not_grow_the_controls() {
    let mut window = Window::new();
    let places = |window: &Window| {
        ["record", "recording_open", "charts", "stop"].map(|name| window.app.places.rects[name])
    };
    let before = places(&window);
    let [record, _, charts, _] = before;
    assert!(record.top() > window.app.places.rects["leg"].bottom());
    assert!(charts.bottom() <= 720.0, "{charts:?}");
    window.press("record");
    window.frames(120);
    assert_eq!(places(&window), before);
}
