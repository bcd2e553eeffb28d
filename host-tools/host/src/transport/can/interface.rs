//! What a CAN interface of the machine has to be, and the errors if it is not.
//!
//! It is read from `/sys`: `socketcan` would ask by netlink, with a crate more and nothing that a test can stand in for.

use leg_firmware::can::{DATA_BIT_RATE, LegAddress, NOMINAL_BIT_RATE};
use std::fs;
use std::io;
use std::path::Path;
use thiserror::Error;

/// Where Linux lists its network interfaces.
pub(super) const INTERFACES: &str = "/sys/class/net";

/// `ARPHRD_CAN`: an interface's type.
const CAN_TYPE: u32 = 280;

/// `IFF_UP`: a bit of an interface's flags.
const UP: u32 = 1;

/// `CANFD_MTU`: one with a smaller MTU carries classic CAN only.
const CAN_FD_MTU: u32 = 72;

/// Why a CAN interface cannot be used, and what to do. Each has the interface's name; where that is no CAN interface, those
/// that there are.
#[derive(Debug, PartialEq, Eq, Error)]
pub enum InterfaceError {
    /// The kernel has no CAN.
    #[error(
        "this system's kernel has no CAN; load it with `modprobe can-raw`, or use another kernel"
    )]
    NoCan,
    /// There is no such interface.
    #[error(
        "there is no CAN interface `{name}`{}; plug its adapter in and load its driver, then {}",
        there_is(.1), bring_up(.0), name = .0
    )]
    Missing(String, Vec<String>),
    /// It is a network interface of another kind.
    #[error("`{name}` is no CAN interface{}; name one that `ip link show type can` lists", there_is(.1), name = .0)]
    NotCan(String, Vec<String>),
    /// It is not up.
    #[error("the CAN interface `{name}` is down; {}", bring_up(.0), name = .0)]
    Down(String),
    /// It is up without CAN FD.
    #[error(
        "the CAN interface `{name}` is up without CAN FD; `ip link set {name} down`, then {}; \
         if that is refused, its adapter has no CAN FD",
        bring_up(.0), name = .0
    )]
    Classic(String),
    /// The controller went off the bus.
    #[error(
        "the controller of `{name}` is off the bus after too many errors; check cable, terminators and that all nodes \
         have {} and {} kbit/s, then `ip link set {name} down` and {}",
        NOMINAL_BIT_RATE / 1000, DATA_BIT_RATE / 1000, bring_up(.0), name = .0
    )]
    BusOff(String),
    /// Another `leg` sends under this leg's identifier.
    #[error(
        "another `leg` uses the CAN identifier of {1} on `{0}`; wait for it or end it: only `leg stop` goes beside it"
    )]
    Taken(String, LegAddress),
    /// What is sent is not acknowledged.
    #[error(
        "nobody on `{name}` acknowledges what is sent; is the leg powered, is the cable terminated at both ends, and have all \
         nodes {} and {} kbit/s?",
        NOMINAL_BIT_RATE / 1000, DATA_BIT_RATE / 1000, name = .0
    )]
    NotAcknowledged(String),
}

impl From<InterfaceError> for io::Error {
    fn from(error: InterfaceError) -> Self {
        let kind = match error {
            InterfaceError::NoCan | InterfaceError::Classic(_) => io::ErrorKind::Unsupported,
            InterfaceError::Missing(..) => io::ErrorKind::NotFound,
            InterfaceError::NotCan(..) => io::ErrorKind::InvalidInput,
            InterfaceError::Down(_) => io::ErrorKind::NetworkDown,
            InterfaceError::BusOff(_) => io::ErrorKind::ConnectionAborted,
            InterfaceError::NotAcknowledged(_) => io::ErrorKind::TimedOut,
            InterfaceError::Taken(..) => io::ErrorKind::ResourceBusy,
        };
        Self::new(kind, error)
    }
}

