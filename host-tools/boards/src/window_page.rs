//! Builds the window as a page for a browser.

use crate::image::{FOREIGN_VARIABLES, workspace_root};
use crate::setup::{self, SetupError};
use std::env;
use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use thiserror::Error;

/// What a browser runs.
const TARGET: &str = "wasm32-unknown-unknown";

/// The window's workspace, in that of this program.
const MANIFEST: &str = "host-tools/window/Cargo.toml";

/// Why there is no page.
#[derive(Debug, Error)]
pub enum WindowPageError {
    /// The sources are not where this program was built from.
    #[error(
        "the window's sources are not in {0}; run this program from the tree that it was built in"
    )]
    NoSources(String),
    /// What compiles it is missing.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// Cargo could not be started.
    #[error("cannot start cargo: {0}; install Rust with rustup")]
    NoCargo(#[source] io::Error),
    /// The directory has no path.
    #[error("no directory {0}: {1}")]
    NoDirectory(String, #[source] io::Error),
    /// Cargo has written why.
    #[error("the window was not built; cargo says why above")]
    Failed,
}

/// Writes the page into a directory, which takes minutes the first time and a moment if nothing has changed. Cargo writes on
/// standard error meanwhile. `report` is called before something is installed.
///
/// # Errors
/// [`WindowPageError`].
pub fn export(directory: &Path, report: &mut dyn FnMut(&str)) -> Result<PathBuf, WindowPageError> {
    let root = workspace_root();
    if !root.join(MANIFEST).is_file() {
        return Err(WindowPageError::NoSources(root.display().to_string()));
    }
    setup::ensure_rust_target(TARGET, report)?;
    let named = || directory.display().to_string();
    let directory = std::path::absolute(directory)
        .map_err(|error| WindowPageError::NoDirectory(named(), error))?;
    let program = env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo"));
    let mut command = Command::new(program);
    command
        .args(["run", "--locked", "--manifest-path", MANIFEST])
        .args(["--package", "leg-window-export", "--"])
        .arg(&directory)
        .current_dir(&root)
        .stdout(Stdio::null());
    for variable in FOREIGN_VARIABLES {
        command.env_remove(variable);
    }
    let status = command.status().map_err(WindowPageError::NoCargo)?;
    if status.success() {
        Ok(directory.join("index.html"))
    } else {
        Err(WindowPageError::Failed)
    }
}
