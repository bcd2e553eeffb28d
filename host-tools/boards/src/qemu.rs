//! The firmware under QEMU: one emulator for one session, reached by two named pipes, as Linux and macOS have them.

#[cfg(not(unix))]
mod absent;
#[cfg(unix)]
mod log;
#[cfg(unix)]
mod pipes;
#[cfg(unix)]
mod process;
#[cfg(unix)]
mod session;

#[cfg(not(unix))]
pub use absent::QemuSession;
#[cfg(unix)]
pub use process::describe_exit;
#[cfg(unix)]
pub use session::QemuSession;

use std::path::PathBuf;

/// How QEMU's clock relates to the instructions that it executes. Both kinds give the same run every time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QemuClock {
    /// 8 ns an instruction: about the speed of the real processor.
    Normal,
    /// 1 024 ns an instruction: the firmware can count instructions.
    Counting,
}

#[cfg(unix)]
impl QemuClock {
    /// QEMU's `-icount`. Without it QEMU's clock is the host's, and the boot check of a busy machine would fail.
    const fn icount(self) -> &'static str {
        match self {
            Self::Normal => "shift=3,sleep=off",
            Self::Counting => "shift=10,sleep=off",
        }
    }
}

/// What to start and how.
#[derive(Clone, Debug)]
pub struct QemuConfig {
    /// The program `qemu-system-arm`.
    pub qemu: PathBuf,
    /// ELF file of the firmware.
    pub image: PathBuf,
    /// QEMU's clock.
    pub clock: QemuClock,
    /// Whether the firmware's log goes to standard error as it comes.
    pub verbose: bool,
}

impl QemuConfig {
    /// Runs `image` in `qemu` with the normal clock and without printing the log.
    #[must_use]
    pub const fn new(qemu: PathBuf, image: PathBuf) -> Self {
        Self {
            qemu,
            image,
            clock: QemuClock::Normal,
            verbose: false,
        }
    }
}
