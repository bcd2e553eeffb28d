//! One emulator and its pipes: sends requests, receives replies, notices every end.

use super::QemuConfig;
use super::log::{self, Log};
use super::pipes::{self, Transfer};
use super::process::{POLL_INTERVAL, Process, describe_exit};
use leg_firmware::frame::{self, Decoder, MAX_FRAME};
use leg_firmware_bench::exit::Exit;
use leg_firmware_bench::protocol::{BoardInfo, Refusal, Reply, Request};
use leg_sim::link::{self, Link, LinkError};
use std::os::fd::OwnedFd;
use std::path::Path;
use std::process::ExitStatus;
use std::thread;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Longest wait for the boot, for a reply and for the end, unless another one is set.
const TIMEOUT: Duration = Duration::from_secs(20);

/// Time that QEMU may take to end once its side of the link is closed.
const END_TIMEOUT: Duration = Duration::from_secs(5);

/// A booted firmware that answers. Dropping it ends QEMU and removes the pipes.
// The order of the fields is that of the end: first the process, then the directory.
#[derive(Debug)]
pub struct QemuSession {
    to_firmware: OwnedFd,
    from_firmware: OwnedFd,
    process: Process,
    log: Log,
    _directory: TempDir,
    decoder: Decoder,
    /// Number of the latest request.
    sequence: u16,
    timeout: Duration,
    /// None before the firmware has introduced itself.
    info: Option<BoardInfo>,
}

impl QemuSession {
    /// Boots the firmware and introduces the host to it.
    ///
    /// # Errors
    /// [`LinkError`] if QEMU, the image or the firmware fails, or the firmware was built from other sources.
    pub fn open(config: &QemuConfig) -> Result<Self, LinkError> {
        let table = log::table(&config.image)?;
        let directory = tempfile::Builder::new()
            .prefix("leg-qemu-")
            .tempdir()
            .map_err(LinkError::system("make a directory for the link"))?;
        let from_firmware = pipes::create(directory.path())?;
        let mut process = Process::start(config, directory.path())?;
        let (stdout, stderr) = process.outputs()?;
        let mut log = Log::collect(table, stdout, stderr, config.verbose);
        let to_firmware = meet(&mut process, &mut log, directory.path())?;
        let mut session = Self {
            to_firmware,
            from_firmware,
            process,
            log,
            _directory: directory,
            decoder: Decoder::new(),
            sequence: 0,
            timeout: TIMEOUT,
            info: None,
        };
        session.info = Some(link::greet(&mut session)?);
        Ok(session)
    }

    /// Sets the longest wait for a reply and for the end; 20 s if it is not set.
    pub const fn set_timeout(&mut self, timeout: Duration) {
        self.timeout = timeout;
    }

    /// What the firmware said of itself.
    #[must_use]
    pub const fn info(&self) -> Option<&BoardInfo> {
        self.info.as_ref()
    }

    /// Number of QEMU's process.
    #[must_use]
    pub fn process_id(&self) -> u32 {
        self.process.id()
    }

    /// The firmware's last log lines.
    #[must_use]
    pub fn log(&self) -> Vec<String> {
        self.log.last_lines()
    }

    /// Closes the link and waits for the firmware to end by itself.
    ///
    /// # Errors
    /// [`LinkError::Died`] if it ends in another way than by the closed link.
    pub fn close(mut self) -> Result<(), LinkError> {
        drop(self.to_firmware);
        match self.process.wait(Instant::now() + self.timeout)? {
            Some(status) if status.code() == Some(Exit::LinkClosed.code()) => Ok(()),
            Some(status) => Err(died(status, &mut self.log)),
            None => Err(timed_out(
                "end after the link was closed",
                self.timeout,
                &self.log,
            )),
        }
    }

    fn send(&mut self, mut bytes: &[u8], deadline: Instant) -> Result<(), LinkError> {
        while !bytes.is_empty() {
            let sent = pipes::send(&self.to_firmware, bytes, deadline)?;
            let length = self.length(sent, "take a request")?;
            bytes = bytes.get(length..).unwrap_or_default();
        }
        Ok(())
    }

    fn receive(&mut self, deadline: Instant) -> Result<Reply, LinkError> {
        let mut bytes = [0; MAX_FRAME];
        loop {
            let received = pipes::receive(&self.from_firmware, &mut bytes, deadline)?;
            let length = self.length(received, "answer")?;
            for &byte in bytes.get(..length).unwrap_or_default() {
                if let Some(frame) = self.decoder.push(byte) {
                    let frame = frame?;
                    let reply = frame.message().ok_or(LinkError::UnreadableReply)?;
                    return accepted(reply, frame.sequence, self.sequence);
                }
            }
        }
    }

    /// How many bytes were moved, or why none.
    fn length(&mut self, transfer: Transfer, action: &'static str) -> Result<usize, LinkError> {
        match transfer {
            Transfer::Bytes(length) => Ok(length),
            Transfer::TimedOut => Err(timed_out(action, self.timeout, &self.log)),
            // QEMU ends or has ended.
            Transfer::Closed => Err(match self.process.wait(Instant::now() + END_TIMEOUT)? {
                Some(status) => died(status, &mut self.log),
                None => timed_out("end after it had closed the link", self.timeout, &self.log),
            }),
        }
    }
}

impl Link for QemuSession {
    fn ask(&mut self, request: &Request) -> Result<Reply, LinkError> {
        let deadline = Instant::now() + self.timeout;
        let mut buffer = [0; MAX_FRAME];
        self.sequence = link::next_sequence(self.sequence);
        let bytes = frame::encode(self.sequence, request, &mut buffer)?;
        self.send(bytes, deadline)?;
        self.receive(deadline)
    }
}

/// A reply, if it is to the request that was sent last.
fn accepted(reply: Reply, received: u16, sent: u16) -> Result<Reply, LinkError> {
    match reply {
        Reply::Refused(Refusal::BadFrame(error)) => Err(LinkError::RequestDamaged(error)),
        _ if received == sent => Ok(reply),
        _ => Err(LinkError::OutOfStep { sent, received }),
    }
}

/// Waits until the firmware has opened both pipes.
fn meet(process: &mut Process, log: &mut Log, directory: &Path) -> Result<OwnedFd, LinkError> {
    let deadline = Instant::now() + TIMEOUT;
    loop {
        if let Some(pipe) = pipes::open_to_firmware(directory)? {
            return Ok(pipe);
        }
        if let Some(status) = process.ended()? {
            return Err(died(status, log));
        }
        if Instant::now() >= deadline {
            return Err(timed_out("boot", TIMEOUT, log));
        }
        thread::sleep(POLL_INTERVAL);
    }
}

fn timed_out(action: &'static str, timeout: Duration, log: &Log) -> LinkError {
    LinkError::TimedOut {
        action,
        timeout,
        log: log.last_lines(),
    }
}

fn died(status: ExitStatus, log: &mut Log) -> LinkError {
    LinkError::Died {
        reason: describe_exit(status),
        log: log.finish(),
    }
}
