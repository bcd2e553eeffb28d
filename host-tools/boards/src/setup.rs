//! Prerequisites: what a first run installs by itself, and what it asks the user to install.
//!
//! Several processes may ask at once: one installs, the others wait for it.

mod error;
mod package;
mod program;
mod user;

pub use error::SetupError;
pub use package::{PYTHON, Package, QEMU};
pub use program::Programs;

use program::run;
use std::env;
use std::fs::File;
use std::path::{Path, PathBuf};

/// The firmware's target.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// The environment variable that names the emulator's program where it is not on the PATH.
pub const QEMU_VARIABLE: &str = "LEG_QEMU";

/// Installs the Rust target [`TARGET`] of the pinned toolchain where it is missing, and calls `report` before it does.
///
/// # Errors
/// [`SetupError`] if rustup is missing or fails.
pub fn ensure_target(report: &mut dyn FnMut(&str)) -> Result<(), SetupError> {
    ensure_rust_target(TARGET, report)
}

/// The same of any target.
pub(crate) fn ensure_rust_target(
    target: &str,
    report: &mut dyn FnMut(&str),
) -> Result<(), SetupError> {
    let programs = Programs::from_environment();
    if has_target(&programs, target)? {
        return Ok(());
    }
    let _lock = lock()?;
    if has_target(&programs, target)? {
        return Ok(());
    }
    report(&format!("adding the Rust target {target} by rustup"));
    run(programs.rust("rustup")?.args(["target", "add", target])).map(drop)
}

/// The program `qemu-system-arm`. Installs it where it is missing, and calls `report` before it does.
///
/// # Errors
/// [`SetupError`], with the command that installs it where this program may not.
pub fn ensure_qemu(report: &mut dyn FnMut(&str)) -> Result<PathBuf, SetupError> {
    ensure(&QEMU, &Programs::from_environment(), report)
}

/// A Python of version 3.11 or later with the module `venv`, which the comparison with MuJoCo needs. Installs it where
/// it is missing, and calls `report` before it does.
///
/// # Errors
/// As [`ensure_qemu`].
pub fn ensure_python(report: &mut dyn FnMut(&str)) -> Result<PathBuf, SetupError> {
    ensure(&PYTHON, &Programs::from_environment(), report)
}

/// Whether a Rust target is there.
///
/// # Errors
/// [`SetupError`] if the compiler is missing or fails.
pub fn has_target(programs: &Programs, target: &str) -> Result<bool, SetupError> {
    let mut rustc = programs.rust("rustc")?;
    rustc.args(["--print", "target-libdir", "--target", target]);
    Ok(Path::new(run(&mut rustc)?.trim()).is_dir())
}

/// A package's program among `programs`. Installs it where it is missing, and calls `report` before it does.
///
/// # Errors
/// As [`ensure_qemu`].
pub fn ensure(
    package: &Package,
    programs: &Programs,
    report: &mut dyn FnMut(&str),
) -> Result<PathBuf, SetupError> {
    if let Some(program) = package.program(programs)? {
        return Ok(program);
    }
    let _lock = lock()?;
    if let Some(program) = package.program(programs)? {
        return Ok(program);
    }
    let Some(apt) = programs.apt() else {
        return Err(package.missing());
    };
    report(&format!("installing {} by apt-get", package.name));
    package.install(&apt)?;
    package.program(programs)?.ok_or_else(|| package.missing())
}

/// Waits until no other process of this user installs anything; released when dropped.
fn lock() -> Result<File, SetupError> {
    let user = user::number();
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
