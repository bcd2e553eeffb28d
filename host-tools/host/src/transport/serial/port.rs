//! Finding and opening a board's serial port.

use serialport::{ClearBuffer, SerialPort, SerialPortInfo, SerialPortType, TTYPort, UsbPortInfo};
use std::io;
use std::time::Duration;

/// Speed of the board's line.
const BAUD: u32 = 921_600;

/// Longest wait of a single read or write.
const STEP_TIME: Duration = Duration::from_millis(100);

/// USB vendor of the debugger on the board.
pub(super) const ST: u16 = 0x0483;

/// Its products that have a serial port: ST-LINK/V2-1 and /V3.
const ST_LINKS: [u16; 7] = [0x374b, 0x374e, 0x374f, 0x3752, 0x3753, 0x3754, 0x3757];

/// Why there is no serial line; each with the name of its port, or the names of several.
#[derive(Debug, thiserror::Error)]
pub enum SerialError {
    /// No board is plugged in; these are the other ports.
    #[error("no ST-LINK with a serial port is plugged in{}", other_ports(.0))]
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
    /// Another `leg` has it, and was suspended.
    #[error("another `leg` has the port {0} and does not respond")]
    Suspended(String),
    /// The user may not open it.
    #[error("this user has no permission to open the port {0}")]
    Forbidden(String),
    /// Another error of the system.
    #[error("cannot open the port {port}: {reason}")]
    System {
        /// The port.
        port: String,
        /// The error of the system.
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

fn other_ports(ports: &[String]) -> String {
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
pub fn find_board() -> Result<String, SerialError> {
    // A machine without any serial port may say so by an error.
    choose(&serialport::available_ports().unwrap_or_default())
}

pub(super) fn choose(ports: &[SerialPortInfo]) -> Result<String, SerialError> {
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

/// Opens a port for this program alone.
pub(super) fn open(port: &str) -> Result<TTYPort, SerialError> {
    let opened = serialport::new(port, BAUD)
        .timeout(STEP_TIME)
        .exclusive(true)
        .open_native();
    let tty = opened.map_err(|error| refused(port, &error))?;
    // What an earlier host did not read is not for this one. A port that cannot discard it is as good.
    let _ = tty.clear(ClearBuffer::All);
    Ok(tty)
}

pub(super) fn refused(port: &str, error: &serialport::Error) -> SerialError {
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
