//! Package managers that have the emulator.

use super::command::run;
use super::{QEMU_VARIABLE, SetupError};
use crate::image::workspace_root;
use rustix::process::geteuid;
use std::path::PathBuf;
use std::process::Command;

/// Package managers and what installs the emulator by each, as root but for the last.
const INSTALLERS: [(&str, &str); 4] = [
    (
        APT,
        "apt-get update && apt-get install -y --no-install-recommends qemu-system-arm",
    ),
    ("dnf", "dnf install -y qemu-system-arm"),
    ("pacman", "pacman -S --needed qemu-system-arm"),
    ("brew", "brew install qemu"),
];

/// The one that is used without asking where that needs no password.
pub const APT: &str = "apt-get";

/// Where a package manager is, whatever the PATH says.
const USUAL_FOLDERS: &str =
    "/usr/bin:/usr/local/bin:/opt/homebrew/bin:/home/linuxbrew/.linuxbrew/bin";

/// A usable apt-get.
pub struct Apt {
    apt: PathBuf,
    sudo: Option<PathBuf>,
}

impl Apt {
    /// apt-get, if this process may use it without being asked for a password.
    pub fn allowed(apt: PathBuf, sudo: Option<PathBuf>) -> Option<Self> {
        if geteuid().is_root() {
            return Some(Self { apt, sudo: None });
        }
        let sudo = sudo?;
        let allowed = run(Command::new(&sudo).args(["-n", "true"])).is_ok();
        allowed.then_some(Self {
            apt,
            sudo: Some(sudo),
        })
    }

    /// Installs a package.
    pub fn install(&self, package: &str) -> Result<(), SetupError> {
        run(self.command().arg("update"))?;
        run(self
            .command()
            .args(["install", "-y", "--no-install-recommends", package]))
        .map(drop)
    }

    /// apt-get without questions, waiting for another one that is at work.
    fn command(&self) -> Command {
        let mut command = match &self.sudo {
            Some(sudo) => Command::new(sudo),
            None => Command::new("env"),
        };
        if self.sudo.is_some() {
            command.args(["-n", "env"]);
        }
        command
            .arg("DEBIAN_FRONTEND=noninteractive")
            .arg(&self.apt)
            .args(["-o", "DPkg::Lock::Timeout=300"]);
        command
    }
}

/// The error that tells how to install the emulator on this machine.
pub fn qemu_missing() -> SetupError {
    let here = workspace_root();
    let is_there = |program: &str| which::which_in(program, Some(USUAL_FOLDERS), &here).is_ok();
    let command = match INSTALLERS.iter().find(|(manager, _)| is_there(manager)) {
        Some(("brew", command)) => format!("`{command}`"),
        Some((_, command)) => format!("as root, `{command}`"),
        None => format!("it is part of QEMU (version 7.2 or later); or name it in {QEMU_VARIABLE}"),
    };
    SetupError::QemuMissing { command }
}
