//! A board on a serial port. Several programs of this kind may use one port: see [`super::hub`].

use super::Transport;
use super::hub::{self, Client, Started};
use serialport::{ClearBuffer, SerialPort, SerialPortInfo, SerialPortType, TTYPort, UsbPortInfo};
use std::io;
use std::time::{Duration, Instant};

#[cfg(test)]
mod tests;

/// Speed of the board's line.
const BAUD: u32 = 921_600;

/// Wait of a read or a write before it is looked at again.
const STEP_TIME: Duration = Duration::from_millis(100);

/// How long a port is tried that another program of this kind is about to open or to leave.
const OPEN_TIME: Duration = Duration::from_secs(2);

/// Vendor of the debugger on the board.
const ST: u16 = 0x0483;

/// Its products that have a serial port: ST-LINK/V2-1 and /V3.
const ST_LINKS: [u16; 7] = [0x374b, 0x374e, 0x374f, 0x3752, 0x3753, 0x3754, 0x3757];

/// Why there is no serial line.
#[derive(Debug, thiserror::Error)]
pub enum SerialError {
    /// No board is plugged in.
    #[error("no ST-LINK with a serial port is plugged in{}", others(.0))]
    NoBoard(Vec<String>),
    /// Several are.
    #[error("several boards are plugged in: {}", .0.join(", "))]
    SeveralBoards(Vec<String>),
    /// The port does not exist.
    #[error("there is no port {0}")]
    NoPort(String),
    /// Another program has it.
    #[error("the port {0} is busy: another program has opened it")]
    Busy(String),
    /// Another program of this kind has it, and was suspended.
    #[error("another `leg` has the port {0} and passes nothing on")]
    Suspended(String),
    /// The user may not open it.
    #[error("the port {0} may not be opened by this user")]
    Forbidden(String),
    /// The system says something else.
    #[error("cannot open the port {port}: {reason}")]
    System {
        /// The port.
        port: String,
        /// What the system says.
        reason: String,
    },
}

impl SerialError {
    /// What to do about it.
    #[must_use]
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::NoBoard(_) => {
                "plug the board in, name its port with --port, or try without a board: --on sim"
            }
            Self::SeveralBoards(_) => "name one of them with --port",
            Self::NoPort(_) => "plug the board in, and look for its port with `ls /dev/tty*`",
            Self::Busy(_) => "end that program; `fuser` with the port's path names it",
            Self::Suspended(_) => {
                "resume or end it; `fuser` with the port's path names it. If the leg moves, press the emergency stop"
            }
            Self::Forbidden(_) => {
                "add yourself to the group that owns the port, often `dialout`, and log in again"
            }
            Self::System { .. } => "see that the path is that of a serial port",
        }
    }
}

fn others(ports: &[String]) -> String {
    if ports.is_empty() {
        String::new()
    } else {
        format!("; other serial ports: {}", ports.join(", "))
    }
}

/// The port of the only ST-LINK that is plugged in.
///
/// # Errors
/// [`SerialError::NoBoard`] and [`SerialError::SeveralBoards`].
pub fn find() -> Result<String, SerialError> {
    // A machine without any serial port may say so by an error.
    choose(&serialport::available_ports().unwrap_or_default())
}

fn choose(ports: &[SerialPortInfo]) -> Result<String, SerialError> {
    let name = |port: &SerialPortInfo| port.port_name.clone();
    let (boards, others): (Vec<_>, Vec<_>) = ports.iter().partition(|port| is_st_link(port));
    let boards: Vec<String> = boards.into_iter().map(name).collect();
    match boards.as_slice() {
        [board] => Ok(board.clone()),
        [] => Err(SerialError::NoBoard(others.into_iter().map(name).collect())),
        _ => Err(SerialError::SeveralBoards(boards)),
    }
}

