#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod board;

use super::line::{Heard, Line, Said};
use super::opening::{Opened, Opening};
use super::{LiveLeg, PageIdentity};
use crate::recorded_leg::RecordedLeg;
use crate::recorder::Recorder;
use crate::simulation::Simulation;
use leg_base::description::hex;
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::frame::{Decoder, MAX_FRAME, encode};
use leg_firmware::host_link::{HOST_SCHEMA, HostRefusal, HostReply, HostRequest, TelemetryReport};
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use leg_recording::{Samples, read_samples};
use leg_rig::control_settings;
use leg_rig::rig_file::RigFile;
use leg_rig::settings_text;
use serde_json::json;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

const PAGE: PageIdentity = PageIdentity {
    host: 77,
    first_number: 100,
};

/// The server's end of a line.
#[derive(Clone, Default)]
pub struct Server {
    heard: Rc<RefCell<VecDeque<Heard>>>,
    said: Rc<RefCell<Vec<Said>>>,
}

impl Line for Server {
    fn heard(&mut self) -> Option<Heard> {
        self.heard.borrow_mut().pop_front()
    }

    fn say(&mut self, said: Said) {
        self.said.borrow_mut().push(said);
    }
}

impl Server {
    pub fn text(&self, text: &str) {
        let heard = Heard::Text(text.into());
        self.heard.borrow_mut().push_back(heard);
    }

    fn role(&self, drives: bool, other_drives: bool) {
        self.text(&json!({"drives": drives, "other_drives": other_drives}).to_string());
    }

    fn reply(&self, number: u16, reply: &HostReply) {
        let mut out = [0; MAX_FRAME];
        let bytes = encode(number, reply, &mut out).unwrap().to_vec();
        self.heard.borrow_mut().push_back(Heard::Bytes(bytes));
    }

    pub fn report(&self, telemetry: Telemetry<f32>) {
        let report = TelemetryReport {
            number: 1,
            telemetry,
        };
        self.reply(0, &HostReply::Telemetry(report));
    }

    /// The commands that were sent since, with their numbers.
    fn commands(&self) -> Vec<(u16, Command)> {
        let mut decoder = Decoder::new();
        let mut commands = Vec::new();
        for said in self.said.borrow_mut().drain(..) {
            let Said::Bytes(bytes) = said else { continue };
            for byte in bytes {
                if let Some(Ok(frame)) = decoder.push(byte)
                    && let Some(HostRequest::Command { host, command }) = frame.message()
                {
                    assert_eq!(host, PAGE.host);
                    commands.push((frame.sequence, command));
                }
            }
        }
        commands
    }

    fn words(&self) -> Vec<&'static str> {
        let said = self.said.borrow_mut().drain(..).collect::<Vec<_>>();
        let text = |said| match said {
            Said::Text(text) => Some(text),
            Said::Bytes(_) => None,
        };
        said.into_iter().filter_map(text).collect()
    }
}

fn hello(schema: &str, rig: &str) -> String {
    json!({"hello": {"schema": schema, "name": "/dev/ttyACM0", "rig": rig}}).to_string()
}

fn rig_text() -> String {
    let rig = RigFile::load(None).unwrap();
    settings_text::rig_file(&control_settings::settings(&rig, &rig.gains, None))
}

fn open(server: &Server) -> Opened {
    Opening::new(Box::new(server.clone()), PAGE, "ws://127.0.0.1:1/secret").advance()
}

pub fn leg() -> (LiveLeg, Server) {
    let server = Server::default();
    server.text(&hello(&hex(&HOST_SCHEMA), &rig_text()));
    let Opened::Leg(mut leg) = open(&server) else {
        panic!("there is no leg");
    };
    server.role(false, false);
    leg.advance(1.0);
    (*leg, server)
}

fn driven() -> (LiveLeg, Server) {
    let (mut leg, server) = leg();
    server.role(true, false);
    leg.advance(1.0);
    (leg, server)
}

fn telemetry(state: State, tick: u32) -> Telemetry<f32> {
    let simulation = Simulation::new().unwrap();
    Telemetry {
        state,
        tick,
        ..*simulation.telemetry().unwrap()
    }
}

fn refusal(opened: Opened) -> String {
    match opened {
        Opened::Failed(words) => words,
        Opened::Waiting | Opened::Leg(_) => panic!("it is not refused"),
    }
}

