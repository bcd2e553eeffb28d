//! The threads of a hub.

use super::super::port::NativePort;
use super::WELCOME;
use super::frame_writer::FrameWriter;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::Shutdown;
use std::os::unix::net::{UnixListener, UnixStream};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

/// Longest frame that is passed on, with much to spare.
const FRAME_MAX: u64 = 4096;

/// Wait before a client that does not read is dropped.
const CLIENT_WRITE_TIME: Duration = Duration::from_millis(50);

/// How often a hub that waits for clients looks whether its port has gone.
const WATCH_TIME: Timespec = Timespec {
    tv_sec: 0,
    tv_nsec: 200_000_000,
};

/// What all threads of a hub share.
struct Hub {
    clients: Mutex<Clients>,
    to_board: Mutex<FrameWriter<NativePort>>,
}

/// The streams to all clients.
#[derive(Default)]
struct Clients {
    streams: Vec<UnixStream>,
    /// Whether the port has gone: nobody is let in any more.
    ended: bool,
}

/// Serves a port to whoever comes to `listener`, and to the other end of the stream that it returns.
pub(super) fn start(tty: NativePort, listener: Option<UnixListener>) -> io::Result<UnixStream> {
    let (own, hubs) = UnixStream::pair()?;
    let to_board = tty.try_clone_native().map_err(io::Error::from)?;
    let hub = Arc::new(Hub {
        clients: Mutex::default(),
        to_board: Mutex::new(FrameWriter::new(to_board)),
    });
    serve(hubs, &hub)?;
    if let Some(listener) = listener {
        listener.set_nonblocking(true)?;
        let hub = Arc::clone(&hub);
        thread::spawn(move || listen(&listener, &hub));
    }
    thread::spawn(move || pass_on_from_board(tty, &hub));
    Ok(own)
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    // What a thread that failed left behind is whole: each change is one step.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Lets clients in until the port has gone.
fn listen(listener: &UnixListener, hub: &Arc<Hub>) {
    while !lock(&hub.clients).ended {
        // Whatever comes of the wait, `accept` shows what there is.
        let _ = poll(
            &mut [PollFd::new(listener, PollFlags::IN)],
            Some(&WATCH_TIME),
        );
        match listener.accept() {
            Ok((stream, _)) => {
                // A client that cannot be served sees its stream end.
                let _ = welcome(stream, hub);
            }
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {}
            // Too many open files, say: that does not change in a moment.
            Err(_) => thread::sleep(CLIENT_WRITE_TIME),
        }
    }
}

fn welcome(mut stream: UnixStream, hub: &Arc<Hub>) -> io::Result<()> {
    stream.set_nonblocking(false)?;
    stream.set_write_timeout(Some(CLIENT_WRITE_TIME))?;
    stream.write_all(&WELCOME)?;
    serve(stream, hub)
}

fn serve(stream: UnixStream, hub: &Arc<Hub>) -> io::Result<()> {
    stream.set_write_timeout(Some(CLIENT_WRITE_TIME))?;
    {
        let mut clients = lock(&hub.clients);
        if clients.ended {
            return Ok(());
        }
        clients.streams.push(stream.try_clone()?);
    }
    let hub = Arc::clone(hub);
    thread::spawn(move || {
        let _ = pass_on_from_client(&stream, &hub.to_board);
        // It is not left to wait for an answer.
        let _ = stream.shutdown(Shutdown::Both);
    });
    Ok(())
}

/// Passes whole frames to the board until the client or the port ends, or what comes is no frame.
fn pass_on_from_client(
    stream: &UnixStream,
    to_board: &Mutex<FrameWriter<NativePort>>,
) -> io::Result<()> {
    let mut reader = BufReader::new(stream);
    loop {
        let mut frame = Vec::new();
        reader.by_ref().take(FRAME_MAX).read_until(0, &mut frame)?;
        if !frame.ends_with(&[0]) {
            return Ok(());
        }
        lock(to_board).send(&frame)?;
    }
}

/// Passes bytes from the board to every client until the port ends, and then drops them all.
fn pass_on_from_board(mut tty: NativePort, hub: &Hub) {
    let mut bytes = [0; 4096];
    loop {
        match tty.read(&mut bytes) {
            Ok(0) => break,
            Ok(count) => {
                let bytes = bytes.get(..count).unwrap_or_default();
                let streams = &mut lock(&hub.clients).streams;
                streams.retain_mut(|client| pass_on(client, bytes));
            }
            Err(error) if error.kind() == io::ErrorKind::TimedOut => {}
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(_) => break,
        }
    }
    let mut clients = lock(&hub.clients);
    clients.ended = true;
    for client in clients.streams.drain(..) {
        let _ = client.shutdown(Shutdown::Both);
    }
}

/// Whether a client takes bytes; one that does not is dropped.
fn pass_on(client: &mut UnixStream, bytes: &[u8]) -> bool {
    let passed = client.write_all(bytes).is_ok();
    if !passed {
        let _ = client.shutdown(Shutdown::Both);
    }
    passed
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::super::receive;
    use super::start;
    use serialport::{SerialPort, TTYPort};
    use std::io::{ErrorKind, Read, Write};
    use std::os::unix::net::{UnixListener, UnixStream};
    use std::time::{Duration, Instant};

    const SOON: Duration = Duration::from_millis(200);

    /// After which a test that waits is taken to hang: the machine may have much else to do.
    const PATIENCE: Duration = Duration::from_secs(180);

    /// A board that does not read yet, and the hub of its port with a program at it.
    fn hub(listener: Option<UnixListener>) -> (TTYPort, UnixStream) {
        let (mut board, mut tty) = TTYPort::pair().unwrap();
        board.set_timeout(SOON).unwrap();
        tty.set_timeout(Duration::from_millis(5)).unwrap();
        (board, start(tty, listener).unwrap())
    }

    /// What comes until nothing does.
    fn read(board: &mut TTYPort) -> Vec<u8> {
        let (mut all, mut bytes) = (Vec::new(), [0; 4096]);
        while let Ok(count) = board.read(&mut bytes) {
            all.extend(&bytes[..count]);
        }
        all
    }

    #[test]
    fn a_board_that_reads_late_loses_frames_and_gets_the_next() {
        const NEXT: [u8; 4] = [1, 2, 3, 0];
        let (mut board, mut client) = hub(None);
        let frame = [[7; 999].as_slice(), &[0]].concat();
        // More than what system and port hold together: the last is written when the hub has given up some of them.
        for _ in 0..300 {
            client.write_all(&frame).unwrap();
        }
        let mut all = read(&mut board);
        let begun = Instant::now();
        let place = loop {
            client.write_all(&NEXT).unwrap();
            all.extend(read(&mut board));
            let place = all.windows(NEXT.len()).position(|bytes| bytes == NEXT);
            if let Some(place) = place {
                break place;
            }
            assert!(begun.elapsed() < PATIENCE, "it does not come");
        };
        assert!(place < 300 * frame.len(), "something was lost");
        // Whatever was started has its end before the next begins.
        let mut parts = all[..place].split_inclusive(|byte| *byte == 0);
        assert!(parts.all(|part| part.ends_with(&[0]) && part.len() <= frame.len()));
    }

    #[test]
    fn a_program_that_sends_no_frames_is_dropped() {
        let (_board, mut client) = hub(None);
        client.write_all(&[1; 5000]).unwrap();
        assert_eq!(receive(&mut client, &mut [0; 9], PATIENCE).unwrap(), 0);
    }

    #[test]
    fn a_hub_ends_with_its_port() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("hub");
        let (board, mut own) = hub(Some(UnixListener::bind(&path).unwrap()));
        let mut other = UnixStream::connect(&path).unwrap();
        assert_eq!(receive(&mut other, &mut [9; 9], PATIENCE).unwrap(), 1);
        drop(board);
        for client in [&mut own, &mut other] {
            assert_eq!(receive(client, &mut [0; 9], PATIENCE).unwrap(), 0);
        }
        let start = Instant::now();
        loop {
            match UnixStream::connect(&path) {
                Err(error) if error.kind() == ErrorKind::ConnectionRefused => return,
                _ => assert!(start.elapsed() < PATIENCE),
            }
        }
    }
}
