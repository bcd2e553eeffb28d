//! One serial port for several programs: the `leg` that opens it first shares it with the others, so that `leg stop` and
//! `leg monitor` work beside `leg move`.
//!
//! Bytes from the board go to everyone, whole frames from everyone go to the board. When the program that has the port ends,
//! one of the others opens it.

mod frame_writer;
mod service;

use super::port::NativePort;
use std::io::{self, Read};
use std::os::unix::fs::{DirBuilderExt, MetadataExt};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::PathBuf;
use std::time::Duration;

/// What a hub sends to whoever joins it: the end of an empty frame. A program that was suspended does not come to it.
const WELCOME: [u8; 1] = [0];

/// A program's place at a hub, its own or another's.
#[derive(Debug)]
pub(super) struct Joined {
    /// Whole frames to the board, bytes from it.
    pub stream: UnixStream,
    /// Why no other program can join this one's hub, if so.
    pub unshared: Option<io::Error>,
}

/// Waits for bytes; 0 if the hub has ended. Without time, it takes what is there: the system's shortest wait is some milliseconds,
/// and where telemetry comes more often, somebody who takes all that is there would never be done.
pub(super) fn receive(
    stream: &mut UnixStream,
    bytes: &mut [u8],
    timeout: Duration,
) -> io::Result<usize> {
    let read = if timeout.is_zero() {
        stream.set_nonblocking(true)?;
        let read = stream.read(bytes);
        stream.set_nonblocking(false)?;
        read
    } else {
        stream.set_read_timeout(Some(timeout))?;
        stream.read(bytes)
    };
    match read {
        Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
            Err(io::ErrorKind::TimedOut.into())
        }
        Err(error) if ended(&error) => Ok(0),
        result => result,
    }
}

/// Whether an error means that the hub has ended.
pub(super) fn ended(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::BrokenPipe | io::ErrorKind::ConnectionReset | io::ErrorKind::NotConnected
    )
}

/// Joins the hub of another program; [`io::ErrorKind::TimedOut`] if that program lets in whoever comes but does nothing for
/// `timeout`.
pub(super) fn join(port: &str, timeout: Duration) -> io::Result<Joined> {
    let mut stream = UnixStream::connect(socket_path(port)?)?;
    match receive(&mut stream, &mut [0; WELCOME.len()], timeout)? {
        0 => Err(io::ErrorKind::UnexpectedEof.into()),
        _ => Ok(Joined {
            stream,
            unshared: None,
        }),
    }
}

/// Starts the hub of a port that this program has opened, and joins it. It ends with the program or the port. Where other
/// programs cannot join, it serves this one alone: to stop a leg has to be possible without a directory to write in.
pub(super) fn start(tty: NativePort, port: &str) -> io::Result<Joined> {
    let (listener, unshared) = match listen(port) {
        Ok(listener) => (Some(listener), None),
        Err(error) => (None, Some(error)),
    };
    let stream = service::start(tty, listener)?;
    Ok(Joined { stream, unshared })
}

fn listen(port: &str) -> io::Result<UnixListener> {
    let path = socket_path(port)?;
    // The port is this program's, so whoever had the socket has ended.
    let _ = std::fs::remove_file(&path);
    UnixListener::bind(&path)
}

/// The socket of a port, in a directory of this user.
pub(super) fn socket_path(port: &str) -> io::Result<PathBuf> {
    let port = std::fs::canonicalize(port)?;
    let name = port.to_string_lossy().replace('/', "-");
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
