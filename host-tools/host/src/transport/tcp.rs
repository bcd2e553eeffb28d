//! An emulated board of another process, by TCP: `leg emulate --tcp`.

use super::Transport;
use leg_base::failure::Failure;
use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::Duration;

/// What the name of such a port begins with.
pub const SCHEME: &str = "tcp://";

/// A connection.
#[derive(Debug)]
pub struct Tcp {
    name: String,
    stream: TcpStream,
}

impl Tcp {
    /// Connects to an address: `127.0.0.1:5000`.
    ///
    /// # Errors
    /// An address at which nothing listens is refused (exit code 2).
    pub fn open(address: &str) -> Result<Self, Failure> {
        let connected = TcpStream::connect(address).and_then(|stream| {
            stream.set_nodelay(true)?;
            Ok(stream)
        });
        let stream = connected.map_err(|error| {
            Failure::refused(
                format!("cannot connect to {SCHEME}{address}: {error}"),
                "start `leg emulate --tcp`, which prints the port's name",
            )
        })?;
        let name = format!("{SCHEME}{address}");
        Ok(Self { name, stream })
    }
}

impl Transport for Tcp {
    fn name(&self) -> &str {
        &self.name
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.stream.write_all(bytes)
    }

    fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize> {
        // Without time it takes what is there: the system's shortest wait is some milliseconds.
        let read = if timeout.is_zero() {
            self.stream.set_nonblocking(true)?;
            let read = self.stream.read(bytes);
            self.stream.set_nonblocking(false)?;
            read
        } else {
            self.stream.set_read_timeout(Some(timeout))?;
            self.stream.read(bytes)
        };
        match read {
            Err(error) if error.kind() == ErrorKind::WouldBlock => Err(ErrorKind::TimedOut.into()),
            result => result,
        }
    }
}
