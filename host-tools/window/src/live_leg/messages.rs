//! What page and server say to each other of the connection, as text.

use serde::Deserialize;

/// What the server says first of a leg.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct Hello {
    /// The schema of the leg's protocol, as hexadecimal digits.
    pub schema: String,
    /// What the leg is on.
    pub name: String,
    /// Its settings, as a rig file.
    pub rig: String,
}

/// Who drives the leg.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub struct Role {
    /// This page.
    pub drives: bool,
    /// Another page.
    pub other_drives: bool,
}

/// What the server says.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(untagged)]
enum Message {
    Hello { hello: Hello },
    Role(Role),
    Lost { lost: String },
}

/// The same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ServerWord {
    /// Which leg it is.
    Hello(Hello),
    /// Who drives it.
    Role(Role),
    /// The line to the leg has ended, and why.
    Lost(String),
}

impl ServerWord {
    /// Of a text; none of one that says something else.
    #[must_use]
    pub fn new(text: &str) -> Option<Self> {
        Some(match serde_json::from_str(text).ok()? {
            Message::Hello { hello } => Self::Hello(hello),
            Message::Role(role) => Self::Role(role),
            Message::Lost { lost } => Self::Lost(lost),
        })
    }
}

/// What the page says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PageWord {
    /// It wants to drive.
    Drive,
    /// It does not any more.
    Release,
    /// The leg is to be stopped.
    Stop,
}

impl PageWord {
    /// As the server reads it.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Drive => "drive",
            Self::Release => "release",
            Self::Stop => "stop",
        }
    }
}

/// Where a page finds its leg, from its address's fragment; none for the leg that is simulated in the page.
#[must_use]
pub fn address(fragment: &str) -> Option<&str> {
    let address = fragment.strip_prefix('#')?.strip_prefix("leg=")?;
    address.starts_with("ws://").then_some(address)
}

#[cfg(test)]
mod tests {
    use super::{Hello, Role, ServerWord, address};

    #[test]
    fn what_the_server_says_is_read() {
        let hello = r#"{"hello":{"schema":"0123","name":"sim","rig":"[rig]"}}"#;
        let expected = Hello {
            schema: "0123".into(),
            name: "sim".into(),
            rig: "[rig]".into(),
        };
        assert_eq!(ServerWord::new(hello), Some(ServerWord::Hello(expected)));
        let role = Role {
            drives: false,
            other_drives: true,
        };
        assert_eq!(
            ServerWord::new(r#"{"drives":false,"other_drives":true}"#),
            Some(ServerWord::Role(role))
        );
        assert_eq!(
            ServerWord::new(r#"{"lost":"unplugged"}"#),
            Some(ServerWord::Lost("unplugged".into()))
        );
        for other in ["", "{}", r#"{"drives":true}"#, r#"{"hello":1}"#, "drive"] {
            assert_eq!(ServerWord::new(other), None, "{other}");
        }
    }

    #[test]
    fn the_fragment_names_a_leg_or_none() {
        assert_eq!(
            address("#leg=ws://127.0.0.1:1/a"),
            Some("ws://127.0.0.1:1/a")
        );
        for other in ["", "#", "#leg=", "#leg=http://x", "leg=ws://x"] {
            assert_eq!(address(other), None, "{other}");
        }
    }
}