#[test]
fn a_leg_has_the_settings_that_it_is_greeted_with() {
    let (leg, _) = leg();
    assert_eq!(leg.name(), "/dev/ttyACM0");
    let expected = RigFile::load(None).unwrap();
    let [is, was] = [leg.rig(), &expected].map(|rig| rig.parameters.leg_length_m);
    assert!((is - was).abs() < 1e-6);
}

#[test]
fn what_cannot_be_shown_is_refused_in_words() {
    let server = Server::default();
    assert!(matches!(open(&server), Opened::Waiting));
    server.text(&hello("0123456789abcdef", &rig_text()));
    assert!(refusal(open(&server)).contains("different versions"));
    server.text(&hello(&hex(&HOST_SCHEMA), "no rig"));
    assert!(!refusal(open(&server)).is_empty());
    let ended = Heard::Ended("gone".into());
    server.heard.borrow_mut().push_back(ended);
    let words = refusal(open(&server));
    assert!(
        words.contains("gone") && !words.contains("secret"),
        "{words}"
    );
}

#[test]
fn a_locked_leg_is_only_stopped() {
    for other_drives in [false, true] {
        let (mut leg, server) = leg();
        server.role(false, other_drives);
        leg.advance(1.0);
        assert!(leg.locked().is_some());
        leg.command(Command::Arm, "Arm");
        assert!(server.said.borrow().is_empty());
        leg.command(Command::Stop, "stop");
        assert_eq!(server.words(), ["stop"]);
    }
}

#[test]
fn the_lock_is_asked_for_and_not_taken() {
    let (mut leg, server) = leg();
    leg.unlock(true);
    assert!(leg.locked().is_some());
    assert_eq!(server.words(), ["drive"]);
    server.role(true, false);
    leg.advance(1.0);
    assert_eq!(leg.locked(), None);
    leg.unlock(false);
    assert_eq!(server.words(), ["release"]);
}

#[test]
fn an_answer_belongs_to_its_command_alone() {
    let (mut leg, server) = driven();
    leg.command(Command::Arm, "Arm");
    assert_eq!(server.commands(), [(101, Command::Arm)]);
    let refused = HostReply::Refused(HostRefusal::Command(CommandRefusal::NotHomed));
    for number in [0, 100, 102, u16::MAX] {
        server.reply(number, &refused);
    }
    leg.advance(1.1);
    assert_eq!(leg.refusal(), None);
    server.reply(101, &refused);
    leg.advance(1.2);
    let words = leg.refusal().unwrap();
    assert!(words.starts_with("Arm refused: "), "{words}");
}

#[test]
fn a_busy_leg_is_asked_again_and_a_silent_one_is_not_waited_for() {
    let (mut leg, server) = driven();
    leg.command(Command::Arm, "Arm");
    server.commands();
    server.reply(101, &HostReply::Refused(HostRefusal::Busy));
    leg.advance(1.1);
    assert_eq!(server.commands(), [(102, Command::Arm)]);
    leg.advance(2.5);
    assert!(leg.refusal().unwrap().contains("not answered"));
    leg.command(Command::Disarm, "Disarm");
    assert_eq!(server.commands(), [(103, Command::Disarm)]);
}

#[test]
fn signs_of_life_are_given_while_it_follows_commands_and_is_driven() {
    for (state, drives, alive) in [
        (State::Active, true, true),
        (State::Homing, true, true),
        (State::Active, false, false),
        (State::Disarmed, true, false),
        (State::Held, true, false),
    ] {
        let (mut leg, server) = leg();
        server.role(drives, false);
        server.report(telemetry(state, 1));
        let mut sent = 0;
        for frame in 0..60 {
            leg.advance(1.0 + f64::from(frame) / 60.0);
            let commands = server.commands();
            assert!(
                commands
                    .iter()
                    .all(|(_, command)| *command == Command::KeepAlive)
            );
            sent += commands.len();
        }
        // At most 50 ms apart.
        assert_eq!(sent >= 20, alive, "{state:?} {drives} {sent}");
        assert!(alive || sent == 0);
    }
}

