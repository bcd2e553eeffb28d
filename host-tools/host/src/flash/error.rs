//! Why a board was not flashed, by the texts of probe-rs.

use super::{CHIP, PROGRAM_VARIABLE};
use std::process::Output;

/// Why a board was not flashed.
#[derive(Debug, thiserror::Error)]
pub enum FlashError {
    /// The program is not installed.
    #[error("there is no program `{0}`, which writes the firmware into the board")]
    NoProgram(String),
    /// It does not start.
    #[error("cannot start probe-rs: {0}")]
    NotStarted(std::io::Error),
    /// No debugger is plugged in.
    #[error("probe-rs finds no debugger")]
    NoProbe,
    /// Several are.
    #[error("several debuggers are plugged in")]
    SeveralProbes,
    /// The debugger cannot be opened.
    #[error("the debugger cannot be opened: {0}")]
    NotOpened(String),
    /// The chip does not answer.
    #[error("the debugger reaches no chip: {0}")]
    NoChip(String),
    /// Another chip answers.
    #[error("the chip is no STM32G474: its device number is {0:#05x}, not 0x469")]
    OtherChip(u32),
    /// The chip is protected.
    #[error("the chip is protected against reading")]
    Protected,
    /// The chip's flash is one bank, where the settings have to be in the second.
    #[error("the chip's flash is set to a single bank")]
    OneBank,
    /// The processor is locked up.
    #[error("the chip's processor is locked up: {0}")]
    LockedUp(String),
    /// What was read back differs.
    #[error("the flash does not hold what was written")]
    NotVerified,
    /// probe-rs does not know the chip.
    #[error("this probe-rs does not know the {CHIP}")]
    UnknownChip,
    /// Anything else.
    #[error("probe-rs failed: {0}")]
    Other(String),
}

/// A text of probe-rs in small letters, and the error that it means.
type Meaning = (&'static str, fn(String) -> FlashError);

/// Every text that is known: probe-rs has no exit codes or JSON for them.
const MEANINGS: [Meaning; 11] = [
    ("no connected probes", |_| FlashError::NoProbe),
    ("probe not found", |_| FlashError::NoProbe),
    ("probes were found", |_| FlashError::SeveralProbes),
    ("verification failed", |_| FlashError::NotVerified),
    ("failed to open", FlashError::NotOpened),
    ("probe could not be created", FlashError::NotOpened),
    ("lockedup", FlashError::LockedUp),
    ("locked up", FlashError::LockedUp),
    ("not found in the database", |_| FlashError::UnknownChip),
    ("unable to load specification", |_| FlashError::UnknownChip),
    ("connecting to the chip", FlashError::NoChip),
];

impl FlashError {
    /// The meaning of the output of a run that failed.
    pub(super) fn from_output(output: &Output) -> Self {
        let text = output_text(output);
        let small = text.to_lowercase();
        let meaning = MEANINGS.iter().find(|(part, _)| small.contains(part));
        meaning.map_or(Self::Other as fn(String) -> Self, |(_, error)| *error)(text)
    }

    /// What to do about it.
    #[must_use]
    pub fn remedy(&self) -> String {
        match self {
            Self::NoProgram(_) => {
                return format!(
                    "install it: `cargo install probe-rs-tools --locked`, or name it in {PROGRAM_VARIABLE}"
                );
            }
            Self::NotStarted(_) => "see that the program may be run",
            Self::NoProbe => {
                "plug the board in at its ST-LINK connector with a cable that carries data; on Linux allow its use: \
                 https://probe.rs/docs/getting-started/probe-setup/"
            }
            Self::SeveralProbes => "name one with --probe; `probe-rs list` shows them",
            Self::NotOpened(_) => {
                "end other programs that use the debugger; on Linux allow its use: \
                 https://probe.rs/docs/getting-started/probe-setup/"
            }
            Self::NoChip(_) => "see that the board is powered and its ST-LINK jumpers are set",
            Self::OtherChip(_) => "use a NUCLEO-G474RE; the image fits no other chip",
            Self::Protected => {
                "lift the protection with STM32CubeProgrammer (RDP level 0), which erases the chip"
            }
            Self::OneBank => "set its option byte DBANK with STM32CubeProgrammer, as it is from the factory",
            Self::LockedUp(_) => "reset the board, then flash again",
            Self::NotVerified => "flash again; if it stays, the chip's flash is worn out",
            Self::UnknownChip => "install a newer one: `cargo install probe-rs-tools --locked`",
            Self::Other(_) => "run `probe-rs info` to see what it reaches",
        }
        .into()
    }
}

/// The lines of both outputs that are not empty; errors come last.
pub(super) fn output_text(output: &Output) -> String {
    let text = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes));
    let lines = text.iter().flat_map(|text| text.lines());
    let lines: Vec<&str> = lines
        .map(str::trim)
        .filter(|line| !line.is_empty())
        .collect();
    lines.join("; ")
}
