//! The texts of a leg's refusals.

use leg_firmware::command::CommandRefusal;
use leg_firmware::host_link::HostRefusal;
use leg_firmware::settings::SettingsError;

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
