//! Builds the firmware images: the one that QEMU boots, and the one for the board.

use cargo_metadata::Message;
use std::env;
use std::ffi::OsString;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread::{self, JoinHandle};
use std::time::Duration;
use thiserror::Error;

/// Between two looks at a build.
const LOOK_TIME: Duration = Duration::from_millis(10);

/// A firmware image, by the board that it is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FirmwareImage {
    /// QEMU's mps2-an386.
    Qemu,
    /// The NUCLEO-G474RE.
    Stm32g474,
}

/// Variables that would change how the image is compiled: it is to be the same whoever builds it.
pub(crate) const FOREIGN_VARIABLES: [&str; 4] = [
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
        "the firmware's sources are not in {0}; run this program from the tree that it was built in"
    )]
    NoSources(String),
    /// Cargo could not be started.
    #[error("cannot start cargo: {0}; install Rust with rustup")]
    NoCargo(#[source] io::Error),
    /// The build failed.
    #[error("`cargo {}` failed in {root}:\n{output}", .image.cargo_alias())]
    Failed {
        /// The image.
        image: FirmwareImage,
        /// Where it ran.
        root: String,
        /// What it wrote.
        output: String,
    },
    /// It was not waited for.
    #[error("the build was ended before it was done; run it again")]
    Cancelled,
    /// The build made no executable.
    #[error(
        "`cargo {}` made no executable named `{}`; see the alias in .cargo/config.toml",
        .0.cargo_alias(), .0.binary()
    )]
    NoExecutable(FirmwareImage),
}

/// The directory of the workspace that this program was built from.
#[must_use]
pub fn workspace_root() -> PathBuf {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.ancestors().nth(2).unwrap_or(package).to_path_buf()
}

impl FirmwareImage {
    /// Every image.
    pub const ALL: [Self; 2] = [Self::Stm32g474, Self::Qemu];

    /// The name of its executable.
    #[must_use]
    pub const fn binary(self) -> &'static str {
        match self {
            Self::Qemu => "leg-qemu",
            Self::Stm32g474 => "leg-stm32g474",
        }
    }

    /// Cargo's command that builds it: an alias in .cargo/config.toml.
    const fn cargo_alias(self) -> &'static str {
        match self {
            Self::Qemu => "image-qemu",
            Self::Stm32g474 => "image-stm32g474",
        }
    }

    /// Builds it, which takes a moment if nothing has changed, and returns the path of its ELF file.
    ///
    /// Several callers at once wait for each other by cargo's own lock.
    ///
    /// # Errors
    /// [`ImageError`] with what cargo wrote.
    pub fn build(self) -> Result<PathBuf, ImageError> {
        self.build_in(&workspace_root(), &|| false)
    }

    /// The same from a copy of the workspace, and until `cancelled` says that nobody waits for it any more.
    ///
    /// # Errors
    /// As [`Self::build`]; [`ImageError::Cancelled`].
    pub fn build_in(
        self,
        root: &Path,
        cancelled: &dyn Fn() -> bool,
    ) -> Result<PathBuf, ImageError> {
        if !root.join("firmware/library/Cargo.toml").is_file() {
            return Err(ImageError::NoSources(root.display().to_string()));
        }
        let output = output_of(&mut self.cargo(root), cancelled).map_err(ImageError::NoCargo)?;
        let output = output.ok_or(ImageError::Cancelled)?;
        if !output.status.success() {
            return Err(ImageError::Failed {
                image: self,
                root: root.display().to_string(),
                output: String::from_utf8_lossy(&output.stderr).into_owned(),
            });
        }
        self.executable(&output)
            .ok_or(ImageError::NoExecutable(self))
    }

    fn cargo(self, root: &Path) -> Command {
        let program = env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo"));
        let mut command = Command::new(program);
        command
            .args([
                self.cargo_alias(),
                "--message-format=json-render-diagnostics",
            ])
            .current_dir(root);
        for variable in FOREIGN_VARIABLES {
            command.env_remove(variable);
        }
        command
    }

    /// The path that cargo reports.
    fn executable(self, output: &Output) -> Option<PathBuf> {
        Message::parse_stream(output.stdout.as_slice())
            .filter_map(Result::ok)
            .find_map(|message| match message {
                Message::CompilerArtifact(artifact) if artifact.target.name == self.binary() => {
                    artifact.executable.map(Into::into)
                }
                _ => None,
            })
    }
}

/// What a program that is run to its end writes; none, and it is killed, where that is not waited for. What it has started itself goes on to its end.
fn output_of(command: &mut Command, cancelled: &dyn Fn() -> bool) -> io::Result<Option<Output>> {
    command.stdin(Stdio::null());
    let mut child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()?;
    let [stdout, stderr] = [
        child.stdout.take().map(read_beside),
        child.stderr.take().map(read_beside),
    ];
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if cancelled() {
            child.kill()?;
            child.wait()?;
            return Ok(None);
        }
        thread::sleep(LOOK_TIME);
    };
    // Ctrl-C in a terminal ends the program, too.
    if !status.success() && cancelled() {
        return Ok(None);
    }
    let written = |reader: Option<JoinHandle<Vec<u8>>>| {
        let read = reader.and_then(|reader| reader.join().ok());
        read.unwrap_or_default()
    };
    Ok(Some(Output {
        status,
        stdout: written(stdout),
        stderr: written(stderr),
    }))
}

/// Reads to the end in a thread of its own: a pipe that is full stops who writes.
fn read_beside(mut pipe: impl Read + Send + 'static) -> JoinHandle<Vec<u8>> {
    thread::spawn(move || {
        let mut bytes = Vec::new();
        // What was read until an error is what there is.
        let _ = pipe.read_to_end(&mut bytes);
        bytes
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::output_of;
    use std::cell::Cell;
    use std::process::Command;
    use std::thread;
    use std::time::{Duration, Instant};

    #[test]
    fn a_program_that_nobody_waits_for_is_ended() {
        let begun = Instant::now();
        let ended = output_of(Command::new("sleep").arg("60"), &|| true).unwrap();
        assert!(ended.is_none() && begun.elapsed() < Duration::from_secs(30));
    }

    /// As by Ctrl-C in a terminal, which all that runs there gets.
    #[test]
    fn a_program_that_is_ended_with_who_waits_has_not_failed() {
        // It ends between the first look, in which nobody has asked for it yet, and the second.
        let looks = Cell::new(0);
        let cancelled = || {
            if looks.replace(looks.get() + 1) == 0 {
                thread::sleep(Duration::from_secs(3));
                return false;
            }
            true
        };
        let mut ended = Command::new("sh");
        let ended = output_of(ended.args(["-c", "sleep 1; kill -INT $$"]), &cancelled).unwrap();
        assert!(ended.is_none());
        assert_eq!(looks.get(), 2);
        let failed = output_of(&mut Command::new("false"), &|| false)
            .unwrap()
            .unwrap();
        assert!(!failed.status.success());
    }

    #[test]
    fn what_a_program_writes_is_kept() {
        let many = "i=0; while [ $i -lt 20000 ]; do echo $i; echo $i >&2; i=$((i+1)); done";
        let output = output_of(Command::new("sh").args(["-c", many]), &|| false).unwrap();
        let output = output.unwrap();
        assert!(output.status.success());
        for written in [output.stdout, output.stderr] {
            assert_eq!(String::from_utf8(written).unwrap().lines().count(), 20_000);
        }
    }
}
