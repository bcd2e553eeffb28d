//! What can be wrong with what was received.

/// What is wrong with a CAN frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CanError {
    /// The payload's size is none that CAN FD has, or not the one that the header's length asks for.
    WrongLength,
    /// The counter shows that CAN frames did not arrive.
    Lost,
    /// The CAN frame arrived a second time; it is dropped and costs nothing.
    Doubled,
    /// A link frame stopped before its final zero: its sender gave it up.
    Unfinished,
    /// The link frame is longer than this receiver takes.
    TooLong,
}

impl core::fmt::Display for CanError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::WrongLength => "the CAN frame's length is not the one that its header asks for",
            Self::Lost => "CAN frames were lost",
            Self::Doubled => "a CAN frame arrived twice",
            Self::Unfinished => "a link frame was given up half-sent",
            Self::TooLong => "the link frame is longer than this receiver takes",
        })
    }
}

impl core::error::Error for CanError {}
