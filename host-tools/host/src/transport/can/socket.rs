//! A CAN interface of Linux.

use super::CanPort;
use super::interface::{self, INTERFACES, check};
use super::sender_lock;
use leg_firmware::can::{CanFrame, Identifier, LegAddress};
use rustix::io::Errno;
use socketcan::{
    CanAnyFrame, CanFdFrame, CanFdSocket, CanFilter, EmbeddedFrame, Frame, Id, Socket,
    SocketOptions, StandardId,
};
use std::io;
use std::os::unix::net::UnixListener;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// How long a full queue is waited for: a hundred times what ten frames take.
const SEND_TIMEOUT: Duration = Duration::from_millis(200);

/// How long until a full queue is tried again.
const QUEUE_RETRY: Duration = Duration::from_micros(500);

/// Of what the queueing discipline sends before the rest (`TC_PRIO_INTERACTIVE`); more needs privileges.
const URGENT_PRIORITY: i32 = 6;

/// The CAN FD interface of a Linux machine, with what one leg sends.
///
/// It has two sockets: the kernel's queue in front of the controller sends what comes from the urgent one first.
#[derive(Debug)]
pub struct SocketCan {
    name: String,
    ordinary: CanFdSocket,
    urgent: CanFdSocket,
    /// None where only urgent frames are sent.
    _lock: Option<UnixListener>,
}

impl SocketCan {
    /// Opens an interface by its name, as `can0`, to talk to a leg. One program at a time may.
    ///
    /// # Errors
    /// No CAN in the kernel, no such interface, one that is down, without CAN FD or taken by another program: each with what
    /// to do. Other errors of the system as they are.
    pub fn open(name: &str, leg: LegAddress) -> io::Result<Self> {
        check(Path::new(INTERFACES), name)?;
        let lock = sender_lock::take(name, leg)?;
        Self::open_sockets(name, leg, Some(lock))
    }

    /// The same for urgent frames only, beside the program that talks to the leg.
    ///
    /// # Errors
    /// As [`Self::open`], but that no program takes the interface.
    pub fn open_urgent(name: &str, leg: LegAddress) -> io::Result<Self> {
        check(Path::new(INTERFACES), name)?;
        Self::open_sockets(name, leg, None)
    }

    fn open_sockets(name: &str, leg: LegAddress, lock: Option<UnixListener>) -> io::Result<Self> {
        let open = || CanFdSocket::open(name).map_err(|error| explain(error, name));
        let (ordinary, urgent) = (open()?, open()?);
        let from_leg = CanFilter::new(u32::from(Identifier::ToHost(leg).bits()), EXACTLY);
        ordinary.set_filters(&[from_leg])?;
        ordinary.set_error_filter(libc::CAN_ERR_BUSOFF)?;
        urgent.set_filter_drop_all()?;
        urgent.set_socket_option_int(libc::SOL_SOCKET, libc::SO_PRIORITY, URGENT_PRIORITY)?;
        for socket in [&ordinary, &urgent] {
            socket.set_write_timeout(SEND_TIMEOUT)?;
        }
        Ok(Self {
            name: name.to_owned(),
            ordinary,
            urgent,
            _lock: lock,
        })
    }
}

/// All 11 bits, of a data frame with 11 of them.
const EXACTLY: u32 = libc::CAN_SFF_MASK | libc::CAN_EFF_FLAG | libc::CAN_RTR_FLAG;

impl CanPort for SocketCan {
    fn name(&self) -> &str {
        &self.name
    }

    fn send(&mut self, frame: &CanFrame) -> io::Result<()> {
        let socket = if frame.identifier().urgent() {
            &self.urgent
        } else {
            &self.ordinary
        };
        let frame = to_socket(frame)?;
        let start = Instant::now();
        loop {
            match socket.write_frame(&frame) {
                Err(error) if full(&error) && start.elapsed() < SEND_TIMEOUT => sleep(QUEUE_RETRY),
                result => return result.map_err(|error| explain(error, &self.name)),
            }
        }
    }

    fn receive(&mut self, timeout: Duration) -> io::Result<CanFrame> {
        let start = Instant::now();
        loop {
            let left = timeout.saturating_sub(start.elapsed());
            let frame = match self.ordinary.read_frame_timeout(left) {
                Ok(frame) => frame,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => return Err(explain(error, &self.name)),
            };
            if let Some(frame) = from_socket(&frame, &self.name)? {
                return Ok(frame);
            }
        }
    }
}

/// The queue in front of the controller is full.
fn full(error: &io::Error) -> bool {
    Errno::from_io_error(error) == Some(Errno::NOBUFS)
}

