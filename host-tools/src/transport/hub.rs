//! One serial port for several programs: who opens it first passes on what the others say and hear, so that `leg stop` and
//! `leg monitor` work beside `leg move`.
//!
//! Bytes from the board go to everyone, whole frames from everyone go to the board. When the program that has the port ends,
//! one of the others opens it.

use serialport::TTYPort;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::Shutdown;
use std::os::unix::fs::{DirBuilderExt, MetadataExt};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

/// Longest frame that is passed on, with much to spare.
const FRAME_MAX: u64 = 4096;

/// Wait before a client that does not read is let go.
const PATIENCE: Duration = Duration::from_millis(50);

/// The streams to all clients.
type Clients = Arc<Mutex<Vec<UnixStream>>>;

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
/// What the system says if there is none.
pub fn join(port: &str) -> io::Result<Client> {
    UnixStream::connect(meeting_place(port)?).map(Client)
}

/// Starts the hub of a port that this program has opened, and joins it. It ends with the program or the port.
///
/// # Errors
/// What the system says.
pub fn start(tty: TTYPort, port: &str) -> io::Result<Client> {
    let place = meeting_place(port)?;
    // The port is this program's, so whoever met there has ended.
    let _ = std::fs::remove_file(&place);
    let listener = UnixListener::bind(&place)?;
    let (own, hubs) = UnixStream::pair()?;
    let clients = Clients::default();
    let to_board = Arc::new(Mutex::new(tty.try_clone_native().map_err(io::Error::from)?));
    welcome(hubs, &clients, &to_board)?;
    let listening = Arc::clone(&clients);
    thread::spawn(move || listen(&listener, &listening, &to_board));
    thread::spawn(move || pass_on_from_board(tty, &clients));
    Ok(Client(own))
}

/// The socket of a port, in a folder of this user.
fn meeting_place(port: &str) -> io::Result<PathBuf> {
    let port = std::fs::canonicalize(port)?;
    let name: String = port
        .to_string_lossy()
        .chars()
        .map(|letter| if letter == '/' { '-' } else { letter })
        .collect();
    let user = rustix::process::getuid().as_raw();
    let folder = std::env::temp_dir().join(format!("leg-{user}"));
    std::fs::DirBuilder::new()
        .recursive(true)
        .mode(0o700)
        .create(&folder)?;
    if std::fs::symlink_metadata(&folder)?.uid() != user {
        return Err(io::ErrorKind::PermissionDenied.into());
    }
    Ok(folder.join(format!("{}.socket", name.trim_start_matches('-'))))
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    // What a thread that failed left behind is whole: each change is one step.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn listen(listener: &UnixListener, clients: &Clients, to_board: &Arc<Mutex<TTYPort>>) {
    for stream in listener.incoming().flatten() {
        // A client that cannot be served sees its stream end.
        let _ = welcome(stream, clients, to_board);
    }
}

fn welcome(
    stream: UnixStream,
    clients: &Clients,
    to_board: &Arc<Mutex<TTYPort>>,
) -> io::Result<()> {
    stream.set_write_timeout(Some(PATIENCE))?;
    lock(clients).push(stream.try_clone()?);
    let to_board = Arc::clone(to_board);
    thread::spawn(move || pass_on_from_client(stream, &to_board));
    Ok(())
}

/// Passes whole frames to the board until the client or the port ends.
fn pass_on_from_client(stream: UnixStream, to_board: &Mutex<TTYPort>) {
    let mut reader = BufReader::new(stream);
    loop {
        let mut frame = Vec::new();
        match reader.by_ref().take(FRAME_MAX).read_until(0, &mut frame) {
            Ok(1..) if frame.ends_with(&[0]) => {}
            _ => return,
        }
        if lock(to_board).write_all(&frame).is_err() {
            return;
        }
    }
}

/// Passes what the board says to every client until the port ends, and then lets them all go.
fn pass_on_from_board(mut tty: TTYPort, clients: &Clients) {
    let mut bytes = [0; 4096];
    loop {
        match tty.read(&mut bytes) {
            Ok(0) => break,
            Ok(count) => {
                let bytes = bytes.get(..count).unwrap_or_default();
                lock(clients).retain_mut(|client| heard(client, bytes));
            }
            Err(error) if error.kind() == io::ErrorKind::TimedOut => {}
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(_) => break,
        }
    }
    for client in lock(clients).drain(..) {
        let _ = client.shutdown(Shutdown::Both);
    }
}

/// Whether a client takes bytes; one that does not is let go.
fn heard(client: &mut UnixStream, bytes: &[u8]) -> bool {
    let heard = client.write_all(bytes).is_ok();
    if !heard {
        let _ = client.shutdown(Shutdown::Both);
    }
    heard
}
