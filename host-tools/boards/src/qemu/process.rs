//! QEMU's process: started, watched, and never left behind.

use super::QemuConfig;
use leg_firmware_bench::exit::Exit;
use leg_sim::link::LinkError;
use std::io::ErrorKind;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, ChildStderr, ChildStdout, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// How often a wait looks again.
pub const POLL_INTERVAL: Duration = Duration::from_millis(1);

/// A running emulator; dropping it ends it.
#[derive(Debug)]
pub struct Process(Child);

impl Process {
    /// Starts QEMU in `directory`, with its outputs captured.
    pub fn start(config: &QemuConfig, directory: &Path) -> Result<Self, LinkError> {
        let child = Command::new(&config.qemu)
            .args(["-M", "mps2-an386"])
            .args(["-semihosting-config", "enable=on,target=native"])
            .args(["-nographic", "-monitor", "none", "-serial", "null"])
            .args(["-icount", config.clock.icount()])
            .arg("-kernel")
            .arg(&config.image)
            .current_dir(directory)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn();
        child.map(Self).map_err(|source| LinkError::QemuNotStarted {
            program: config.qemu.display().to_string(),
            source,
        })
    }

    /// Its number.
    pub fn id(&self) -> u32 {
        self.0.id()
    }

    /// Takes its standard output and its standard error.
    pub fn outputs(&mut self) -> Result<(ChildStdout, ChildStderr), LinkError> {
        self.0
            .stdout
            .take()
            .zip(self.0.stderr.take())
            .ok_or_else(|| LinkError::system("capture QEMU's output")(ErrorKind::NotFound))
    }

    /// How it ended, if it has.
    pub fn ended(&mut self) -> Result<Option<ExitStatus>, LinkError> {
        self.0
            .try_wait()
            .map_err(LinkError::system("ask how QEMU ended"))
    }

    /// Waits for the end; `None` if it did not come in time.
    pub fn wait(&mut self, deadline: Instant) -> Result<Option<ExitStatus>, LinkError> {
        loop {
            let ended = self.ended()?;
            if ended.is_some() || Instant::now() >= deadline {
                return Ok(ended);
            }
            thread::sleep(POLL_INTERVAL);
        }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // Its exit status is taken from the system, so that nothing of it stays. Both fail only if it has ended and was
        // waited for: then there is nothing to do.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// What the exit status of QEMU means, as a sentence.
#[must_use]
pub fn describe_exit(status: ExitStatus) -> String {
    match (status.code(), status.signal()) {
        (Some(code), _) => match Exit::from_code(code) {
            Some(exit) => format!("the firmware {} (exit code {code})", exit.meaning()),
            None => format!("QEMU failed (exit code {code})"),
        },
        (None, Some(signal)) => format!("QEMU was ended by signal {signal}"),
        (None, None) => "QEMU ended without an exit code".to_owned(),
    }
}
