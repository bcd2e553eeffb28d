//! The texts of a leg's refusals.

use leg_firmware::command::CommandRefusal;
use leg_firmware::host_link::HostRefusal;
use leg_firmware::set_point::PointRefusal;
use leg_firmware::settings::SettingsError;
use serde_json::Value;

/// What to do where host and firmware do not understand each other.
pub const OTHER_SOURCES: &str =
    "build and flash the firmware from the sources of this program: `leg flash`";

/// What is wrong, and what to do about it.
#[must_use]
pub fn description(refusal: &HostRefusal) -> [String; 2] {
    let [wrong, remedy] = match refusal {
        HostRefusal::Settings(error) => {
            return [format!("the settings are refused: {error}"), remedy(error)];
        }
        HostRefusal::BadFrame(error) => {
            return [
                format!("a frame was damaged on the way: {error}"),
                "check cable and baud rate, then command again".into(),
            ];
        }
        HostRefusal::Command(CommandRefusal::NotHomed) => {
            let [wrong, _] = CommandRefusal::NotHomed.description();
            [wrong, "home it: `leg home`"]
        }
        HostRefusal::Command(refusal) => refusal.description(),
        HostRefusal::SchemaMismatch { .. } => {
            ["the firmware speaks another protocol", OTHER_SOURCES]
        }
        HostRefusal::NotIdentified => [
            "the board has started anew and does not know this host",
            "command again: unless its power had gone, the board reports then why it started anew",
        ],
        HostRefusal::BadRequest => ["the request is not known to the firmware", OTHER_SOURCES],
        HostRefusal::Busy => [
            "the board is still busy with what it was asked before",
            "command again; if it stays so, end the other commands that use this line",
        ],
        HostRefusal::OtherHost => [
            "another host drives the leg",
            "end that one, or `leg stop`, which any host may do",
        ],
        HostRefusal::Driven => [
            "settings change and are kept only while the drivers are off",
            "run `leg disarm` first",
        ],
        HostRefusal::Recording => [
            "it still records",
            "read it again: another host has let it go on",
        ],
        HostRefusal::NotSaved => [
            "the board could not keep the settings",
            "save again; they are in use until the board starts anew",
        ],
    };
    [wrong.into(), remedy.into()]
}

/// The same of a point of a path, by its time on it, s; below zero it is one of the way to its start.
#[must_use]
pub fn point_description(time_s: f64, refusal: PointRefusal) -> [String; 2] {
    let [wrong, remedy] = refusal.description();
    let place = if time_s < 0.0 {
        "on the way to the start of the path".into()
    } else {
        format!("the path {time_s:.3} s after its start")
    };
    [format!("{place}: {wrong}"), remedy.into()]
}

/// Longest refusal in bytes of the protocol.
const BYTES_MAX: usize = 64;

/// Which refusal it is: numbers and names of its variants in the protocol, outermost first, up to that which says why.
#[must_use]
pub fn variants(refusal: &HostRefusal) -> Vec<(u8, String)> {
    let mut bytes = [0; BYTES_MAX];
    let numbers = postcard::to_slice(refusal, &mut bytes).map_or(&[][..], |bytes| bytes);
    let mut names = Vec::new();
    let mut value = serde_json::to_value(refusal).unwrap_or_default();
    loop {
        let (name, inner) = match value {
            Value::String(name) => (name, Value::Null),
            Value::Object(entries) => match entries.into_iter().next() {
                Some(entry) => entry,
                None => break,
            },
            _ => break,
        };
        // Variants begin with a capital; fields and the states of a leg do not.
        if !name.starts_with(char::is_uppercase) {
            break;
        }
        names.push(name);
        value = inner;
    }
    numbers.iter().copied().zip(names).collect()
}

fn remedy(error: &SettingsError) -> String {
    match error {
        SettingsError::Model(_) => "correct the rig file; `leg rig validate` shows the place",
        SettingsError::OutOfRange(error) if error.axis != 0 => {
            "calibrate that axis anew: `leg calibrate`"
        }
        SettingsError::OutOfRange(_) => "give a value inside the range",
    }
    .into()
}
