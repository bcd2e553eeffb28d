#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::Serial;
use super::port::{ST, choose, refused};
use serialport::{Error, ErrorKind, SerialPortInfo, SerialPortType, UsbPortInfo};
use std::io;

fn usb(name: &str, vid: u16, pid: u16) -> SerialPortInfo {
    SerialPortInfo {
        port_name: name.into(),
        port_type: SerialPortType::UsbPort(UsbPortInfo {
            vid,
            pid,
            serial_number: None,
            manufacturer: None,
            product: None,
        }),
    }
}

#[test]
fn the_only_st_link_is_chosen() {
    let other = usb("/dev/ttyUSB0", 0x1a86, 0x7523);
    let board = usb("/dev/ttyACM0", ST, 0x374e);
    let chosen = |ports: &[SerialPortInfo]| choose(ports).map_err(|failure| failure.to_string());
    assert_eq!(
        chosen(&[other.clone(), board.clone()]),
        Ok("/dev/ttyACM0".into())
    );
    assert_eq!(
        chosen(&[other]),
        Err("no ST-LINK with a serial port is plugged in; other serial ports: /dev/ttyUSB0".into())
    );
    assert_eq!(
        chosen(&[board, usb("/dev/ttyACM1", ST, 0x374b)]),
        Err("several boards are plugged in: /dev/ttyACM0, /dev/ttyACM1".into())
    );
}

#[test]
fn what_is_no_port_and_what_is_not_allowed_are_named_with_a_remedy() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let error = Serial::open(&file.path().display().to_string()).unwrap_err();
    assert!(
        error.to_string().starts_with("cannot open the port "),
        "{error}"
    );
    let denied = ErrorKind::Io(io::ErrorKind::PermissionDenied);
    let error = refused("/dev/ttyACM0", &Error::new(denied, ""));
    assert_eq!(
        error.to_string(),
        "this user has no permission to open the port /dev/ttyACM0"
    );
    assert!(error.render(false).contains("dialout"));
}
