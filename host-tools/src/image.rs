//! Builds the firmware image that QEMU boots.

use cargo_metadata::Message;
use std::env;
use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use thiserror::Error;

const BINARY: &str = "leg-qemu";

/// Variables that would change how the image is compiled: it is to be the same whoever builds it.
const FOREIGN_VARIABLES: [&str; 4] = [
    "RUSTFLAGS",
    "CARGO_ENCODED_RUSTFLAGS",
    "RUSTC_WRAPPER",
    "RUSTC_WORKSPACE_WRAPPER",
];

/// Why there is no image.
#[derive(Debug, Error)]
pub enum ImageError {
    /// The sources are not where this program was built from.
    #[error(
        "the firmware's sources are not in {root}; run this program from the tree that it was built in"
    )]
    NoSources {
        /// Where they were looked for.
        root: String,
    },
    /// Cargo could not be started.
    #[error("cannot start cargo: {0}; install Rust with rustup")]
    NoCargo(#[source] io::Error),
    /// The build failed.
    #[error("`cargo image-qemu` failed in {root}:\n{output}")]
    Failed {
        /// Where it ran.
        root: String,
        /// What it wrote.
        output: String,
    },
    /// The build made no executable.
    #[error(
        "`cargo image-qemu` made no executable named `{BINARY}`; see the alias in .cargo/config.toml"
    )]
    NoExecutable,
}

/// The folder of the workspace that this program was built from.
#[must_use]
pub fn workspace_root() -> PathBuf {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.parent().unwrap_or(package).to_path_buf()
}

/// Builds the image for QEMU, which takes a moment if nothing has changed, and returns the path of its ELF file.
///
/// Several callers at once wait for each other by cargo's own lock.
///
/// # Errors
/// [`ImageError`] with what cargo wrote.
pub fn build() -> Result<PathBuf, ImageError> {
    let root = workspace_root();
    if !root.join("firmware/Cargo.toml").is_file() {
        return Err(ImageError::NoSources {
            root: root.display().to_string(),
        });
    }
    let output = cargo(&root).output().map_err(ImageError::NoCargo)?;
    if !output.status.success() {
        return Err(ImageError::Failed {
            root: root.display().to_string(),
            output: String::from_utf8_lossy(&output.stderr).into_owned(),
        });
    }
    executable(&output).ok_or(ImageError::NoExecutable)
}

fn cargo(root: &Path) -> Command {
    let program = env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo"));
    let mut command = Command::new(program);
    command
        .args(["image-qemu", "--message-format=json-render-diagnostics"])
        .current_dir(root);
    for variable in FOREIGN_VARIABLES {
        command.env_remove(variable);
    }
    command
}

/// The image's path as cargo names it.
fn executable(output: &Output) -> Option<PathBuf> {
    Message::parse_stream(output.stdout.as_slice())
        .filter_map(Result::ok)
        .find_map(|message| match message {
            Message::CompilerArtifact(artifact) if artifact.target.name == BINARY => {
                artifact.executable.map(Into::into)
            }
            _ => None,
        })
}
