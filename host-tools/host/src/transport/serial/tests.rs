#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::port::{ST, choose, refused};
use super::{Serial, SerialError, hub};
use crate::pseudo_terminal::PseudoTerminal;
use serialport::{SerialPortInfo, SerialPortType, UsbPortInfo};
use std::fs::File;
use std::io::ErrorKind;
use std::os::unix::net::UnixListener;

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
    assert_eq!(
        choose(&[other.clone(), board.clone()]).unwrap(),
        "/dev/ttyACM0"
    );
    let none = choose(&[other]).unwrap_err();
    assert_eq!(
        none.to_string(),
        "no ST-LINK with a serial port is plugged in; other serial ports: /dev/ttyUSB0"
    );
    let second = usb("/dev/ttyACM1", ST, 0x374b);
    let several = choose(&[board, second]).unwrap_err();
    assert!(matches!(several, SerialError::SeveralBoards(names) if names.len() == 2));
}

#[test]
fn what_is_no_port_is_refused_by_name() {
    let directory = tempfile::tempdir().unwrap();
    let missing = directory.path().join("ttyACM7");
    let error = Serial::open(&missing.display().to_string()).unwrap_err();
    assert!(matches!(error, SerialError::NoPort(_)), "{error}");
    let file = directory.path().join("file");
    std::fs::write(&file, "").unwrap();
    let error = Serial::open(&file.display().to_string()).unwrap_err();
    assert!(matches!(error, SerialError::System { .. }), "{error}");
}

#[test]
fn a_port_of_another_group_is_named_with_its_remedy() {
    let denied = serialport::ErrorKind::Io(ErrorKind::PermissionDenied);
    let error = refused("/dev/ttyACM0", &serialport::Error::new(denied, ""));
    assert!(matches!(error, SerialError::Forbidden(_)));
    assert!(error.to_string().contains("/dev/ttyACM0"), "{error}");
    assert!(error.remedy().contains("dialout"));
}

#[test]
fn a_program_that_has_the_port_and_is_suspended_is_not_taken_for_the_board() {
    let terminal = PseudoTerminal::open().unwrap();
    let port = terminal.path().display().to_string();
    let owner = File::open(terminal.path()).unwrap();
    owner.lock().unwrap();
    let path = hub::socket_path(&port).unwrap();
    let _ = std::fs::remove_file(&path);
    // It lets in whoever comes, by the system's hand, and does nothing.
    let _suspended = UnixListener::bind(&path).unwrap();
    let error = Serial::open(&port).unwrap_err();
    assert!(matches!(error, SerialError::Suspended(_)), "{error}");
}
