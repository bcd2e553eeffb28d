//! The line between the page and the server of a live leg.

/// What comes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Heard {
    /// About the connection.
    Text(String),
    /// Of the leg, in arbitrary pieces.
    Bytes(Vec<u8>),
    /// Nothing comes any more, and why.
    Ended(String),
}

/// What is sent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Said {
    /// To the server.
    Text(&'static str),
    /// To the leg: whole frames.
    Bytes(Vec<u8>),
}

/// Carries both.
pub trait Line {
    /// What came next; none if nothing has come.
    fn heard(&mut self) -> Option<Heard>;
    /// Sends something. What a line that has ended is given is lost.
    fn say(&mut self, said: Said);
}
