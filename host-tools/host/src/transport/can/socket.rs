//! A CAN interface of Linux.

use super::interface::{INTERFACES, check};
use super::sole::Sole;
use super::{CanPort, InterfaceError};
use leg_firmware::can::{CanFrame, Identifier, LegAddress};
use rustix::io::Errno;
use socketcan::{
    CanAnyFrame, CanFdFrame, CanFdSocket, CanFilter, EmbeddedFrame, Frame, Id, Socket,
    SocketOptions, StandardId,
};
use std::io;
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
    _sole: Option<Sole>,
}

impl SocketCan {
    /// Opens an interface by its name, as `can0`, to talk to a leg. One program at a time may.
    ///
    /// # Errors
    /// An [`InterfaceError`] inside: no CAN in the kernel, no such interface, not up, without CAN FD, taken by another
    /// program. What else the system says.
    pub fn open(name: &str, leg: LegAddress) -> io::Result<Self> {
        check(Path::new(INTERFACES), name)?;
        let sole = Sole::take(name, leg)?;
        Self::begin(name, leg, Some(sole))
    }

    /// The same beside whatever other program talks to that leg, for one that sends urgent frames only.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn open_beside(name: &str, leg: LegAddress) -> io::Result<Self> {
        check(Path::new(INTERFACES), name)?;
        Self::begin(name, leg, None)
    }

    fn begin(name: &str, leg: LegAddress, sole: Option<Sole>) -> io::Result<Self> {
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
            _sole: sole,
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

/// What the system says, with its cause and remedy where they are known.
fn explain(error: io::Error, name: &str) -> io::Error {
    let name = name.to_owned();
    match Errno::from_io_error(&error) {
        Some(Errno::AFNOSUPPORT | Errno::PROTONOSUPPORT) => InterfaceError::NoCan.into(),
        Some(Errno::NODEV | Errno::NXIO) => InterfaceError::Missing {
            name,
            others: Vec::new(),
        }
        .into(),
        Some(Errno::NETDOWN) => InterfaceError::Down { name }.into(),
        Some(Errno::NOBUFS | Errno::AGAIN) => InterfaceError::NotTaken { name }.into(),
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
            let name = name.to_owned();
            Err(InterfaceError::BusOff { name }.into())
        }
        _ => Ok(None),
    }
}

fn from_fd(frame: &CanFdFrame) -> Option<CanFrame> {
    let Id::Standard(id) = frame.hal_id() else {
        return None;
    };
    let identifier = Identifier::from_bits(id.as_raw())?;
    CanFrame::new(identifier, frame.data()).ok()
}

#[cfg(test)]
mod tests {
    use super::{SocketCan, explain, from_socket, to_socket};
    use leg_firmware::can::{CanFrame, Identifier, LegAddress};
    use rustix::io::Errno;
    use socketcan::frame::CanErrorFrame;
    use socketcan::{CanAnyFrame, CanDataFrame, CanFdFrame, EmbeddedFrame, ExtendedId, StandardId};
    use std::io;

    const LEG: LegAddress = LegAddress::ALL[4];

    #[test]
    fn a_frame_comes_back_from_the_sockets_form() -> io::Result<()> {
        for size in [0, 3, 8, 12, 48, 64] {
            let payload: Vec<u8> = (0..size).collect();
            let Ok(frame) = CanFrame::new(Identifier::ToLeg(LEG), &payload) else {
                panic!("{size} bytes are a size that CAN FD has")
            };
            let sent = to_socket(&frame)?;
            assert!(
                sent.is_brs(),
                "the payload goes at the data phase's bit rate"
            );
            assert_eq!(sent.data(), payload);
            assert_eq!(from_socket(&sent.into(), "can0")?, Some(frame));
        }
        Ok(())
    }

    #[test]
    fn what_is_no_frame_of_the_bus_is_passed_over() -> io::Result<()> {
        let standard = |bits| StandardId::new(bits).map(socketcan::Id::from);
        let extended = ExtendedId::new(0x105).map(socketcan::Id::from);
        let fd = |id: Option<socketcan::Id>| CanFdFrame::new(id?, &[1; 8]).map(CanAnyFrame::from);
        let classic = standard(0x105).and_then(|id| CanDataFrame::new(id, &[1; 8]));
        for frame in [
            fd(standard(0x107)),
            fd(extended),
            classic.map(CanAnyFrame::from),
            CanErrorFrame::new_error(libc::CAN_ERR_ACK, &[])
                .ok()
                .map(CanAnyFrame::from),
        ] {
            let Some(frame) = frame else {
                panic!("the frame can be made")
            };
            assert_eq!(from_socket(&frame, "can0")?, None);
        }
        Ok(())
    }

    #[test]
    fn a_bus_off_is_told_with_its_cure() {
        let Ok(frame) = CanErrorFrame::new_error(libc::CAN_ERR_BUSOFF, &[]) else {
            panic!("the frame can be made")
        };
        let Err(error) = from_socket(&frame.into(), "can0") else {
            panic!("a bus-off is no frame")
        };
        assert_eq!(error.kind(), io::ErrorKind::ConnectionAborted);
        assert_eq!(
            error.to_string(),
            "the controller of `can0` is off the bus after too many errors; check cable, terminators and that all \
             nodes have 1000 and 5000 kbit/s, then `ip link set can0 down` and \
             `ip link set can0 up type can bitrate 1000000 dbitrate 5000000 fd on`"
        );
    }

    #[test]
    fn the_systems_refusals_have_a_cure() {
        for (errno, beginning) in [
            (Errno::AFNOSUPPORT, "this system's kernel has no CAN; "),
            (Errno::NODEV, "there is no CAN interface `can0`; "),
            (Errno::NETDOWN, "the CAN interface `can0` is down; "),
            (Errno::NOBUFS, "nobody on `can0` takes what is sent; "),
        ] {
            let text = explain(errno.into(), "can0").to_string();
            assert!(text.starts_with(beginning), "{text}");
        }
    }

    #[test]
    fn an_interface_that_is_not_there_or_of_another_kind_is_refused() {
        for open in [SocketCan::open, SocketCan::open_beside] {
            let refused = |name| open(name, LEG).map(drop).map_err(|error| error.kind());
            assert_eq!(refused("no-such-can"), Err(io::ErrorKind::NotFound));
            assert_eq!(refused("lo"), Err(io::ErrorKind::InvalidInput));
        }
    }
}
