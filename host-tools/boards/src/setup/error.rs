//! Why a prerequisite is missing.

use super::QEMU_VARIABLE;
use std::io;
use thiserror::Error;

/// Why a prerequisite is missing.
#[derive(Debug, Error)]
pub enum SetupError {
    /// The variable names no program.
    #[error("{QEMU_VARIABLE} names `{0}`, which is no program; correct it or unset it")]
    NamedQemuMissing(String),
    /// A program is missing and cannot be installed from here.
    #[error("`{name}` is missing; install it: {command}")]
    Missing {
        /// The program.
        name: &'static str,
        /// What a user has to run.
        command: String,
    },
    /// A part of the Rust toolchain is missing.
    #[error("`{0}` is missing; install Rust with rustup, which brings it")]
    RustMissing(&'static str),
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
