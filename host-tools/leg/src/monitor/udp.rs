//! Datagrams to a program that plots them.

use leg_base::failure::Failure;
use std::io::{self, ErrorKind};
use std::net::{SocketAddr, ToSocketAddrs, UdpSocket};

/// A socket and where its datagrams go.
pub(super) struct Udp {
    socket: UdpSocket,
    receiver: SocketAddr,
}

impl Udp {
    pub(super) fn open(receiver: &str) -> Result<Self, Failure> {
        let open = || {
            let no_address = || io::Error::other("the name has no address");
            let receiver = receiver.to_socket_addrs()?.next().ok_or_else(no_address)?;
            let local = match receiver {
                SocketAddr::V4(_) => "0.0.0.0:0",
                SocketAddr::V6(_) => "[::]:0",
            };
            let socket = UdpSocket::bind(local)?;
            Ok(Self { socket, receiver })
        };
        open().map_err(|error| refused(receiver, &error))
    }

    pub(super) fn send(&self, line: &str) -> Result<(), Failure> {
        match self.socket.send_to(line.as_bytes(), self.receiver) {
            // Nobody has to listen, and what is lost is lost.
            Err(error) if !lost(error.kind()) => Err(refused(&self.receiver.to_string(), &error)),
            _ => Ok(()),
        }
    }
}

/// Whether it is the error of a datagram for which nobody waits, or has room.
const fn lost(kind: ErrorKind) -> bool {
    matches!(
        kind,
        ErrorKind::ConnectionRefused | ErrorKind::WouldBlock | ErrorKind::Interrupted
    )
}

fn refused(receiver: &str, error: &io::Error) -> Failure {
    let help = "give a host and a port, as 127.0.0.1:9870";
    Failure::refused(format!("cannot send to {receiver}: {error}"), help)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::Udp;
    use std::net::UdpSocket;

    #[test]
    fn a_missing_listener_is_no_error_but_a_refused_address_is() {
        let listener = UdpSocket::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap().to_string();
        let udp = Udp::open(&address).unwrap();
        udp.send("{}").unwrap();
        drop(listener);
        for _ in 0..3 {
            udp.send("{}").unwrap();
        }
        // The system refuses to send to everybody, or has no route.
        let everybody = Udp::open("255.255.255.255:9870").unwrap();
        assert!(everybody.send("{}").is_err());
    }
}