fn is_st_link(port: &SerialPortInfo) -> bool {
    // On a Mac each port has two names, of which that with `cu` is the one to open.
    let second_name = port.port_name.starts_with("/dev/tty.");
    match &port.port_type {
        SerialPortType::UsbPort(UsbPortInfo { vid, pid, .. }) => {
            *vid == ST && ST_LINKS.contains(pid) && !second_name
        }
        _ => false,
    }
}

/// The line to the board on a port.
#[derive(Debug)]
pub struct Serial {
    port: String,
    client: Client,
    alone: Option<String>,
}

impl Serial {
    /// Opens a port, or joins the program of this kind that has opened it.
    ///
    /// # Errors
    /// A [`SerialError`].
    pub fn open(port: &str) -> Result<Self, SerialError> {
        let Started { client, alone } = join(port)?;
        Ok(Self {
            port: port.into(),
            client,
            alone: alone.map(|error| error.to_string()),
        })
    }

    /// Why no other program can use the port meanwhile, if so.
    #[must_use]
    pub fn alone(&self) -> Option<&str> {
        self.alone.as_deref()
    }
}

impl Transport for Serial {
    fn name(&self) -> &str {
        &self.port
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        let until = Instant::now() + OPEN_TIME;
        loop {
            match self.client.send(bytes) {
                Err(error) if hub::ended(&error) && Instant::now() < until => {
                    self.client = self.again()?;
                }
                result => return result,
            }
        }
    }

    fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize> {
        let until = Instant::now() + OPEN_TIME;
        loop {
            match self.client.receive(bytes, timeout) {
                Ok(0) if !bytes.is_empty() && Instant::now() < until => {
                    self.client = self.again()?;
                }
                result => return result,
            }
        }
    }
}

impl Serial {
    /// Goes on after the program that had the port has ended. What was on its way is lost. A program that is about to end may
    /// still let another join.
    fn again(&self) -> io::Result<Client> {
        std::thread::sleep(Duration::from_millis(1));
        let started = join(&self.port).map_err(io::Error::other)?;
        Ok(started.client)
    }
}

/// A place at the hub of a port; opens the port if nobody has.
fn join(port: &str) -> Result<Started, SerialError> {
    let until = Instant::now() + OPEN_TIME;
    loop {
        let left = || until.saturating_duration_since(Instant::now());
        match open_port(port) {
            Ok(tty) => {
                return begin(tty, port).map_err(|error| SerialError::System {
                    port: port.into(),
                    reason: error.to_string(),
                });
            }
            Err(SerialError::Busy(_)) => {}
            Err(error) => return Err(error),
        }
        match hub::join(port, left()) {
            Ok(client) => {
                return Ok(Started {
                    client,
                    alone: None,
                });
            }
            Err(error) if error.kind() == io::ErrorKind::TimedOut => {
                return Err(SerialError::Suspended(port.into()));
            }
            Err(_) => {}
        }
        if left().is_zero() {
            return Err(SerialError::Busy(port.into()));
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}

fn begin(tty: TTYPort, port: &str) -> io::Result<Started> {
    let mut started = hub::start(tty, port)?;
    // Ends whatever the board takes for the beginning of a frame.
    started.client.send(&[0])?;
    Ok(started)
}

fn open_port(port: &str) -> Result<TTYPort, SerialError> {
    let opened = serialport::new(port, BAUD)
        .timeout(STEP_TIME)
        .exclusive(true)
        .open_native();
    let tty = opened.map_err(|error| refused(port, &error))?;
    // What an earlier host did not read is not for this one. A port that cannot forget is as good.
    let _ = tty.clear(ClearBuffer::All);
    Ok(tty)
}

fn refused(port: &str, error: &serialport::Error) -> SerialError {
    let port: String = port.into();
    match error.kind {
        serialport::ErrorKind::NoDevice => SerialError::Busy(port),
        serialport::ErrorKind::Io(io::ErrorKind::NotFound) => SerialError::NoPort(port),
        serialport::ErrorKind::Io(io::ErrorKind::PermissionDenied) => SerialError::Forbidden(port),
        _ => SerialError::System {
            port,
            reason: error.description.clone(),
        },
    }
}
