//! What a CAN interface of the machine has to be, and the errors if it is not, each with what to do.
//!
//! It is read from `/sys`: `socketcan` would ask by netlink, with a crate more and nothing that a test can stand in for.

use leg_firmware::can::{DATA_BIT_RATE, NOMINAL_BIT_RATE, SAMPLE_POINT_PERMILLE};
use std::fs;
use std::io;
use std::path::Path;

/// Where Linux lists its network interfaces.
pub(super) const INTERFACES: &str = "/sys/class/net";

/// `ARPHRD_CAN`: an interface's type.
const CAN_TYPE: u32 = 280;

/// `IFF_UP`: a bit of an interface's flags.
const UP: u32 = 1;

/// `CANFD_MTU`: one with a smaller MTU carries classic CAN only.
const CAN_FD_MTU: u32 = 72;

pub(super) fn refused(kind: io::ErrorKind, text: impl Into<String>) -> io::Error {
    io::Error::new(kind, text.into())
}

pub(super) fn no_can_error() -> io::Error {
    refused(
        io::ErrorKind::Unsupported,
        "this system's kernel has no CAN; load it with `modprobe can-raw`, or use another kernel",
    )
}

/// There is no such interface; `others` are the CAN interfaces that there are.
pub(super) fn interface_missing_error(name: &str, others: &[String]) -> io::Error {
    let text = format!(
        "there is no CAN interface `{name}`{}; plug its adapter in and load its driver, then {}",
        there_is(others),
        bring_up(name)
    );
    refused(io::ErrorKind::NotFound, text)
}

pub(super) fn interface_down_error(name: &str) -> io::Error {
    let text = format!("the CAN interface `{name}` is down; {}", bring_up(name));
    refused(io::ErrorKind::NetworkDown, text)
}

pub(super) fn bus_off_error(name: &str) -> io::Error {
    let text = format!(
        "the controller of `{name}` is off the bus after too many errors; check cable, terminators and that all nodes \
         have {}, then `ip link set {name} down` and {}",
        bit_rates(),
        bring_up(name)
    );
    refused(io::ErrorKind::ConnectionAborted, text)
}

pub(super) fn not_acknowledged_error(name: &str) -> io::Error {
    let text = format!(
        "nobody on `{name}` acknowledges what is sent; is the leg powered, is the cable terminated at both ends, and have \
         all nodes {}?",
        bit_rates()
    );
    refused(io::ErrorKind::TimedOut, text)
}

/// Whether an interface can carry CAN FD now, by the files below `interfaces` (`/sys/class/net`).
pub(super) fn check(interfaces: &Path, name: &str) -> io::Result<()> {
    let number = |what| number(interfaces, name, what);
    let others = can_interfaces(interfaces);
    Err(match (number("type"), number("flags"), number("mtu")) {
        (None, ..) => interface_missing_error(name, &others),
        (Some(kind), ..) if kind != CAN_TYPE => {
            let others = there_is(&others);
            let text = format!(
                "`{name}` is no CAN interface{others}; name one that `ip link show type can` lists"
            );
            refused(io::ErrorKind::InvalidInput, text)
        }
        (_, Some(flags), _) if flags & UP == 0 => interface_down_error(name),
        (.., Some(mtu)) if mtu < CAN_FD_MTU => {
            let text = format!(
                "the CAN interface `{name}` is up without CAN FD; `ip link set {name} down`, then {}; if that is refused, \
                 its adapter has no CAN FD",
                bring_up(name)
            );
            refused(io::ErrorKind::Unsupported, text)
        }
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

fn bit_rates() -> String {
    let [nominal, data] = [NOMINAL_BIT_RATE, DATA_BIT_RATE].map(|rate| rate / 1000);
    format!("{nominal} and {data} kbit/s")
}

fn bring_up(name: &str) -> String {
    let sample_point = f64::from(SAMPLE_POINT_PERMILLE) / 1000.0;
    format!(
        "`ip link set {name} up type can bitrate {NOMINAL_BIT_RATE} sample-point {sample_point} dbitrate {DATA_BIT_RATE} \
         dsample-point {sample_point} fd on`"
    )
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::check;
    use std::fs;
    use std::io;

    /// What is reported of `name` on a system with one interface of each kind: name, type, flags and MTU.
    fn checked(name: &str) -> io::Result<Result<(), String>> {
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
        Ok(check(directory.path(), name).map_err(|error| error.to_string()))
    }

    #[test]
    fn what_is_missing_is_named_with_its_remedy() -> io::Result<()> {
        assert_eq!(checked("can0")?, Ok(()));
        let settings = "up type can bitrate 1000000 sample-point 0.75 dbitrate 5000000 dsample-point 0.75 fd on`";
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
            assert_eq!(checked(name)?, Err(expected));
        }
        Ok(())
    }

    #[test]
    fn a_path_is_no_interface() -> io::Result<()> {
        for name in ["", ".", "..", "../can0", "can0/"] {
            let error = checked(name)?.unwrap_err();
            assert!(error.starts_with("there is no CAN interface"), "{error}");
        }
        Ok(())
    }
}
