//! What a CAN interface of the machine has to be, and what is told if it is not.

use leg_firmware::can::{DATA_BIT_RATE, LegAddress, NOMINAL_BIT_RATE};
use std::fs;
use std::io;
use std::path::Path;
use thiserror::Error;

/// Where Linux tells of its network interfaces.
pub(super) const INTERFACES: &str = "/sys/class/net";

/// `ARPHRD_CAN`: an interface's type.
const CAN_TYPE: u32 = 280;

/// `IFF_UP`: a bit of an interface's flags.
const UP: u32 = 1;

/// `CANFD_MTU`: one with a smaller MTU carries classic CAN only.
const CAN_FD_MTU: u32 = 72;

/// Why a CAN interface cannot be used, and what to do.
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
        there_is(.others), bring_up(.name)
    )]
    Missing {
        /// The name that was asked for.
        name: String,
        /// The CAN interfaces that there are.
        others: Vec<String>,
    },
    /// It is a network interface of another kind.
    #[error("`{name}` is no CAN interface{}; name one that `ip link show type can` lists", there_is(.others))]
    NotCan {
        /// The name that was asked for.
        name: String,
        /// The CAN interfaces that there are.
        others: Vec<String>,
    },
    /// It is not up.
    #[error("the CAN interface `{name}` is down; {}", bring_up(.name))]
    Down {
        /// Its name.
        name: String,
    },
    /// It is up without CAN FD.
    #[error(
        "the CAN interface `{name}` is up without CAN FD; `ip link set {name} down`, then {}; \
         if that is refused, its adapter has no CAN FD",
        bring_up(.name)
    )]
    Classic {
        /// Its name.
        name: String,
    },
    /// The controller went off the bus.
    #[error(
        "the controller of `{name}` is off the bus after too many errors; check cable, terminators and that all nodes \
         have {} and {} kbit/s, then `ip link set {name} down` and {}",
        NOMINAL_BIT_RATE / 1000, DATA_BIT_RATE / 1000, bring_up(.name)
    )]
    BusOff {
        /// Its name.
        name: String,
    },
    /// Another program of this kind counts under the leg's identifier.
    #[error(
        "another `leg` uses the CAN identifier of {leg} on `{name}`; wait for it or end it: only `leg stop` goes beside it"
    )]
    Taken {
        /// Its name.
        name: String,
        /// The leg.
        leg: LegAddress,
    },
    /// What is sent is not taken.
    #[error(
        "nobody on `{name}` takes what is sent; is the leg powered, is the cable terminated at both ends, and have all \
         nodes {} and {} kbit/s?",
        NOMINAL_BIT_RATE / 1000, DATA_BIT_RATE / 1000
    )]
    NotTaken {
        /// Its name.
        name: String,
    },
}

impl InterfaceError {
    const fn kind(&self) -> io::ErrorKind {
        match self {
            Self::NoCan => io::ErrorKind::Unsupported,
            Self::Missing { .. } => io::ErrorKind::NotFound,
            Self::NotCan { .. } => io::ErrorKind::InvalidInput,
            Self::Down { .. } => io::ErrorKind::NetworkDown,
            Self::Classic { .. } => io::ErrorKind::Unsupported,
            Self::BusOff { .. } => io::ErrorKind::ConnectionAborted,
            Self::NotTaken { .. } => io::ErrorKind::TimedOut,
            Self::Taken { .. } => io::ErrorKind::ResourceBusy,
        }
    }
}

impl From<InterfaceError> for io::Error {
    fn from(error: InterfaceError) -> Self {
        Self::new(error.kind(), error)
    }
}

/// Looks into `interfaces` (of Linux: `/sys/class/net`) whether one can carry CAN FD now.
pub(super) fn check(interfaces: &Path, name: &str) -> Result<(), InterfaceError> {
    let number = |what| number(interfaces, name, what);
    let others = || can_interfaces(interfaces);
    let name = name.to_owned();
    match (number("type"), number("flags"), number("mtu")) {
        (None, ..) => Err(InterfaceError::Missing {
            name,
            others: others(),
        }),
        (Some(kind), ..) if kind != CAN_TYPE => Err(InterfaceError::NotCan {
            name,
            others: others(),
        }),
        (_, Some(flags), _) if flags & UP == 0 => Err(InterfaceError::Down { name }),
        (.., Some(mtu)) if mtu < CAN_FD_MTU => Err(InterfaceError::Classic { name }),
        _ => Ok(()),
    }
}

/// A number that the system tells of an interface, decimal or hexadecimal.
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
    use tempfile::TempDir;

    /// A system with these interfaces: name, type, flags and MTU.
    fn system(interfaces: &[[&str; 4]]) -> io::Result<TempDir> {
        let directory = TempDir::new()?;
        for [name, kind, flags, mtu] in interfaces {
            let of = directory.path().join(name);
            fs::create_dir(&of)?;
            for (what, value) in [("type", kind), ("flags", flags), ("mtu", mtu)] {
                fs::write(of.join(what), format!("{value}\n"))?;
            }
        }
        Ok(directory)
    }

    /// What is told of `name` on a system with one interface of each kind.
    fn told(name: &str) -> io::Result<Option<String>> {
        let directory = system(&[
            ["can0", "280", "0x40081", "72"],
            ["can1", "280", "0x40080", "72"],
            ["can2", "280", "0x40081", "16"],
            ["eth0", "1", "0x1003", "1500"],
        ])?;
        Ok(check(directory.path(), name)
            .err()
            .map(|error| error.to_string()))
    }

    #[test]
    fn an_interface_with_can_fd_that_is_up_will_do() -> io::Result<()> {
        assert_eq!(told("can0")?, None);
        Ok(())
    }

    #[test]
    fn what_is_missing_is_named_with_its_cure() -> io::Result<()> {
        let up = "`ip link set can1 up type can bitrate 1000000 dbitrate 5000000 fd on`";
        assert_eq!(
            told("can1")?,
            Some(format!("the CAN interface `can1` is down; {up}"))
        );
        assert_eq!(
            told("can2")?.as_deref(),
            Some(
                "the CAN interface `can2` is up without CAN FD; `ip link set can2 down`, then \
                 `ip link set can2 up type can bitrate 1000000 dbitrate 5000000 fd on`; \
                 if that is refused, its adapter has no CAN FD"
            )
        );
        assert_eq!(
            told("eth0")?.as_deref(),
            Some(
                "`eth0` is no CAN interface (there is can0, can1, can2); name one that `ip link show type can` lists"
            )
        );
        assert_eq!(
            told("can7")?.as_deref(),
            Some(
                "there is no CAN interface `can7` (there is can0, can1, can2); \
                 plug its adapter in and load its driver, then \
                 `ip link set can7 up type can bitrate 1000000 dbitrate 5000000 fd on`"
            )
        );
        Ok(())
    }

    #[test]
    fn a_path_is_no_interface() -> io::Result<()> {
        for name in ["", ".", "..", "../can0", "can0/"] {
            let directory = system(&[["can0", "280", "0x1", "72"]])?;
            let error = check(directory.path(), name);
            assert!(
                matches!(error, Err(InterfaceError::Missing { .. })),
                "{name}"
            );
        }
        Ok(())
    }
}
