//! A pseudo-terminal: to other programs it is a serial port.

use rustix::fs::OFlags;
use rustix::io::Errno;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};
use std::fs::{File, OpenOptions};
use std::io;
use std::os::fd::OwnedFd;
use std::path::{Path, PathBuf};

/// The end that stands for the device.
#[derive(Debug)]
pub struct PseudoTerminal {
    device: OwnedFd,
    path: PathBuf,
    /// The other end: as long as it is open, a program that closes it ends nothing.
    _port: File,
}

impl PseudoTerminal {
    /// Makes one. It passes every byte as it is.
    ///
    /// # Errors
    /// What the system says.
    pub fn open() -> io::Result<Self> {
        let device = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        grantpt(&device)?;
        unlockpt(&device)?;
        let name = ptsname(&device, Vec::new())?;
        let path = PathBuf::from(name.into_string().map_err(io::Error::other)?);
        let port = OpenOptions::new().read(true).write(true).open(&path)?;
        let mut mode = tcgetattr(&port)?;
        mode.make_raw();
        tcsetattr(&port, OptionalActions::Now, &mode)?;
        let flags = rustix::fs::fcntl_getfl(&device)?;
        rustix::fs::fcntl_setfl(&device, flags | OFlags::NONBLOCK)?;
        Ok(Self {
            device,
            path,
            _port: port,
        })
    }

    /// What other programs open.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What has come; 0 if nothing has.
    ///
    /// # Errors
    /// What the system says.
    pub fn read(&self, bytes: &mut [u8]) -> io::Result<usize> {
        match rustix::io::read(&self.device, bytes) {
            Ok(count) => Ok(count),
            Err(Errno::AGAIN | Errno::INTR) => Ok(0),
            Err(error) => Err(error.into()),
        }
    }

    /// Writes, and tells how many bytes there was room for.
    ///
    /// # Errors
    /// What the system says.
    pub fn write(&self, bytes: &[u8]) -> io::Result<usize> {
        match rustix::io::write(&self.device, bytes) {
            Ok(count) => Ok(count),
            Err(Errno::AGAIN | Errno::INTR) => Ok(0),
            Err(error) => Err(error.into()),
        }
    }
}
