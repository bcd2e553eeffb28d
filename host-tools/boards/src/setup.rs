//! Prerequisites: what a first run installs by itself, and what it asks for in words.
//!
//! Callers in several processes may ask at once: one installs, the others wait for it.

mod command;
mod error;
mod packages;

pub use error::SetupError;

use crate::image::workspace_root;
use command::run;
use packages::{APT, Apt, qemu_missing};
use rustix::process::geteuid;
use std::env;
use std::ffi::{OsStr, OsString};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The firmware's target.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// The emulator.
pub const QEMU: &str = "qemu-system-arm";

/// The environment variable that names the emulator's program where it is not on the PATH.
pub const QEMU_VARIABLE: &str = "LEG_QEMU";

/// Makes sure that the pinned Rust toolchain compiles for [`TARGET`]. `report` is told before anything is installed.
///
/// # Errors
/// [`SetupError`] if rustup is missing or fails.
pub fn ensure_target(report: &mut dyn FnMut(&str)) -> Result<(), SetupError> {
    let programs = Programs::of_this_process();
    if programs.has_target()? {
        return Ok(());
    }
    let _lock = lock()?;
    if programs.has_target()? {
        return Ok(());
    }
    report(&format!("adding the Rust target {TARGET} by rustup"));
    programs.add_target()
}

/// Makes sure that there is an emulator and returns its program. `report` is told before anything is installed.
///
/// # Errors
/// [`SetupError`], with the command that installs it where this program may not.
pub fn ensure_qemu(report: &mut dyn FnMut(&str)) -> Result<PathBuf, SetupError> {
    Programs::of_this_process().ensure_qemu(report)
}

/// Where programs are looked for.
struct Programs {
    path: Option<OsString>,
    named_qemu: Option<OsString>,
}

impl Programs {
    fn of_this_process() -> Self {
        Self {
            path: env::var_os("PATH"),
            named_qemu: env::var_os(QEMU_VARIABLE),
        }
    }

    fn find(&self, program: impl AsRef<OsStr>) -> Option<PathBuf> {
        which::which_in(program, self.path.as_ref(), workspace_root()).ok()
    }

    fn rust(&self, program: &'static str) -> Result<Command, SetupError> {
        let path = self
            .find(program)
            .ok_or(SetupError::RustMissing { program })?;
        let mut command = Command::new(path);
        // There the pinned toolchain is in force, and rustup adds to that one.
        command.current_dir(workspace_root());
        Ok(command)
    }

    fn has_target(&self) -> Result<bool, SetupError> {
        let mut rustc = self.rust("rustc")?;
        rustc.args(["--print", "target-libdir", "--target", TARGET]);
        let directory = run(&mut rustc)?;
        Ok(Path::new(directory.trim()).is_dir())
    }

    fn add_target(&self) -> Result<(), SetupError> {
        let mut rustup = self.rust("rustup")?;
        run(rustup.args(["target", "add", TARGET])).map(drop)
    }

    fn qemu(&self) -> Result<Option<PathBuf>, SetupError> {
        let Some(named) = &self.named_qemu else {
            return Ok(self.find(QEMU));
        };
        match self.find(named) {
            Some(path) => Ok(Some(path)),
            None => Err(SetupError::NamedQemuMissing {
                program: named.to_string_lossy().into_owned(),
            }),
        }
    }

    fn ensure_qemu(&self, report: &mut dyn FnMut(&str)) -> Result<PathBuf, SetupError> {
        if let Some(qemu) = self.qemu()? {
            return Ok(qemu);
        }
        let _lock = lock()?;
        if let Some(qemu) = self.qemu()? {
            return Ok(qemu);
        }
        let apt = self.find(APT);
        let Some(apt) = apt.and_then(|apt| Apt::allowed(apt, self.find("sudo"))) else {
            return Err(qemu_missing());
        };
        report(&format!("installing {QEMU} by apt-get"));
        apt.install(QEMU)?;
        self.qemu()?.ok_or_else(qemu_missing)
    }
}

/// Waits until no other process of this user installs anything; released when dropped.
fn lock() -> Result<File, SetupError> {
    let user = geteuid().as_raw();
    let path = env::temp_dir().join(format!("leg-setup-{user}.lock"));
    let open = File::options()
        .create(true)
        .truncate(false)
        .write(true)
        .open(&path);
    open.and_then(|file| file.lock().map(|()| file))
        .map_err(|source| SetupError::System {
            action: format!("lock {}", path.display()),
            source,
        })
}

#[cfg(test)]
mod tests;
