//! A port that one `leg` command may use at a time: this system has no local sockets for a hub.

use super::port::{self, NativePort};
use crate::transport::Transport;
use leg_base::failure::Failure;
use serialport::SerialPort;
use std::io::{self, Read, Write};
use std::time::Duration;

/// The line to the board on a port.
#[derive(Debug)]
pub struct Serial {
    port: String,
    line: NativePort,
}

impl Serial {
    /// Opens a port.
    ///
    /// # Errors
    /// A port that cannot be opened or is busy is refused (exit code 2).
    pub fn open(port: &str) -> Result<Self, Failure> {
        let Some(mut line) = port::open(port)? else {
            return Err(port::busy(port));
        };
        // Ends whatever the board takes for the start of a frame.
        let begun = line.write_all(&[0]);
        begun.map_err(|error| port::not_opened(port, &error.to_string()))?;
        Ok(Self {
            port: port.into(),
            line,
        })
    }

    /// The same: nobody is waited for.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn open_watched(port: &str, _: impl FnMut(&Failure) -> bool) -> Result<Self, Failure> {
        Self::open(port)
    }

    /// Why no other program can use the port meanwhile, if that is not so everywhere on this system.
    pub fn unshared(&self) -> Option<&str> {
        None
    }
}

impl Transport for Serial {
    fn name(&self) -> &str {
        &self.port
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.line.write_all(bytes)
    }

    fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize> {
        self.line.set_timeout(timeout)?;
        self.line.read(bytes)
    }
}
