//! A running emulator and its pipes: sends requests, receives replies, notices every end.

use super::QemuConfig;
use super::log::{self, Log};
use super::pipes::{self, FromFirmware, ToFirmware, Transfer};
use super::process::{POLL_INTERVAL, Process, describe};
use leg_firmware::frame::{self, Decoder, MAX_FRAME};
use leg_firmware_bench::exit::Exit;
use leg_firmware_bench::protocol::{Reply, Request};
use leg_sim::link::{Link, LinkError, Sequence};
use std::process::ExitStatus;
use std::thread;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Time that QEMU may take to end once its side of the link is closed.
const END_TIMEOUT: Duration = Duration::from_secs(5);

/// A session before its greeting. The order of the fields is that of the end: first the process, then the directory.
#[derive(Debug)]
pub struct Connection {
    to_firmware: ToFirmware,
    from_firmware: FromFirmware,
    process: Process,
    log: Log,
    _directory: TempDir,
    decoder: Decoder,
    sequence: Sequence,
    timeout: Duration,
}

impl Connection {
    /// Starts QEMU and waits until the firmware has opened both pipes.
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
        let to_firmware = meet(&mut process, &mut log, &directory, config.timeout)?;
        Ok(Self {
            to_firmware,
            from_firmware,
            process,
            log,
            _directory: directory,
            decoder: Decoder::new(),
            sequence: Sequence::default(),
            timeout: config.timeout,
        })
    }

    /// Number of QEMU's process.
    pub fn process_id(&self) -> u32 {
        self.process.id()
    }

    /// The firmware's last log lines.
    pub fn last_lines(&self) -> Vec<String> {
        self.log.last_lines()
    }

    fn send(&mut self, mut bytes: &[u8], deadline: Instant) -> Result<(), LinkError> {
        while !bytes.is_empty() {
            match self.to_firmware.write(bytes, deadline)? {
                Transfer::Bytes(length) => bytes = bytes.get(length..).unwrap_or_default(),
                Transfer::TimedOut => return Err(self.timed_out("take a request")),
                Transfer::Closed => return Err(self.died()),
            }
        }
        Ok(())
    }

    fn receive(&mut self, deadline: Instant) -> Result<Reply, LinkError> {
        let mut bytes = [0; MAX_FRAME];
        loop {
            let length = match self.from_firmware.read(&mut bytes, deadline)? {
                Transfer::Bytes(length) => length,
                Transfer::TimedOut => return Err(self.timed_out("answer")),
                Transfer::Closed => return Err(self.died()),
            };
            for &byte in bytes.get(..length).unwrap_or_default() {
                if let Some(reply) = self.decoder.push(byte) {
                    return self.sequence.accept(&reply?);
                }
            }
        }
    }

    fn timed_out(&self, action: &'static str) -> LinkError {
        LinkError::TimedOut {
            action,
            timeout: self.timeout,
            log: self.log.last_lines(),
        }
    }

    /// The firmware's side is closed: QEMU ends or has ended.
    fn died(&mut self) -> LinkError {
        match self.process.wait(Instant::now() + END_TIMEOUT) {
            Ok(Some(status)) => died(status, &mut self.log),
            Ok(None) => self.timed_out("end after it had closed the link"),
            Err(error) => error,
        }
    }

    /// As [`super::QemuSession::close`].
    pub fn close(self) -> Result<(), LinkError> {
        let Self {
            to_firmware,
            mut process,
            mut log,
            timeout,
            ..
        } = self;
        drop(to_firmware);
        match process.wait(Instant::now() + timeout)? {
            Some(status) if status.code() == Some(Exit::LinkClosed.code()) => Ok(()),
            Some(status) => Err(died(status, &mut log)),
            None => Err(LinkError::TimedOut {
                action: "end after the link was closed",
                timeout,
                log: log.last_lines(),
            }),
        }
    }
}

impl Link for Connection {
    fn ask(&mut self, request: &Request) -> Result<Reply, LinkError> {
        let deadline = Instant::now() + self.timeout;
        let mut buffer = [0; MAX_FRAME];
        let bytes = frame::encode(self.sequence.next_number(), request, &mut buffer)?;
        self.send(bytes, deadline)?;
        self.receive(deadline)
    }
}

/// Waits until the firmware has opened both pipes.
fn meet(
    process: &mut Process,
    log: &mut Log,
    directory: &TempDir,
    timeout: Duration,
) -> Result<ToFirmware, LinkError> {
    let deadline = Instant::now() + timeout;
    loop {
        if let Some(pipe) = ToFirmware::open(directory.path())? {
            return Ok(pipe);
        }
        if let Some(status) = process.ended()? {
            return Err(died(status, log));
        }
        if Instant::now() >= deadline {
            return Err(LinkError::TimedOut {
                action: "boot",
                timeout,
                log: log.last_lines(),
            });
        }
        thread::sleep(POLL_INTERVAL);
    }
}

fn died(status: ExitStatus, log: &mut Log) -> LinkError {
    LinkError::Died {
        reason: describe(status),
        log: log.finish(),
    }
}
