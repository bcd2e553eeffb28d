//! A TCP port in the place of a serial one, for several programs at a time.
//!
//! Bytes from the board go to everyone, whole frames from everyone go to the board.

use crate::byte_port::BytePort;
use std::collections::VecDeque;
use std::io::{self, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream, ToSocketAddrs};

/// Longest frame that is passed on, with much to spare.
const FRAME_MAX: usize = 4096;

/// The board's end.
#[derive(Debug)]
pub struct TcpPort {
    listener: TcpListener,
    address: SocketAddr,
    clients: Vec<Client>,
    received: VecDeque<u8>,
}

/// A program that is connected.
#[derive(Debug)]
struct Client {
    stream: TcpStream,
    /// The beginning of a frame.
    begun: Vec<u8>,
}

impl TcpPort {
    /// Listens on an address; port 0 takes a free one.
    ///
    /// # Errors
    /// What the system says of an address that is none of this machine, or in use.
    pub fn listen(address: impl ToSocketAddrs) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        Ok(Self {
            address: listener.local_addr()?,
            listener,
            clients: Vec::new(),
            received: VecDeque::new(),
        })
    }

    fn accept(&mut self) {
        // A program that has gone again is no failure of the port.
        while let Ok((stream, _)) = self.listener.accept() {
            if stream.set_nonblocking(true).is_ok() && stream.set_nodelay(true).is_ok() {
                let begun = Vec::new();
                self.clients.push(Client { stream, begun });
            }
        }
    }
}

impl BytePort for TcpPort {
    fn name(&self) -> String {
        format!("tcp://{}", self.address)
    }

    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.accept();
        let received = &mut self.received;
        self.clients.retain_mut(|client| client.receive(received));
        received.read(bytes)
    }

    /// A program that does not read is dropped.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.clients.retain_mut(
            |client| matches!(client.stream.write(bytes), Ok(count) if count == bytes.len()),
        );
        Ok(bytes.len())
    }
}

impl Client {
    /// Takes what has come; false if the program has gone, or sends no frames.
    fn receive(&mut self, frames: &mut VecDeque<u8>) -> bool {
        let mut bytes = [0; FRAME_MAX];
        loop {
            match self.stream.read(&mut bytes) {
                Ok(0) => return false,
                Ok(count) => {
                    self.begun.extend(bytes.get(..count).unwrap_or_default());
                    let end = self.begun.iter().rposition(|byte| *byte == 0);
                    frames.extend(self.begun.drain(..end.map_or(0, |last| last + 1)));
                    if self.begun.len() > FRAME_MAX {
                        return false;
                    }
                }
                Err(error) => {
                    return matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted);
                }
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::*;

    fn connected(port: &TcpPort) -> TcpStream {
        TcpStream::connect(port.address).unwrap()
    }

    /// Reads until so many bytes have come.
    fn read(port: &mut TcpPort, count: usize) -> Vec<u8> {
        let (mut all, mut bytes) = (Vec::new(), [0; 64]);
        while all.len() < count {
            let count = port.read(&mut bytes).unwrap();
            all.extend(&bytes[..count]);
        }
        all
    }

    /// Reads until so many programs are connected.
    fn wait_for_clients(port: &mut TcpPort, count: usize) {
        while port.clients.len() != count {
            assert_eq!(port.read(&mut [0; 64]).unwrap(), 0);
        }
    }

    #[test]
    fn frames_of_two_programs_are_not_mixed() {
        let mut port = TcpPort::listen("127.0.0.1:0").unwrap();
        let [mut one, mut other] = [connected(&port), connected(&port)];
        one.write_all(&[1, 1]).unwrap();
        wait_for_clients(&mut port, 2);
        other.write_all(&[2, 0]).unwrap();
        assert_eq!(read(&mut port, 2), [2, 0]);
        one.write_all(&[1, 0, 1]).unwrap();
        assert_eq!(read(&mut port, 4), [1, 1, 1, 0]);
    }

    #[test]
    fn both_hear_the_board_and_one_may_go() {
        let mut port = TcpPort::listen("127.0.0.1:0").unwrap();
        let [mut one, mut other] = [connected(&port), connected(&port)];
        wait_for_clients(&mut port, 2);
        assert_eq!(port.write(&[7, 0]).unwrap(), 2);
        for program in [&mut one, &mut other] {
            let mut bytes = [9; 2];
            program.read_exact(&mut bytes).unwrap();
            assert_eq!(bytes, [7, 0]);
        }
        drop(one);
        wait_for_clients(&mut port, 1);
        assert_eq!(port.write(&[8, 0]).unwrap(), 2);
        other.read_exact(&mut [0; 2]).unwrap();
    }

    #[test]
    fn a_program_that_sends_no_frames_is_dropped() {
        let mut port = TcpPort::listen("127.0.0.1:0").unwrap();
        let mut program = connected(&port);
        wait_for_clients(&mut port, 1);
        program.write_all(&[1; 2 * FRAME_MAX]).unwrap();
        wait_for_clients(&mut port, 0);
    }

    #[test]
    fn a_program_that_does_not_read_is_dropped() {
        let mut port = TcpPort::listen("127.0.0.1:0").unwrap();
        let _program = connected(&port);
        wait_for_clients(&mut port, 1);
        while !port.clients.is_empty() {
            port.write(&[1; FRAME_MAX]).unwrap();
        }
    }
}
