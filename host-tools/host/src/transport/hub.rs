//! One serial port for several programs: who opens it first passes on what the others say and hear, so that `leg stop` and
//! `leg monitor` work beside `leg move`.
//!
//! Bytes from the board go to everyone, whole frames from everyone go to the board. When the program that has the port ends,
//! one of the others opens it.

mod outgoing;
mod serving;

use serialport::TTYPort;
use std::io::{self, Read, Write};
use std::os::unix::fs::{DirBuilderExt, MetadataExt};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::PathBuf;
use std::time::Duration;

/// What a hub says to whoever joins it: the end of an empty frame. A program that was suspended does not come to it.
const WELCOME: [u8; 1] = [0];

/// A program's place at a hub, its own or another's.
#[derive(Debug)]
pub struct Client(UnixStream);

impl Client {
    /// Sends whole frames.
    ///
    /// # Errors
    /// What the system says; see [`ended`].
    pub fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.0.write_all(bytes)
    }

    /// Waits for bytes; 0 if the hub has ended.
    ///
    /// # Errors
    /// [`io::ErrorKind::TimedOut`]; what the system says.
    pub fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize> {
        // The system takes a timeout of zero for none.
        let timeout = timeout.max(Duration::from_micros(1));
        self.0.set_read_timeout(Some(timeout))?;
        match self.0.read(bytes) {
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                Err(io::ErrorKind::TimedOut.into())
            }
            Err(error) if ended(&error) => Ok(0),
            result => result,
        }
    }
}

/// Whether an error means that the hub has ended.
#[must_use]
pub fn ended(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::BrokenPipe | io::ErrorKind::ConnectionReset | io::ErrorKind::NotConnected
    )
}

/// Joins the hub of another program.
///
/// # Errors
/// [`io::ErrorKind::TimedOut`] if that program lets in whoever comes but does nothing for `patience`; what the system says if
/// there is none.
pub fn join(port: &str, patience: Duration) -> io::Result<Client> {
    let mut client = Client(UnixStream::connect(meeting_place(port)?)?);
    match client.receive(&mut [0; WELCOME.len()], patience)? {
        0 => Err(io::ErrorKind::UnexpectedEof.into()),
        _ => Ok(client),
    }
}

/// A hub that this program has started.
#[derive(Debug)]
pub struct Started {
    /// This program's place at it.
    pub client: Client,
    /// Why no other program can join it, if so.
    pub alone: Option<io::Error>,
}

/// Starts the hub of a port that this program has opened, and joins it. It ends with the program or the port. Where other
/// programs cannot meet it, it serves this one alone: to stop a leg has to be possible without a directory to write in.
///
/// # Errors
/// What the system says.
pub fn start(tty: TTYPort, port: &str) -> io::Result<Started> {
    let (listener, alone) = match meet(port) {
        Ok(listener) => (Some(listener), None),
        Err(error) => (None, Some(error)),
    };
    let client = Client(serving::start(tty, listener)?);
    Ok(Started { client, alone })
}

fn meet(port: &str) -> io::Result<UnixListener> {
    let place = meeting_place(port)?;
    // The port is this program's, so whoever met there has ended.
    let _ = std::fs::remove_file(&place);
    UnixListener::bind(&place)
}

/// The socket of a port, in a directory of this user.
pub(super) fn meeting_place(port: &str) -> io::Result<PathBuf> {
    let port = std::fs::canonicalize(port)?;
    let name: String = port
        .to_string_lossy()
        .chars()
        .map(|letter| if letter == '/' { '-' } else { letter })
        .collect();
    let user = rustix::process::getuid().as_raw();
    let directory = std::env::temp_dir().join(format!("leg-{user}"));
    std::fs::DirBuilder::new()
        .recursive(true)
        .mode(0o700)
        .create(&directory)?;
    if std::fs::symlink_metadata(&directory)?.uid() != user {
        return Err(io::ErrorKind::PermissionDenied.into());
    }
    Ok(directory.join(format!("{}.socket", name.trim_start_matches('-'))))
}
