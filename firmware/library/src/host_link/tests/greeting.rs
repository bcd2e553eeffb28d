//! Who speaks first.

use super::{Line, ONE, identify, identity, refused};
use crate::command::Command;
use crate::host_link::{HOST_SCHEMA, Hello};
use crate::host_link::{HostRefusal, HostReply, HostRequest};
use crate::settings::Settings;

/// Every request but the first.
fn requests() -> [HostRequest; 7] {
    [
        HostRequest::Command {
            host: ONE,
            command: Command::Stop,
        },
        HostRequest::Telemetry,
        HostRequest::Stream(1),
        HostRequest::Sensors,
        HostRequest::GetSettings,
        HostRequest::SetSettings(Settings::table_1().unwrap()),
        HostRequest::SaveSettings,
    ]
}

fn assert_knows_nobody(line: &mut Line) {
    for request in requests() {
        let reply = line.ask(&request);
        assert_eq!(reply, refused(HostRefusal::NotIdentified), "{request:?}");
    }
    line.tick();
    assert_eq!(line.heard(), []);
    assert_eq!(line.leg.obeyed, []);
    assert_eq!(line.leg.restarts, []);
    assert_eq!(line.link.unsaved_settings(), None);
}

#[test]
fn nothing_is_done_for_a_host_that_has_not_said_who_it_is() {
    assert_knows_nobody(&mut Line::new());
}

#[test]
fn a_host_that_introduces_itself_is_told_what_the_leg_is() {
    let mut line = Line::new();
    assert_eq!(line.ask(&identify()), HostReply::Identified(identity()));
}

const STRANGER: HostRequest = HostRequest::Identify(Hello { schema: [7; 8] });

#[test]
fn another_schema_is_told_the_firmwares_and_is_no_greeting() {
    let mut line = Line::new();
    let mismatch = refused(HostRefusal::SchemaMismatch {
        schema: HOST_SCHEMA,
    });
    assert_eq!(line.ask(&STRANGER), mismatch);
    assert_knows_nobody(&mut line);
}

#[test]
fn a_stranger_takes_nothing_from_a_host_that_is_known() {
    let mut line = Line::identified();
    line.ask(&HostRequest::Stream(1));
    line.ask(&STRANGER);
    assert!(matches!(
        line.ask(&HostRequest::Telemetry),
        HostReply::Telemetry(_)
    ));
    line.tick();
    assert_eq!(line.heard().len(), 1, "the stream goes on");
}

#[test]
fn a_refusal_of_what_was_read_is_no_misheard_frame() {
    let mut line = Line::new();
    line.ask(&HostRequest::Telemetry);
    line.ask(&STRANGER);
    assert_eq!(line.leg.note_decode_error, 0);
}

#[test]
fn a_new_greeting_ends_the_stream() {
    let mut line = Line::identified();
    line.ask(&HostRequest::Stream(1));
    line.tick();
    assert_eq!(line.heard().len(), 1);
    line.ask(&identify());
    line.tick();
    assert_eq!(line.heard(), []);
}
