//! Finding and running other programs.

use super::QEMU_VARIABLE;
use super::{SetupError, user};
use crate::image::workspace_root;
use std::env;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Where programs are looked for.
#[derive(Clone, Debug)]
pub struct Programs {
    /// The directories, as in the environment's PATH.
    pub path: Option<OsString>,
    /// The emulator that the user names.
    pub named_qemu: Option<OsString>,
}

impl Programs {
    /// Those that the user's environment names.
    #[must_use]
    pub fn from_environment() -> Self {
        Self {
            path: env::var_os("PATH"),
            named_qemu: env::var_os(QEMU_VARIABLE),
        }
    }

    pub(super) fn find(&self, program: impl AsRef<OsStr>) -> Option<PathBuf> {
        which::which_in(program, self.path.as_ref(), workspace_root()).ok()
    }

    /// A program of the Rust toolchain.
    pub(super) fn rust(&self, program: &'static str) -> Result<Command, SetupError> {
        let path = self.find(program).ok_or(SetupError::RustMissing(program))?;
        let mut command = Command::new(path);
        // There the pinned toolchain is in force, and rustup adds to that one.
        command.current_dir(workspace_root());
        Ok(command)
    }

    /// The arguments with which `env` runs apt-get without questions, if this process may do so without a password. It
    /// waits for another apt-get that runs.
    pub(super) fn apt(&self) -> Option<Vec<OsString>> {
        let apt = self.find("apt-get")?;
        let mut arguments = Vec::new();
        if !user::is_root() {
            let sudo = self.find("sudo")?;
            run(Command::new(&sudo).args(["-n", "true"])).ok()?;
            arguments.extend([sudo.into(), "-n".into(), "env".into()]);
        }
        arguments.extend(["DEBIAN_FRONTEND=noninteractive".into(), apt.into()]);
        arguments.extend(["-o", "DPkg::Lock::Timeout=300"].map(OsString::from));
        Some(arguments)
    }
}

/// Runs a program to its end and returns its standard output.
pub fn run(command: &mut Command) -> Result<String, SetupError> {
    let output = command.output().map_err(|source| SetupError::System {
        action: format!("start {}", command.get_program().to_string_lossy()),
        source,
    })?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let program = Path::new(command.get_program());
    let name = program.file_name().unwrap_or(program.as_os_str());
    let words: Vec<_> = std::iter::once(name)
        .chain(command.get_args())
        .map(OsStr::to_string_lossy)
        .collect();
    Err(SetupError::Failed {
        command: words.join(" "),
        output: String::from_utf8_lossy(&output.stderr).into_owned(),
    })
}
