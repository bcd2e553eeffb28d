//! Boards that do not know their host.

use super::scripted::Scripted;
use crate::operator::{Host, Interrupt, Operator};
use leg_firmware::host_link::{HostRefusal, HostReply, HostRequest};

fn greeting(reply: HostReply) -> String {
    let board = Box::new(Scripted::new(move |_: &HostRequest| Some(reply.clone())));
    match Operator::open(board, Host::FIXED, Interrupt::default()) {
        Ok(_) => String::new(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn other_firmware_and_silence_are_told_apart() {
    let schema = HostRefusal::SchemaMismatch { schema: [0xab; 8] };
    let other = greeting(HostReply::Refused(schema));
    assert!(
        other.starts_with(
            "the firmware at a strange board speaks another protocol (schema abababababababab, this program "
        ),
        "{other}"
    );
    let silent = greeting(HostReply::Done);
    assert_eq!(silent, "a strange board does not answer");
}
