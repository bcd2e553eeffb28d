//! One program at a time counts its frames under a leg's identifier.

use super::InterfaceError;
use leg_firmware::can::LegAddress;
use std::io;
use std::os::linux::net::SocketAddrExt;
use std::os::unix::net::{SocketAddr, UnixListener};

/// The right to send to a leg under its ordinary identifier. It ends with the program, however that ends, and holds for all
/// users that see the interface: a name without a file belongs to the same network namespace.
#[derive(Debug)]
pub(super) struct SenderLock {
    _name: UnixListener,
}

impl SenderLock {
    /// Takes the right.
    ///
    /// # Errors
    /// [`InterfaceError::Taken`] inside; another error of the system.
    pub(super) fn take(interface: &str, leg: LegAddress) -> io::Result<Self> {
        let name = format!("leg/can/{interface}/{}", leg.number());
        match UnixListener::bind_addr(&SocketAddr::from_abstract_name(name)?) {
            Ok(listener) => Ok(Self { _name: listener }),
            Err(error) if error.kind() == io::ErrorKind::AddrInUse => {
                Err(InterfaceError::Taken(interface.to_owned(), leg).into())
            }
            Err(error) => Err(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::SenderLock;
    use leg_firmware::can::LegAddress;
    use std::io;

    #[test]
    fn a_second_program_is_refused_by_name_until_the_first_has_ended() -> io::Result<()> {
        let [leg, other, ..] = LegAddress::ALL;
        let first = SenderLock::take("can-of-this-test", leg)?;
        let refused = SenderLock::take("can-of-this-test", leg).map_err(|error| error.to_string());
        assert_eq!(
            refused.err().as_deref(),
            Some(
                "another `leg` uses the CAN identifier of leg 1 on `can-of-this-test`; wait for it or end it: only `leg stop` \
                 goes beside it"
            )
        );
        let _other = SenderLock::take("can-of-this-test", other)?;
        let _elsewhere = SenderLock::take("another-can-of-this-test", leg)?;
        drop(first);
        SenderLock::take("can-of-this-test", leg).map(drop)
    }
}
