//! The two named pipes between host and firmware, never waited for without end.

use leg_firmware_bench::pipes::{TO_FIRMWARE, TO_HOST};
use leg_sim::link::LinkError;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{Mode, OFlags, open};
use rustix::io::{Errno, read, write};
use std::ffi::{CStr, OsStr};
use std::io;
use std::os::fd::{AsFd, OwnedFd};
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
#[cfg(target_os = "macos")]
use std::process::Command;
use std::time::Instant;

/// What a wait for the firmware ended with.
#[derive(Debug, PartialEq, Eq)]
pub enum Transfer {
    /// So many bytes.
    Bytes(usize),
    /// Nothing until the deadline.
    TimedOut,
    /// The firmware's side is closed.
    Closed,
}

/// What fails when a pipe cannot be opened.
const OPEN: &str = "open a named pipe";

/// Makes both pipes in the directory, and opens the one from the firmware, as the firmware does first.
pub fn create(directory: &Path) -> Result<OwnedFd, LinkError> {
    for name in [TO_HOST, TO_FIRMWARE] {
        make(&path(directory, name)).map_err(LinkError::system("make a named pipe"))?;
    }
    open_now(directory, TO_HOST, OFlags::RDONLY).map_err(LinkError::system(OPEN))
}

/// Makes a pipe for this user alone.
#[cfg(not(target_os = "macos"))]
fn make(path: &Path) -> io::Result<()> {
    use rustix::fs::{CWD, mkfifoat};
    Ok(mkfifoat(CWD, path, Mode::RUSR | Mode::WUSR)?)
}

/// The same by the system's program: `rustix` has no such call there.
#[cfg(target_os = "macos")]
fn make(path: &Path) -> io::Result<()> {
    let made = Command::new("mkfifo")
        .args(["-m", "600"])
        .arg(path)
        .status()?;
    if made.success() {
        return Ok(());
    }
    Err(io::Error::other("`mkfifo` failed"))
}

/// Opens the pipe to the firmware; `None` if the firmware has not opened its side yet.
pub fn open_to_firmware(directory: &Path) -> Result<Option<OwnedFd>, LinkError> {
    match open_now(directory, TO_FIRMWARE, OFlags::WRONLY) {
        Err(Errno::NXIO) => Ok(None),
        opened => opened.map(Some).map_err(LinkError::system(OPEN)),
    }
}

/// Writes some of the bytes.
pub fn send(pipe: &OwnedFd, bytes: &[u8], deadline: Instant) -> Result<Transfer, LinkError> {
    transfer(pipe, PollFlags::OUT, deadline, || write(pipe, bytes))
        .map_err(LinkError::system("write to the firmware"))
}

/// Reads what there is, at least one byte.
pub fn receive(pipe: &OwnedFd, bytes: &mut [u8], deadline: Instant) -> Result<Transfer, LinkError> {
    transfer(pipe, PollFlags::IN, deadline, || read(pipe, &mut *bytes))
        .map_err(LinkError::system("read from the firmware"))
}

fn path(directory: &Path, name: &CStr) -> PathBuf {
    directory.join(OsStr::from_bytes(name.to_bytes()))
}

/// Opens a pipe without waiting for the other side, and keeps it from the emulators that this process starts.
fn open_now(directory: &Path, name: &CStr, mode: OFlags) -> Result<OwnedFd, Errno> {
    let flags = mode | OFlags::NONBLOCK | OFlags::CLOEXEC;
    open(path(directory, name), flags, Mode::empty())
}

/// Moves bytes as soon as the pipe is ready.
fn transfer(
    pipe: &OwnedFd,
    ready: PollFlags,
    deadline: Instant,
    mut attempt: impl FnMut() -> Result<usize, Errno>,
) -> Result<Transfer, Errno> {
    loop {
        if !wait(pipe, ready, deadline)? {
            return Ok(Transfer::TimedOut);
        }
        match attempt() {
            Ok(0) | Err(Errno::PIPE) => return Ok(Transfer::Closed),
            Ok(length) => return Ok(Transfer::Bytes(length)),
            Err(Errno::INTR | Errno::AGAIN) => {}
            Err(error) => return Err(error),
        }
    }
}

/// Waits until the pipe is ready or closed; `false` if that did not happen in time.
fn wait(pipe: &OwnedFd, ready: PollFlags, deadline: Instant) -> Result<bool, Errno> {
    let left = deadline.saturating_duration_since(Instant::now());
    let timeout = Timespec::try_from(left).map_err(|_| Errno::OVERFLOW)?;
    match poll(
        &mut [PollFd::from_borrowed_fd(pipe.as_fd(), ready)],
        Some(&timeout),
    ) {
        Ok(count) => Ok(count > 0),
        Err(Errno::INTR) => Ok(true),
        Err(error) => Err(error),
    }
}
