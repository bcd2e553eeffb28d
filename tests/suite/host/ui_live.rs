//! `leg ui` with a leg: pages hear it, and one of them drives it.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::ui::{Served, leg, refused};
use crate::board::emulated_board::board::BoardUnderTest;
use crate::common::stalls::PATIENCE;
use leg_base::description::hex;
use leg_firmware::command::Command;
use leg_firmware::frame::{self, Decoder, MAX_FRAME};
use leg_firmware::host_link::{HOST_SCHEMA, HostReply, HostRequest};
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, ErrorKind, Write};
use std::net::TcpStream;
use std::process::Stdio;
use std::time::{Duration, Instant};
use tempfile::NamedTempFile;
use tungstenite::client::IntoClientRequest;
use tungstenite::http::{HeaderValue, StatusCode};
use tungstenite::{Error, HandshakeError, Message, WebSocket, client};

/// The rig file of a slow leg that is held after so many seconds of silence, so that a busy machine does not have it held in mid-move.
fn patient(command_time_s: u32) -> NamedTempFile {
    let mut rig = NamedTempFile::new().unwrap();
    let table1 = READY_RIGS[0].text;
    let limits = format!("[control.limits]\ncommand_time_s = {command_time_s}\n");
    write!(
        rig,
        "{table1}\n{limits}[control.motion]\nspeed_rad_per_s = 0.05\n"
    )
    .unwrap();
    rig
}

/// What is heard in one turn.
#[derive(Default)]
struct Heard {
    texts: Vec<Value>,
    reports: Vec<Telemetry<f32>>,
    ended: bool,
}

/// A page as a test plays it.
struct Page {
    socket: WebSocket<TcpStream>,
    decoder: Decoder,
    host: u32,
    number: u16,
    /// The last that it heard.
    role: Value,
    telemetry: Option<Telemetry<f32>>,
}

/// After which a page that waits is taken to hang: an emulated chip that shares two cores with other tests needs more than `PATIENCE` to home.
const LONGEST: Duration = PATIENCE.saturating_mul(3);

/// Serves a leg that is emulated in the process.
fn served() -> Served {
    let rig = patient(2);
    Served::new(&["--on", "sim", "--rig", &rig.path().display().to_string()])
}

/// Opens a WebSocket as a browser does whose page comes from `origin`.
fn open(url: &str, origin: Option<&str>) -> Result<WebSocket<TcpStream>, StatusCode> {
    let address = url
        .strip_prefix("ws://")
        .unwrap()
        .split('/')
        .next()
        .unwrap();
    let stream = TcpStream::connect(address).unwrap();
    let mut request = url.into_client_request().unwrap();
    if let Some(origin) = origin {
        let origin = HeaderValue::from_str(origin).unwrap();
        request.headers_mut().insert("Origin", origin);
    }
    match client(request, stream) {
        Ok((socket, _)) => Ok(socket),
        Err(HandshakeError::Failure(Error::Http(answer))) => Err(answer.status()),
        Err(error) => panic!("{error}"),
    }
}

impl Page {
    /// A page of this server, and what it was told first.
    fn new(served: &Served) -> (Self, Value) {
        let socket = open(&served.leg, Some(&served.origin())).unwrap();
        let time = Some(Duration::from_millis(20));
        socket.get_ref().set_read_timeout(time).unwrap();
        let mut page = Self {
            socket,
            decoder: Decoder::new(),
            host: fastrand::u32(..),
            number: 0,
            role: Value::Null,
            telemetry: None,
        };
        let hello = page.heard_text("hello");
        (page, hello["hello"].clone())
    }

    fn turn(&mut self) -> Heard {
        let mut heard = Heard::default();
        match self.socket.read() {
            Ok(Message::Text(text)) => {
                let told: Value = serde_json::from_str(&text).unwrap();
                if told["drives"].is_boolean() {
                    self.role = told.clone();
                }
                heard.texts.push(told);
            }
            Ok(Message::Binary(bytes)) => {
                for byte in bytes {
                    if let Some(Ok(frame)) = self.decoder.push(byte)
                        && let Some(HostReply::Telemetry(report)) = frame.message()
                    {
                        heard.reports.push(report.telemetry);
                    }
                }
            }
            Ok(_) => heard.ended = true,
            Err(Error::Io(error)) if error.kind() == ErrorKind::WouldBlock => {}
            Err(_) => heard.ended = true,
        }
        self.telemetry = heard.reports.last().copied().or(self.telemetry);
        heard
    }

