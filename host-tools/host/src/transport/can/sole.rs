//! One program at a time counts under a leg's identifier.

use super::InterfaceError;
use leg_firmware::can::LegAddress;
use std::io;
use std::os::linux::net::SocketAddrExt;
use std::os::unix::net::{SocketAddr, UnixListener};

/// The right to send to a leg under its ordinary identifier. It ends with the program, however that ends, and holds for all
/// users that see the interface: a name without a file belongs to the same network namespace.
#[derive(Debug)]
pub(super) struct Sole {
    _name: UnixListener,
}

impl Sole {
    /// Takes the right.
    ///
    /// # Errors
    /// [`InterfaceError::Taken`] inside; what else the system says.
    pub(super) fn take(interface: &str, leg: LegAddress) -> io::Result<Self> {
        let name = format!("leg/can/{interface}/{}", leg.number());
        match UnixListener::bind_addr(&SocketAddr::from_abstract_name(name)?) {
            Ok(listener) => Ok(Self { _name: listener }),
            Err(error) if error.kind() == io::ErrorKind::AddrInUse => {
                let name = interface.to_owned();
                Err(InterfaceError::Taken { name, leg }.into())
            }
            Err(error) => Err(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Sole;
    use leg_firmware::can::LegAddress;
    use std::io;

    #[test]
    fn a_second_program_is_refused_by_name_until_the_first_has_ended() -> io::Result<()> {
        let [leg, other, ..] = LegAddress::ALL;
        let first = Sole::take("can-of-this-test", leg)?;
        let refused = Sole::take("can-of-this-test", leg).map_err(|error| error.to_string());
        assert_eq!(
            refused.err().as_deref(),
            Some(
                "another `leg` uses the CAN identifier of leg 1 on `can-of-this-test`; wait for it or end it: only `leg stop` \
                 goes beside it"
            )
        );
        let _other = Sole::take("can-of-this-test", other)?;
        let _elsewhere = Sole::take("another-can-of-this-test", leg)?;
        drop(first);
        Sole::take("can-of-this-test", leg).map(drop)
    }
}
