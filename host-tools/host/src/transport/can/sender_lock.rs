//! One program at a time counts its frames under a leg's identifier.

use super::interface::refused;
use leg_firmware::can::LegAddress;
use std::io;
use std::os::linux::net::SocketAddrExt;
use std::os::unix::net::{SocketAddr, UnixListener};

/// Takes the right to send to a leg under its ordinary identifier: the listener. The right ends with the program, however
/// that ends, and holds for all users that see the interface: a name without a file belongs to the same network namespace.
pub(super) fn take(interface: &str, leg: LegAddress) -> io::Result<UnixListener> {
    let name = format!("leg/can/{interface}/{}", leg.number());
    UnixListener::bind_addr(&SocketAddr::from_abstract_name(name)?).map_err(|error| {
        if error.kind() != io::ErrorKind::AddrInUse {
            return error;
        }
        let text = format!(
            "another `leg` uses the CAN identifier of {leg} on `{interface}`; wait for it or end it: only `leg stop` goes \
             beside it"
        );
        refused(io::ErrorKind::ResourceBusy, text)
    })
}

#[cfg(test)]
mod tests {
    use super::take;
    use leg_firmware::can::LegAddress;
    use std::io;

    #[test]
    fn a_second_program_is_refused_by_name_until_the_first_has_ended() -> io::Result<()> {
        let [leg, other, ..] = LegAddress::ALL;
        let first = take("can-of-this-test", leg)?;
        let refused = take("can-of-this-test", leg).map_err(|error| error.to_string());
        assert_eq!(
            refused.err().as_deref(),
            Some(
                "another `leg` uses the CAN identifier of leg 1 on `can-of-this-test`; wait for it or end it: only `leg stop` \
                 goes beside it"
            )
        );
        let _other = take("can-of-this-test", other)?;
        let _elsewhere = take("another-can-of-this-test", leg)?;
        drop(first);
        take("can-of-this-test", leg).map(drop)
    }
}
