//! The connection of one page.

use super::pages::{Pages, lock};
use std::io::ErrorKind;
use std::net::TcpStream;
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, TryRecvError};
use std::time::Duration;
use tungstenite::{Error, Message, WebSocket};

/// Longest time for a page to send something of its introduction, and to take a message.
pub const PATIENCE: Duration = Duration::from_secs(2);

/// From one look at what a page sends to the next at what it is sent.
pub const TURN_TIME: Duration = Duration::from_millis(5);

/// Passes on what a page and the leg send each other, until one of them ends.
pub fn serve(mut socket: WebSocket<TcpStream>, pages: &Mutex<Pages>) {
    let (id, messages) = lock(pages).add();
    while turn(&mut socket, &messages, |message| {
        lock(pages).take(id, message)
    }) {}
    lock(pages).remove(id);
    // The page learns that it has ended, if it is still there.
    let _ = socket.close(None);
    let _ = socket.flush();
}

/// Sends what waits, and takes what has come; false if the connection has ended.
fn turn(
    socket: &mut WebSocket<TcpStream>,
    messages: &Receiver<Message>,
    take: impl FnOnce(Message) -> bool,
) -> bool {
    let ended = loop {
        match messages.try_recv() {
            Ok(message) => {
                if socket.write(message).is_err() {
                    return false;
                }
            }
            Err(TryRecvError::Empty) => break false,
            Err(TryRecvError::Disconnected) => break true,
        }
    };
    if socket.flush().is_err_and(|error| !is_idle(&error)) || ended {
        return false;
    }
    match socket.read() {
        Ok(message) => take(message),
        Err(error) => is_idle(&error),
    }
}

/// Whether nothing has come in time.
fn is_idle(error: &Error) -> bool {
    let idle = [
        ErrorKind::WouldBlock,
        ErrorKind::TimedOut,
        ErrorKind::Interrupted,
    ];
    matches!(error, Error::Io(error) if idle.contains(&error.kind()))
}