    /// Listens until something is so, and gives signs of life meanwhile.
    fn wait(&mut self, what: &str, mut done: impl FnMut(&Self, &Heard) -> bool) {
        let started = Instant::now();
        let mut alive = Instant::now();
        loop {
            let heard = self.turn();
            if done(self, &heard) {
                return;
            }
            assert!(started.elapsed() < LONGEST, "{what}: {:?}", self.telemetry);
            if alive.elapsed() > Duration::from_millis(50) && self.role["drives"] == true {
                self.command(Command::KeepAlive);
                alive = Instant::now();
            }
        }
    }

    fn heard_text(&mut self, key: &str) -> Value {
        let mut found = Value::Null;
        self.wait(key, |_, heard| {
            found = heard.texts.first().cloned().unwrap_or_default();
            found.get(key).is_some()
        });
        found
    }

    fn wait_for_state(&mut self, state: State) {
        self.wait("state", |page, _| {
            page.telemetry
                .is_some_and(|telemetry| telemetry.state == state)
        });
    }

    fn say(&mut self, word: &'static str) {
        self.socket.send(Message::text(word)).unwrap();
    }

    fn command(&mut self, command: Command) {
        let host = self.host;
        self.number += 1;
        let mut out = [0; MAX_FRAME];
        let request = HostRequest::Command { host, command };
        let bytes = frame::encode(self.number, &request, &mut out).unwrap();
        self.socket.send(Message::binary(bytes.to_vec())).unwrap();
    }

    /// Drives, and finds the zero.
    fn home(&mut self) {
        self.wait_for_state(State::Disarmed);
        self.say("drive");
        self.wait("role", |page, _| page.role["drives"] == true);
        self.command(Command::Home);
        self.wait_for_state(State::Homing);
        self.wait_for_state(State::Active);
    }

    /// Lets the leg lean a little, and comes back while it is on its way.
    fn begin_move(&mut self, x: f32) {
        self.command(Command::Arm);
        self.wait_for_state(State::Active);
        self.command(Command::Move { x, y: 0.0 });
        self.wait("moves", |page, _| {
            page.telemetry.is_some_and(|telemetry| telemetry.moving)
        });
    }
}

#[test]
fn nobody_else_is_let_in() {
    let served = served();
    let origin = served.origin();
    let (address, token) = served.leg.rsplit_once('/').unwrap();
    assert!(
        token.len() >= 32 && address.starts_with("ws://127.0.0.1:"),
        "{}",
        served.leg
    );
    let guessed = format!("{address}/{}", "0".repeat(token.len()));
    for (url, origin) in [
        (served.leg.as_str(), Some("http://example.org")),
        (&served.leg, Some("null")),
        (&served.leg, None),
        (&guessed, Some(origin.as_str())),
        (address, Some(&origin)),
    ] {
        assert_eq!(
            open(url, origin).err(),
            Some(StatusCode::FORBIDDEN),
            "{url} {origin:?}"
        );
    }
    assert!(open(&served.leg, Some(&origin)).is_ok());
}

#[test]
fn one_page_drives_and_every_page_stops() {
    let served = served();
    let (mut driving, hello) = Page::new(&served);
    assert_eq!(hello["schema"], hex(&HOST_SCHEMA));
    assert_eq!(hello["name"], "the leg in this process");
    RigFile::parse("hello", hello["rig"].as_str().unwrap()).unwrap();
    let (mut watching, _) = Page::new(&served);
    driving.say("drive");
    driving.wait("role", |page, _| page.role["drives"] == true);
    watching.say("drive");
    watching.wait("role", |page, _| {
        page.role == json!({ "drives": false, "other_drives": true })
    });
    // What a page commands that does not drive is not passed on.
    watching.command(Command::Arm);
    let mut reports = 0;
    watching.wait("reports", |_, heard| {
        assert!(
            heard
                .reports
                .iter()
                .all(|report| report.state == State::Disarmed)
        );
        reports += heard.reports.len();
        reports > 60
    });
    driving.begin_move(0.3);
    watching.wait_for_state(State::Active);
    watching.say("stop");
    driving.wait_for_state(State::Held);
    driving.say("release");
    watching.wait("role", |page, _| page.role["other_drives"] == false);
    watching.say("drive");
    watching.wait("role", |page, _| page.role["drives"] == true);
}

