//! Finding and opening a board's serial port.

use leg_base::failure::Failure;
use serialport::{ClearBuffer, ErrorKind, SerialPort, SerialPortInfo, SerialPortType, UsbPortInfo};
use std::io;
use std::time::Duration;

#[cfg(not(unix))]
pub(super) use serialport::COMPort as NativePort;
#[cfg(unix)]
pub(super) use serialport::TTYPort as NativePort;

/// Speed of the board's line.
const BAUD: u32 = 921_600;

/// Longest wait of a single read or write.
const STEP_TIME: Duration = Duration::from_millis(100);

/// USB vendor of the debugger on the board.
pub(super) const ST: u16 = 0x0483;

/// Its products that have a serial port: ST-LINK/V2-1 and /V3.
const ST_LINKS: [u16; 7] = [0x374b, 0x374e, 0x374f, 0x3752, 0x3753, 0x3754, 0x3757];

/// The port of the only ST-LINK that is plugged in; refused where there is none, or several.
pub fn find_board() -> Result<String, Failure> {
    // A machine without any serial port may say so by an error.
    choose(&serialport::available_ports().unwrap_or_default())
}

pub(super) fn choose(ports: &[SerialPortInfo]) -> Result<String, Failure> {
    let (boards, others): (Vec<_>, Vec<_>) = ports.iter().partition(|port| is_st_link(port));
    let [boards, others] = [boards, others]
        .map(|ports| -> Vec<&str> { ports.iter().map(|p| &*p.port_name).collect() });
    match boards.as_slice() {
        [board] => Ok((*board).into()),
        [] => {
            let others = match others.as_slice() {
                [] => String::new(),
                others => format!("; other serial ports: {}", others.join(", ")),
            };
            Err(Failure::refused(
                format!("no ST-LINK with a serial port is plugged in{others}"),
                "plug the board in, name its port with --port, or try without a board: --on sim",
            ))
        }
        boards => Err(Failure::refused(
            format!("several boards are plugged in: {}", boards.join(", ")),
            "name one of them with --port",
        )),
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

/// Opens a port for this program alone; none where another program has it.
pub(super) fn open(port: &str) -> Result<Option<NativePort>, Failure> {
    let builder = serialport::new(port, BAUD).timeout(STEP_TIME);
    // Elsewhere each port is.
    #[cfg(unix)]
    let builder = builder.exclusive(true);
    match builder.open_native() {
        Ok(tty) => {
            // What an earlier host did not read is not for this one. A port that cannot discard it is as good.
            let _ = tty.clear(ClearBuffer::All);
            Ok(Some(tty))
        }
        Err(error) if error.kind == ErrorKind::NoDevice => Ok(None),
        Err(error) => Err(refused(port, &error)),
    }
}

pub(super) fn refused(port: &str, error: &serialport::Error) -> Failure {
    match error.kind {
        ErrorKind::Io(io::ErrorKind::NotFound) => Failure::refused(
            format!("there is no port {port}"),
            "plug the board in, and look for its port with `ls /dev/tty*`",
        ),
        ErrorKind::Io(io::ErrorKind::PermissionDenied) => Failure::refused(
            format!("this user has no permission to open the port {port}"),
            "add yourself to the group that owns the port, often `dialout`, and log in again",
        ),
        _ => not_opened(port, &error.description),
    }
}

pub(super) fn busy(port: &str) -> Failure {
    let help = if cfg!(unix) {
        "end that program; `fuser` with the port's path names it. A `leg` shares its port with the commands of the same user and \
         TMPDIR alone: from another one, stop the leg by its emergency stop"
    } else {
        "end that program: on this system one program at a time may use a port"
    };
    Failure::refused(
        format!("the port {port} is busy: another program has opened it"),
        help,
    )
}

pub(super) fn not_opened(port: &str, reason: &str) -> Failure {
    Failure::refused(
        format!("cannot open the port {port}: {reason}"),
        "see that the path is that of a serial port",
    )
}
