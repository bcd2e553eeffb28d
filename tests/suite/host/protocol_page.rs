//! `firmware/PROTOCOL.md`: its messages are those of the firmware, its exchange is decoded. `other_programs` runs its client.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod grammar;
mod recorder;
mod two_hashes;

use leg_boards::image::workspace_root;
use leg_firmware::can::{Assembler, Identifier, LegAddress, Segmenter};
use leg_firmware::command::Command;
use leg_firmware::frame::{self, Decoder, MAX_FRAME};
use leg_firmware::host_link::{
    BoardKind, HOST_SCHEMA, Hello, HostId, HostRefusal, HostReply, HostRequest, Identity,
    ResetCause,
};
use leg_firmware::version::VERSION;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::Write;
use std::path::PathBuf;
use std::{env, fs};

/// What stands before the client's schema.
const SCHEMA_OF_CLIENT: &str = "SCHEMA = bytes.fromhex(\"";

fn page() -> PathBuf {
    workspace_root().join("firmware/PROTOCOL.md")
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        write!(text, "{byte:02x}").unwrap();
        text
    })
}

/// A frame; it is decoded again before it is shown.
fn framed<T>(number: u16, message: &T) -> Vec<u8>
where
    T: Serialize + DeserializeOwned + PartialEq + std::fmt::Debug,
{
    let mut out = [0; MAX_FRAME];
    let bytes = frame::encode(number, message, &mut out).unwrap();
    let mut decoder = Decoder::new();
    let (last, first) = bytes.split_last().unwrap();
    assert!(first.iter().all(|byte| decoder.push(*byte).is_none()));
    let decoded = decoder.push(*last).unwrap().unwrap();
    assert_eq!(decoded.sequence, number);
    assert_eq!(decoded.message::<T>().as_ref(), Some(message));
    bytes.to_vec()
}

/// A frame as hexadecimal digits.
fn frame_hex<T>(number: u16, message: &T) -> String
where
    T: Serialize + DeserializeOwned + PartialEq + std::fmt::Debug,
{
    hex(&framed(number, message))
}

/// The requests of a host that begins, as the CAN frames to leg 3; they are put together again before they are shown.
fn segments() -> String {
    let leg = LegAddress::new(3).unwrap();
    let identifier = Identifier::ToLeg(leg);
    let mut segmenter = Segmenter::new(identifier);
    let mut assembler = Assembler::<MAX_FRAME>::leg_receiver(leg);
    let hello = HostRequest::Identify(Hello {
        schema: HOST_SCHEMA,
    });
    let mut text = String::new();
    for frame in [framed(1, &hello), framed(2, &lean(7))] {
        let mut assembled: Vec<u8> = Vec::new();
        for segment in segmenter.segments(&frame).unwrap() {
            let (bits, payload) = (identifier.bits(), hex(segment.payload()));
            writeln!(text, "{bits:#05x}  {payload}").unwrap();
            let found = assembler.push(&segment);
            assert_eq!(found.fault, None);
            assembled.extend(found.link_frame.unwrap_or_default());
        }
        assert_eq!(assembled, frame);
    }
    text
}

/// A host lets the leg lean by 0.1 towards x.
fn lean(host: HostId) -> HostRequest {
    HostRequest::Command {
        host,
        command: Command::Move { x: 0.1, y: 0.0 },
    }
}

/// A host introduces itself, lets the leg lean by 0.1 towards x, and a second host is refused.
fn exchange() -> String {
    let identity = Identity {
        board: BoardKind::Stm32g474,
        version: VERSION,
        reset: ResetCause::Power,
        crash_report: Default::default(),
    };
    let schema = HOST_SCHEMA;
    let lines = [
        (
            "host: Identify",
            frame_hex(1, &HostRequest::Identify(Hello { schema })),
        ),
        (
            "leg:  Identified",
            frame_hex(1, &HostReply::Identified(identity)),
        ),
        (
            "host: Command, host 7, Move x 0.1, y 0",
            frame_hex(2, &lean(7)),
        ),
        ("leg:  Done", frame_hex(2, &HostReply::Done)),
        ("host: the same, host 300", frame_hex(3, &lean(300))),
        (
            "leg:  Refused, OtherHost",
            frame_hex(3, &HostReply::Refused(HostRefusal::OtherHost)),
        ),
    ];
    lines
        .map(|(what, bytes)| format!("{what}\n    {bytes}\n"))
        .concat()
}

/// A text with another part between two lines, which stay.
fn with_part(text: &str, name: &str, part: &str) -> String {
    let [begin, end] = ["begin", "end"].map(|edge| format!("<!-- {edge} {name} -->\n"));
    let (before, rest) = text.split_once(&begin).unwrap();
    let (_, after) = rest.split_once(&end).unwrap();
    format!("{before}{begin}{part}{end}{after}")
}

fn listing(text: &str) -> String {
    format!("```text\n{text}```\n")
}

/// `LEG_OVERWRITE=1` writes it anew.
#[test]
fn the_page_has_the_messages_of_the_firmware() {
    let text = fs::read_to_string(page()).unwrap();
    let (_, shapes) = grammar::message_types();
    let messages = format!("schema {}\n\n{shapes}", hex(&HOST_SCHEMA));
    let expected = with_part(&text, "messages", &listing(&messages));
    let expected = with_part(&expected, "segments", &listing(&segments()));
    let expected = with_part(&expected, "exchange", &listing(&exchange()));
    let expected = with_part(&expected, "signals", &recorder::table());
    let (before, rest) = expected.split_once(SCHEMA_OF_CLIENT).unwrap();
    let (_, after) = rest.split_once('"').unwrap();
    let schema = hex(&HOST_SCHEMA);
    let expected = format!("{before}{SCHEMA_OF_CLIENT}{schema}\"{after}");
    if env::var_os("LEG_OVERWRITE").is_some() {
        fs::write(page(), &expected).unwrap();
    }
    let differing = text.lines().zip(expected.lines()).find(|(a, b)| a != b);
    assert!(
        text == expected || env::var_os("LEG_OVERWRITE").is_some(),
        "PROTOCOL.md is not that of the firmware, first (page, firmware): {differing:?}; LEG_OVERWRITE=1 writes it anew"
    );
}