/// The board's own timeout holds it.
#[test]
fn the_leg_is_held_when_its_page_goes() {
    let served = served();
    let (mut driving, _) = Page::new(&served);
    let (mut watching, _) = Page::new(&served);
    driving.say("drive");
    driving.wait("role", |page, _| page.role["drives"] == true);
    driving.begin_move(0.4);
    drop(driving);
    watching.wait_for_state(State::Held);
    let pose = watching.telemetry.unwrap().pose;
    assert!(pose[0] < 0.35, "it was on its way: {pose:?}");
    watching.wait("role", |page, _| page.role["other_drives"] == false);
}

#[test]
fn a_page_that_sends_something_else_is_dropped() {
    let served = served();
    for (message, drives) in [
        (Message::text("fly"), false),
        // Longer than any message may be.
        (Message::binary([vec![1; 100_000], vec![0]].concat()), false),
        // A part of a frame would be mixed with the next page's.
        (Message::binary(vec![1, 2, 3]), true),
    ] {
        let (mut page, _) = Page::new(&served);
        if drives {
            page.say("drive");
            page.wait("role", |page, _| page.role["drives"] == true);
        }
        // One that is too long may be refused while it is sent.
        let _ = page.socket.send(message);
        page.wait("ended", |_, heard| heard.ended);
    }
    let (mut page, _) = Page::new(&served);
    page.wait("telemetry", |page, _| page.telemetry.is_some());
}

/// A leg in this place is heard by a page, which unlocks it and homes it.
fn homes(place: &str) {
    // The emulators take most of the processor.
    let rig = patient(30);
    let served = Served::new(&["--on", place, "--rig", &rig.path().display().to_string()]);
    Page::new(&served).0.home();
}

#[test]
fn a_page_homes_a_leg_in_the_process() {
    homes("sim");
}

#[test]
fn a_page_homes_a_leg_under_qemu() {
    homes("qemu");
}

#[test]
fn a_page_homes_a_leg_on_an_emulated_chip() {
    homes("chip");
}

#[test]
fn a_page_homes_a_leg_on_a_serial_port() {
    let board = BoardUnderTest::new(&["--slack"]);
    let served = Served::new(&["--port", &board.port]);
    let (mut page, hello) = Page::new(&served);
    assert_eq!(hello["name"], board.port);
    page.home();
}

#[test]
fn every_start_has_a_token_of_its_own() {
    let [one, other] = [served(), served()];
    let token = |served: &Served| served.leg.rsplit('/').next().unwrap().to_owned();
    assert_ne!(token(&one), token(&other));
    // A page that knows the token of another start is refused.
    let guessed = one.leg.replace(&token(&one), &token(&other));
    assert_eq!(
        open(&guessed, Some(&one.origin())).err(),
        Some(StatusCode::FORBIDDEN)
    );
}

/// A bus needs a machine that has one: what is shown of a leg on it is what is shown of one on a serial line.
#[test]
fn a_bus_that_is_not_there_is_refused_by_name() {
    let told = refused(&["ui", "--no-open", "--can", "no-such0"]);
    assert!(told.contains("no CAN interface `no-such0`"), "{told}");
}

#[test]
fn ctrl_c_ends_it_and_the_pages_are_told() {
    let mut served = served();
    let (mut page, _) = Page::new(&served);
    served.interrupt();
    let lost = page.heard_text("lost");
    assert!(
        lost["lost"].as_str().unwrap().contains("has ended"),
        "{lost}"
    );
    page.wait("ended", |_, heard| heard.ended);
    assert_eq!(served.wait(), Some(0));
}

#[test]
fn the_pages_are_told_when_the_leg_is_lost() {
    let mut board = leg(&["emulate", "--tcp", "--json"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut line = String::new();
    let mut output = BufReader::new(board.stdout.take().unwrap());
    output.read_line(&mut line).unwrap();
    let told: Value = serde_json::from_str(&line).unwrap();
    let mut served = Served::new(&["--port", told["port"].as_str().unwrap()]);
    let (mut page, hello) = Page::new(&served);
    assert_eq!(hello["name"], told["port"]);
    page.wait("telemetry", |page, _| page.telemetry.is_some());
    board.kill().unwrap();
    board.wait().unwrap();
    page.heard_text("lost");
    assert_eq!(served.wait(), Some(1));
}