/// Whether an interface can carry CAN FD now, by the files below `interfaces` (`/sys/class/net`).
pub(super) fn check(interfaces: &Path, name: &str) -> Result<(), InterfaceError> {
    let number = |what| number(interfaces, name, what);
    let name = name.to_owned();
    let others = || can_interfaces(interfaces);
    Err(match (number("type"), number("flags"), number("mtu")) {
        (None, ..) => InterfaceError::Missing(name, others()),
        (Some(kind), ..) if kind != CAN_TYPE => InterfaceError::NotCan(name, others()),
        (_, Some(flags), _) if flags & UP == 0 => InterfaceError::Down(name),
        (.., Some(mtu)) if mtu < CAN_FD_MTU => InterfaceError::Classic(name),
        _ => return Ok(()),
    })
}

/// A number that the system reports of an interface, decimal or hexadecimal.
fn number(interfaces: &Path, name: &str, what: &str) -> Option<u32> {
    // Another directory's file is none of an interface.
    if name.is_empty() || name.contains('/') || name.starts_with('.') {
        return None;
    }
    let text = fs::read_to_string(interfaces.join(name).join(what)).ok()?;
    match text.trim().strip_prefix("0x") {
        Some(hexadecimal) => u32::from_str_radix(hexadecimal, 16).ok(),
        None => text.trim().parse().ok(),
    }
}

fn can_interfaces(interfaces: &Path) -> Vec<String> {
    let entries = fs::read_dir(interfaces).into_iter().flatten().flatten();
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let mut found: Vec<String> = names
        .filter(|name| number(interfaces, name, "type") == Some(CAN_TYPE))
        .collect();
    found.sort();
    found
}

fn there_is(names: &[String]) -> String {
    if names.is_empty() {
        return String::new();
    }
    format!(" (there is {})", names.join(", "))
}

fn bring_up(name: &str) -> String {
    format!(
        "`ip link set {name} up type can bitrate {NOMINAL_BIT_RATE} dbitrate {DATA_BIT_RATE} fd on`"
    )
}

#[cfg(test)]
mod tests {
    use super::{InterfaceError, check};
    use std::fs;
    use std::io;

    /// What is reported of `name` on a system with one interface of each kind: name, type, flags and MTU.
    fn checked(name: &str) -> io::Result<Result<(), InterfaceError>> {
        let directory = tempfile::tempdir()?;
        for [name, kind, flags, mtu] in [
            ["can0", "280", "0x40081", "72"],
            ["can1", "280", "0x40080", "72"],
            ["can2", "280", "0x40081", "16"],
            ["eth0", "1", "0x1003", "1500"],
        ] {
            let interface = directory.path().join(name);
            fs::create_dir(&interface)?;
            for (what, value) in [("type", kind), ("flags", flags), ("mtu", mtu)] {
                fs::write(interface.join(what), format!("{value}\n"))?;
            }
        }
        Ok(check(directory.path(), name))
    }

    #[test]
    fn what_is_missing_is_named_with_its_remedy() -> io::Result<()> {
        assert_eq!(checked("can0")?, Ok(()));
        let settings = "up type can bitrate 1000000 dbitrate 5000000 fd on`";
        for (name, expected) in [
            (
                "can1",
                format!("the CAN interface `can1` is down; `ip link set can1 {settings}"),
            ),
            (
                "can2",
                format!(
                    "the CAN interface `can2` is up without CAN FD; `ip link set can2 down`, then \
                     `ip link set can2 {settings}; if that is refused, its adapter has no CAN FD"
                ),
            ),
            (
                "eth0",
                "`eth0` is no CAN interface (there is can0, can1, can2); name one that `ip link show type can` lists"
                    .into(),
            ),
            (
                "can7",
                format!(
                    "there is no CAN interface `can7` (there is can0, can1, can2); plug its adapter in and load its \
                     driver, then `ip link set can7 {settings}"
                ),
            ),
        ] {
            let error = checked(name)?.map_err(|error| error.to_string());
            assert_eq!(error, Err(expected));
        }
        Ok(())
    }

    #[test]
    fn a_path_is_no_interface() -> io::Result<()> {
        for name in ["", ".", "..", "../can0", "can0/"] {
            let missing = matches!(checked(name)?, Err(InterfaceError::Missing(..)));
            assert!(missing, "{name}");
        }
        Ok(())
    }
}
