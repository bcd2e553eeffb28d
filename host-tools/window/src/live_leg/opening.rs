//! The way to a live leg: a line that is open, and on which the server has said which leg it is.

use super::line::{Heard, Line};
use super::messages::{Hello, ServerWord};
use super::{LiveLeg, PageIdentity};
use leg_base::description::hex;
use leg_firmware::host_link::HOST_SCHEMA;
use leg_rig::rig_file::RigText;

/// A leg that is not there yet.
pub struct Opening {
    /// None once it is the leg's.
    line: Option<Box<dyn Line>>,
    page: PageIdentity,
    /// The server.
    server: String,
}

/// What has become of it.
pub enum Opened {
    /// Nothing yet.
    Waiting,
    /// The leg.
    Leg(Box<LiveLeg>),
    /// There is none, and why.
    Failed(String),
}

impl Opening {
    /// Over a line to a server with an address.
    #[must_use]
    pub fn new(line: Box<dyn Line>, page: PageIdentity, address: &str) -> Self {
        // What follows is a secret, and says nothing to anybody.
        let server = address.split('/').take(3).collect::<Vec<_>>().join("/");
        Self {
            line: Some(line),
            page,
            server,
        }
    }

    /// What it waits for.
    #[must_use]
    pub fn words(&self) -> String {
        format!("Connecting to {} …", self.server)
    }

    /// Looks at what has come.
    pub fn advance(&mut self) -> Opened {
        loop {
            match self.line.as_mut().and_then(|line| line.heard()) {
                None => return Opened::Waiting,
                Some(Heard::Ended(why)) => return Opened::Failed(self.refused(&why)),
                Some(Heard::Text(text)) => match ServerWord::new(&text) {
                    Some(ServerWord::Hello(hello)) => return self.greeted(hello),
                    Some(ServerWord::Lost(why)) => return Opened::Failed(self.refused(&why)),
                    Some(ServerWord::Role(_)) | None => {}
                },
                // The leg's bytes mean nothing before it is known.
                Some(Heard::Bytes(_)) => {}
            }
        }
    }

    fn refused(&self, why: &str) -> String {
        format!(
            "No connection to {}: {why}. Start `leg ui` anew, and open the address that it prints.",
            self.server
        )
    }

    fn greeted(&mut self, hello: Hello) -> Opened {
        if hello.schema != hex(&HOST_SCHEMA) {
            return Opened::Failed(
                "This page and the leg are of different versions. Build the page anew: `leg ui` without --page does it."
                    .into(),
            );
        }
        let source = RigText {
            name: hello.name,
            text: hello.rig,
        };
        match source.read() {
            Err(failure) => Opened::Failed(failure.render(false)),
            Ok((rig, _)) => self.line.take().map_or(Opened::Waiting, |line| {
                Opened::Leg(Box::new(LiveLeg::new(line, self.page, source, rig)))
            }),
        }
    }
}
