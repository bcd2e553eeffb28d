//! A port that several `leg` commands may use: see `hub`.

use super::port::NativePort;
use super::{hub, port};
use crate::transport::Transport;
use leg_base::failure::Failure;
use std::io::{self, Write};
use std::os::unix::net::UnixStream;
use std::time::{Duration, Instant};

/// How long a `leg` that has the port is waited for before it is said that it does not respond: if the leg moves, who has an
/// emergency stop shall not wait for the end.
const LATE_TIME: Duration = Duration::from_secs(2);

/// How often it is waited for: this machine may be so busy that it has to wait for seconds.
const SILENCES: u32 = 5;

/// How long a port is tried on which a hub ends again and again: within it this program, too, may have to wait.
const REJOIN_TIME: Duration = Duration::from_secs(10);

/// Wait before a port is tried again that another `leg` is about to open or to leave.
const RETRY_TIME: Duration = Duration::from_millis(20);

/// How often it is tried, while nobody lets this program in: for two seconds.
const RETRIES: u32 = 100;

/// The line to the board on a port, by the port's hub.
#[derive(Debug)]
pub struct Serial {
    port: String,
    stream: UnixStream,
    unshared: Option<String>,
}

impl Serial {
    /// Opens a port, or joins the `leg` that has opened it.
    ///
    /// # Errors
    /// A port that cannot be opened or is busy, or whose `leg` does not respond, is refused (exit code 2).
    pub fn open(port: &str) -> Result<Self, Failure> {
        Self::open_watched(port, |_| true)
    }

    /// The same, and calls `late` every two seconds in which the `leg` that has opened the port does not respond, with the
    /// failure in which that ends if it goes on, or if `late` returns false.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn open_watched(port: &str, late: impl FnMut(&Failure) -> bool) -> Result<Self, Failure> {
        let joined = join(port, late)?;
        Ok(Self {
            port: port.into(),
            stream: joined.stream,
            unshared: joined.unshared.map(|error| error.to_string()),
        })
    }

    /// Why no other program can use the port meanwhile, if so.
    pub fn unshared(&self) -> Option<&str> {
        self.unshared.as_deref()
    }

    /// Goes on after the program that had the port has ended. What was on its way is lost. A program that is about to end
    /// may still let another join.
    fn rejoin(&mut self) -> io::Result<()> {
        std::thread::sleep(Duration::from_millis(1));
        self.stream = join(&self.port, |_| true).map_err(io::Error::other)?.stream;
        Ok(())
    }
}

impl Transport for Serial {
    fn name(&self) -> &str {
        &self.port
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        let until = Instant::now() + REJOIN_TIME;
        loop {
            match self.stream.write_all(bytes) {
                Err(error) if hub::ended(&error) && Instant::now() < until => self.rejoin()?,
                result => return result,
            }
        }
    }

    fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize> {
        let until = Instant::now() + REJOIN_TIME;
        loop {
            match hub::receive(&mut self.stream, bytes, timeout) {
                Ok(0) if !bytes.is_empty() && Instant::now() < until => self.rejoin()?,
                result => return result,
            }
        }
    }
}

/// A place at the hub of a port; opens the port if nobody has.
fn join(port: &str, mut late: impl FnMut(&Failure) -> bool) -> Result<hub::Joined, Failure> {
    let (mut silences, mut retries) = (0, 0);
    loop {
        if let Some(tty) = port::open(port)? {
            return start_hub(tty, port)
                .map_err(|error| port::not_opened(port, &error.to_string()));
        }
        match hub::join(port, LATE_TIME) {
            Ok(joined) => return Ok(joined),
            Err(error) if error.kind() == io::ErrorKind::TimedOut => {
                let failure = not_responding(port);
                silences += 1;
                if silences == SILENCES || !late(&failure) {
                    return Err(failure);
                }
            }
            Err(_) if retries == RETRIES => {
                return Err(port::busy(port));
            }
            Err(_) => {
                retries += 1;
                std::thread::sleep(RETRY_TIME);
            }
        }
    }
}

fn not_responding(port: &str) -> Failure {
    Failure::refused(
        format!("another `leg` has the port {port} and does not respond"),
        "resume or end it; `fuser` with the port's path names it. If the leg moves, press the emergency stop",
    )
}

fn start_hub(tty: NativePort, port: &str) -> io::Result<hub::Joined> {
    let mut joined = hub::start(tty, port)?;
    // Ends whatever the board takes for the start of a frame.
    joined.stream.write_all(&[0])?;
    Ok(joined)
}
