//! How a run under an emulator can end: the exit codes, named once for the firmware and for the host.

/// Why the firmware ended the run. Its number is the emulator's exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The host closed the link: the ordinary end.
    LinkClosed = 0,
    /// The firmware panicked.
    Panic = 70,
    /// The processor took a hard fault.
    HardFault = 71,
    /// An interrupt or exception without a handler came.
    UnexpectedInterrupt = 72,
    /// The boot's 1 000 µs alarm was too early or too late.
    AlarmOff = 73,
    /// A task could not be started.
    NoTask = 74,
    /// The link's pipes could not be opened.
    NoLink = 75,
    /// Reading or writing the link failed.
    LinkBroken = 76,
    /// A reply does not fit into a frame.
    ReplyTooLong = 77,
}

impl Exit {
    /// Every way to end.
    pub const ALL: [Self; 9] = [
        Self::LinkClosed,
        Self::Panic,
        Self::HardFault,
        Self::UnexpectedInterrupt,
        Self::AlarmOff,
        Self::NoTask,
        Self::NoLink,
        Self::LinkBroken,
        Self::ReplyTooLong,
    ];

    /// The emulator's exit code.
    #[must_use]
    pub const fn code(self) -> i32 {
        self as i32
    }

    /// The end that an exit code stands for; none if the firmware never ends with it.
    #[must_use]
    pub fn from_code(code: i32) -> Option<Self> {
        Self::ALL.into_iter().find(|exit| exit.code() == code)
    }

    /// What happened, as the end of a sentence that starts with "the firmware".
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::LinkClosed => "ended because its link was closed",
            Self::Panic => "panicked; the log names the place",
            Self::HardFault => "took a hard fault; the log names the address",
            Self::UnexpectedInterrupt => "met an interrupt that it has no handler for",
            Self::AlarmOff => {
                "failed its boot check: the 1 000 µs alarm came too early or too late"
            }
            Self::NoTask => "could not start one of its tasks",
            Self::NoLink => "could not open the link's pipes",
            Self::LinkBroken => "could not read or write the link",
            Self::ReplyTooLong => "made a reply that does not fit into a frame",
        }
    }
}
