//! A pseudo-terminal: to other programs it is a serial port.
//!
//! Not `serialport::TTYPort::pair`, whose ends are inherited by every program that this one starts.

use crate::byte_port::BytePort;
use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
use rustix::io::{FdFlags, fcntl_setfd};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};
use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

/// Programs that this one starts do not inherit it: asked for at once where the system can.
#[cfg(target_os = "linux")]
const OPEN_FLAGS: OpenptFlags = OpenptFlags::RDWR
    .union(OpenptFlags::NOCTTY)
    .union(OpenptFlags::CLOEXEC);
#[cfg(not(target_os = "linux"))]
const OPEN_FLAGS: OpenptFlags = OpenptFlags::RDWR.union(OpenptFlags::NOCTTY);

/// The end that stands for the device.
#[derive(Debug)]
pub struct PseudoTerminal {
    device: File,
    path: PathBuf,
    /// The other end: as long as it is open, a program that closes it ends nothing.
    _port: File,
}

impl PseudoTerminal {
    /// Makes one. It passes every byte as it is.
    pub fn open() -> io::Result<Self> {
        let device = openpt(OPEN_FLAGS)?;
        fcntl_setfd(&device, FdFlags::CLOEXEC)?;
        grantpt(&device)?;
        unlockpt(&device)?;
        let name = ptsname(&device, Vec::new())?;
        let path = PathBuf::from(name.into_string().map_err(io::Error::other)?);
        let port = OpenOptions::new().read(true).write(true).open(&path)?;
        let mut mode = tcgetattr(&port)?;
        mode.make_raw();
        tcsetattr(&port, OptionalActions::Now, &mode)?;
        fcntl_setfl(&device, fcntl_getfl(&device)? | OFlags::NONBLOCK)?;
        Ok(Self {
            device: device.into(),
            path,
            _port: port,
        })
    }

    /// What other programs open.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What has come; 0 if nothing has.
    pub fn read(&self, bytes: &mut [u8]) -> io::Result<usize> {
        zero_if_blocked((&self.device).read(bytes))
    }

    /// Writes, and returns how many bytes there was room for.
    pub fn write(&self, bytes: &[u8]) -> io::Result<usize> {
        zero_if_blocked((&self.device).write(bytes))
    }
}

impl BytePort for PseudoTerminal {
    fn name(&self) -> String {
        self.path.display().to_string()
    }

    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        Self::read(self, bytes)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        Self::write(self, bytes)
    }
}

fn zero_if_blocked(result: io::Result<usize>) -> io::Result<usize> {
    match result {
        Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {
            Ok(0)
        }
        result => result,
    }
}