#[test]
fn a_window_that_stands_still_gives_no_sign_of_life() {
    let (mut leg, server) = driven();
    server.report(telemetry(State::Active, 1));
    leg.advance(1.0);
    assert_eq!(server.commands().len(), 1);
    for (now_s, sent) in [(1.01, 0), (1.03, 1), (1.4, 1), (1.6, 0), (5.0, 0)] {
        leg.show_life(now_s);
        assert_eq!(server.commands().len(), sent, "{now_s}");
    }
}

/// From a clear on the leg waits for signs of life, and a page that draws slowly sees in its next frame alone that it follows.
#[test]
fn a_leg_that_begins_to_follow_between_frames_is_told_at_once() {
    let (mut leg, server) = driven();
    server.report(telemetry(State::Held, 1));
    leg.advance(1.0);
    leg.show_life(1.025);
    assert_eq!(server.commands().len(), 0);
    server.report(telemetry(State::Active, 2));
    leg.show_life(1.05);
    assert_eq!(server.commands().len(), 1);
}

#[test]
fn reports_are_charted_and_begin_anew_with_the_board() {
    let (mut leg, server) = leg();
    for tick in [8000, 8100, 8200] {
        server.report(telemetry(State::Active, tick));
    }
    leg.advance(1.0);
    assert_eq!(leg.time_s(), 1.025);
    let column = leg.history().named("tensions_n").unwrap();
    assert_eq!(leg.history().line(column, 0, 0.0).count(), 3);
    assert!(leg.history().named("tip_error_mm").is_none());
    server.report(telemetry(State::Disarmed, 10));
    leg.advance(1.1);
    assert_eq!(leg.history().line(column, 0, 0.0).count(), 1);
}

#[test]
fn silence_and_the_end_are_told() {
    let (mut leg, server) = driven();
    server.report(telemetry(State::Active, 1));
    leg.advance(1.5);
    assert_eq!(leg.failure(), None);
    leg.advance(3.0);
    assert!(leg.failure().unwrap().contains("does not answer"));
    server.report(telemetry(State::Active, 2));
    leg.advance(3.1);
    assert_eq!(leg.failure(), None);
    server.text(r#"{"lost":"unplugged"}"#);
    let ended = Heard::Ended("closed".into());
    server.heard.borrow_mut().push_back(ended);
    leg.advance(3.2);
    let words = leg.failure().unwrap();
    assert!(words.contains("unplugged") && words.contains("held by itself"));
    assert!(leg.locked().is_some());
}

/// A live leg is recorded as `leg log` does it: by its own time, with the time of the day.
#[test]
fn a_live_leg_is_recorded_as_a_log() {
    let (mut leg, server) = leg();
    let rig = RigFile::load(None).unwrap();
    let settings = control_settings::settings(&rig, &rig.gains, None);
    leg.recorder = Some(Recorder::new("/dev/ttyACM0", &settings, Some(1.7e9)).unwrap());
    let telemetry = *Simulation::new().unwrap().telemetry().unwrap();
    for tick in [8000, 8040, 8080] {
        server.report(Telemetry { tick, ..telemetry });
        leg.advance(f64::from(tick) / 8000.0);
    }
    let recorder = leg.recorder.take().unwrap();
    assert!((recorder.time_s() - 0.01).abs() < 1e-9);
    let bytes = recorder.finish().unwrap();
    let recorded = read_samples("leg.mcap", &bytes).unwrap();
    assert_eq!(recorded.about.begin_wall_time_s, Some(1.7e9));
    let Samples::Log(reports) = recorded.samples else {
        panic!("it is a log");
    };
    let ticks: Vec<u32> = reports
        .iter()
        .map(|(_, telemetry)| telemetry.tick)
        .collect();
    assert_eq!(ticks, [8000, 8040, 8080]);
    let opened = RecordedLeg::open("leg.mcap", &bytes).unwrap();
    assert_eq!(opened.span_s(), [1.0, 1.01]);
    assert!(!opened.seen(1.0).is_true);
    let column = opened.history.named("wall_time_s").unwrap();
    assert!(opened.history.numbers_at(column, 1.0)[0] > 1.6e9);
}

#[test]
fn a_recording_without_a_message_is_refused() {
    let rig = RigFile::load(None).unwrap();
    let settings = control_settings::settings(&rig, &rig.gains, None);
    let words = Recorder::new("leg", &settings, None).unwrap().finish();
    assert!(words.unwrap_err().contains("nothing was recorded"));
}
