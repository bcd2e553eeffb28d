//! Why a prerequisite is missing, in words.

use super::{QEMU, QEMU_VARIABLE};
use std::io;
use thiserror::Error;

/// Why a prerequisite is missing.
#[derive(Debug, Error)]
pub enum SetupError {
    /// The variable names no program.
    #[error("{QEMU_VARIABLE} names `{program}`, which is no program; correct it or unset it")]
    NamedQemuMissing {
        /// What it names.
        program: String,
    },
    /// There is no emulator and it cannot be installed from here.
    #[error("`{QEMU}` is missing; install it: {command}")]
    QemuMissing {
        /// What a user has to run.
        command: String,
    },
    /// A program that is needed here is not there.
    #[error("`{program}` is missing; install Rust with rustup, which brings it")]
    RustMissing {
        /// The program.
        program: &'static str,
    },
    /// A program ran and failed.
    #[error("`{command}` failed; run it by hand to see to it:\n{output}")]
    Failed {
        /// What ran.
        command: String,
        /// What it wrote.
        output: String,
    },
    /// A program could not be started, or the lock could not be had.
    #[error("cannot {action}: {source}")]
    System {
        /// What was tried.
        action: String,
        /// What the system said.
        source: io::Error,
    },
}
