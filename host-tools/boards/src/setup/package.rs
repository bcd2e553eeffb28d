//! What the system's package manager installs.

use super::SetupError;
use super::program::{Programs, run};
use crate::image::workspace_root;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::Command;

/// A program that package managers have.
#[derive(Debug)]
pub struct Package {
    /// What it is called in messages.
    pub name: &'static str,
    /// Where the program is, if it is there and fit for use.
    find: fn(&Programs) -> Result<Option<PathBuf>, SetupError>,
    /// Its packages by apt-get, dnf, pacman and brew.
    packages: [&'static [&'static str]; 4],
    /// What to do where there is none of these.
    otherwise: &'static str,
}

/// The emulator of the board.
pub const QEMU: Package = Package {
    name: "qemu-system-arm",
    find: find_qemu,
    packages: [
        &["qemu-system-arm"],
        &["qemu-system-arm"],
        &["qemu-system-arm"],
        &["qemu"],
    ],
    otherwise: "it is part of QEMU (version 7.2 or later); or name it in LEG_QEMU",
};

/// Python for the comparison with MuJoCo. 3.11 is the oldest version for which its pinned packages are built.
pub const PYTHON: Package = Package {
    name: "python3 (3.11 or later, with venv)",
    find: find_python,
    packages: [
        &["python3", "python3-venv"],
        &["python3"],
        &["python"],
        &["python"],
    ],
    otherwise: "see python.org",
};

/// Package managers and their commands, as root but for the last. The first is used without asking where that needs no
/// password.
const MANAGERS: [(&str, &str); 4] = [
    (
        "apt-get",
        "apt-get update && apt-get install -y --no-install-recommends",
    ),
    ("dnf", "dnf install -y"),
    ("pacman", "pacman -S --needed"),
    ("brew", "brew install"),
];

/// Where a package manager is, whatever the PATH says.
const MANAGER_DIRECTORIES: &str =
    "/usr/bin:/usr/local/bin:/opt/homebrew/bin:/home/linuxbrew/.linuxbrew/bin";

/// Ends without an error if the interpreter is recent enough and makes virtual environments with pip.
const PYTHON_CHECK: &str = "import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 11))";

impl Package {
    /// Where its program is, if it is there and fit for use.
    ///
    /// # Errors
    /// [`SetupError`] for a program that is named and is not there.
    pub fn program(&self, programs: &Programs) -> Result<Option<PathBuf>, SetupError> {
        (self.find)(programs)
    }

    /// Installs it by `apt`, as [`Programs::apt`] gives it.
    pub(super) fn install(&self, apt: &[OsString]) -> Result<(), SetupError> {
        let [packages, ..] = self.packages;
        run(Command::new("env").args(apt).arg("update"))?;
        let install = ["install", "-y", "--no-install-recommends"];
        run(Command::new("env").args(apt).args(install).args(packages)).map(drop)
    }

    /// The error that names the command for this machine.
    pub(super) fn missing(&self) -> SetupError {
        let here = workspace_root();
        let is_there =
            |program: &str| which::which_in(program, Some(MANAGER_DIRECTORIES), &here).is_ok();
        let mut managers = MANAGERS.iter().zip(self.packages);
        let command = match managers.find(|((manager, _), _)| is_there(manager)) {
            Some((("brew", command), packages)) => format!("`{command} {}`", packages.join(" ")),
            Some(((_, command), packages)) => {
                format!("as root, `{command} {}`", packages.join(" "))
            }
            None => self.otherwise.to_owned(),
        };
        SetupError::Missing {
            name: self.name,
            command,
        }
    }
}

fn find_qemu(programs: &Programs) -> Result<Option<PathBuf>, SetupError> {
    let Some(named) = &programs.named_qemu else {
        return Ok(programs.find(QEMU.name));
    };
    match programs.find(named) {
        Some(path) => Ok(Some(path)),
        None => Err(SetupError::NamedQemuMissing(
            named.to_string_lossy().into_owned(),
        )),
    }
}

fn find_python(programs: &Programs) -> Result<Option<PathBuf>, SetupError> {
    let found = programs.find("python3");
    Ok(found.filter(|python| run(Command::new(python).args(["-c", PYTHON_CHECK])).is_ok()))
}