/// The error of the system, with its cause and remedy where they are known.
fn explain(error: io::Error, name: &str) -> io::Error {
    match Errno::from_io_error(&error) {
        Some(Errno::AFNOSUPPORT | Errno::PROTONOSUPPORT) => interface::no_can_error(),
        Some(Errno::NODEV | Errno::NXIO) => interface::interface_missing_error(name, &[]),
        Some(Errno::NETDOWN) => interface::interface_down_error(name),
        Some(Errno::NOBUFS | Errno::AGAIN) => interface::not_acknowledged_error(name),
        _ => error,
    }
}

fn to_socket(frame: &CanFrame) -> io::Result<CanFdFrame> {
    let refused = || io::Error::from(io::ErrorKind::InvalidInput);
    let identifier = StandardId::new(frame.identifier().bits()).ok_or_else(refused)?;
    let mut frame = CanFdFrame::new(identifier, frame.payload()).ok_or_else(refused)?;
    frame.set_brs(true);
    Ok(frame)
}

/// A frame of the bus; `None` for one that is none of it.
fn from_socket(frame: &CanAnyFrame, name: &str) -> io::Result<Option<CanFrame>> {
    match frame {
        CanAnyFrame::Fd(frame) => Ok(from_fd(frame)),
        CanAnyFrame::Error(error) if error.error_bits() & libc::CAN_ERR_BUSOFF != 0 => {
            Err(interface::bus_off_error(name))
        }
        _ => Ok(None),
    }
}

fn from_fd(frame: &CanFdFrame) -> Option<CanFrame> {
    match frame.hal_id() {
        Id::Standard(id) => CanFrame::new(Identifier::from_bits(id.as_raw())?, frame.data()).ok(),
        Id::Extended(_) => None,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{SocketCan, explain, from_socket, to_socket};
    use leg_firmware::can::{CanFrame, Identifier, LegAddress};
    use rustix::io::Errno;
    use socketcan::frame::CanErrorFrame;
    use socketcan::{CanAnyFrame, CanDataFrame, CanFdFrame, EmbeddedFrame, ExtendedId, StandardId};
    use std::io;

    const LEG: LegAddress = LegAddress::ALL[4];

    fn error_frame(bits: u32) -> CanAnyFrame {
        CanErrorFrame::new_error(bits, &[]).unwrap().into()
    }

    #[test]
    fn a_frame_comes_back_from_the_sockets_form() {
        for size in [0, 3, 8, 12, 48, 64] {
            let payload: Vec<u8> = (0..size).collect();
            let frame = CanFrame::new(Identifier::ToLeg(LEG), &payload).unwrap();
            let sent = to_socket(&frame).unwrap();
            assert!(
                sent.is_brs(),
                "the payload goes at the data phase's bit rate"
            );
            assert_eq!(sent.data(), payload);
            assert_eq!(from_socket(&sent.into(), "can0").unwrap(), Some(frame));
        }
    }

    #[test]
    fn what_is_no_frame_of_the_bus_is_passed_over() {
        let standard = |bits| StandardId::new(bits).unwrap();
        for frame in [
            CanFdFrame::new(standard(0x107), &[1; 8]).unwrap().into(),
            CanFdFrame::new(ExtendedId::new(0x105).unwrap(), &[1; 8])
                .unwrap()
                .into(),
            CanDataFrame::new(standard(0x105), &[1; 8]).unwrap().into(),
            error_frame(libc::CAN_ERR_ACK),
        ] {
            assert_eq!(from_socket(&frame, "can0").unwrap(), None);
        }
    }

    #[test]
    fn a_bus_off_is_reported_with_its_remedy() {
        let error = from_socket(&error_frame(libc::CAN_ERR_BUSOFF), "can0").unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::ConnectionAborted);
        assert_eq!(
            error.to_string(),
            "the controller of `can0` is off the bus after too many errors; check cable, terminators and that all \
             nodes have 1000 and 5000 kbit/s, then `ip link set can0 down` and \
             `ip link set can0 up type can bitrate 1000000 sample-point 0.75 dbitrate 5000000 dsample-point 0.75 fd on`"
        );
    }

    #[test]
    fn the_systems_refusals_have_a_remedy() {
        for (errno, start) in [
            (Errno::AFNOSUPPORT, "this system's kernel has no CAN; "),
            (Errno::NODEV, "there is no CAN interface `can0`; "),
            (Errno::NETDOWN, "the CAN interface `can0` is down; "),
            (
                Errno::NOBUFS,
                "nobody on `can0` acknowledges what is sent; ",
            ),
        ] {
            let text = explain(errno.into(), "can0").to_string();
            assert!(text.starts_with(start), "{text}");
        }
    }

    #[test]
    fn an_interface_that_is_not_there_or_of_another_kind_is_refused() {
        for (name, kind) in [
            ("no-such-can", io::ErrorKind::NotFound),
            ("lo", io::ErrorKind::InvalidInput),
        ] {
            for open in [SocketCan::open, SocketCan::open_urgent] {
                assert_eq!(open(name, LEG).unwrap_err().kind(), kind);
            }
        }
    }
}
