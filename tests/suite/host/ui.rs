//! `leg ui` serves a page to this machine.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::stalls::PATIENCE;
use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use std::fs::{self, Permissions};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::os::unix::fs::PermissionsExt;
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::NamedTempFile;

/// What stands for the page.
const PAGE: &str = "<!doctype html>the leg";

/// Where programs are looked for.
fn path() -> String {
    std::env::var("PATH").unwrap()
}

pub fn leg(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_leg-under-test"));
    command.args(arguments);
    command
}

/// `leg ui` with a page that was exported before.
pub struct Served {
    process: Child,
    /// The loopback address and the port.
    pub address: String,
    /// Where its page finds the leg; empty without one.
    pub leg: String,
    _page: NamedTempFile,
}

impl Served {
    /// With more arguments, which may name a leg.
    pub fn new(more: &[&str]) -> Self {
        Self::open(&[&["--no-open", "--json"], more].concat(), &path())
    }

    /// With programs that are looked for in these directories.
    fn open(arguments: &[&str], path: &str) -> Self {
        let mut file = NamedTempFile::new().unwrap();
        file.write_all(PAGE.as_bytes()).unwrap();
        let page = file.path().display().to_string();
        let mut process = leg(&["ui", "--page", &page])
            .args(arguments)
            .env("PATH", path)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        let mut output = BufReader::new(process.stdout.take().unwrap());
        output.read_line(&mut line).unwrap();
        let told: Value = serde_json::from_str(&line).unwrap();
        let url = told["url"].as_str().unwrap();
        let (page, leg) = url.split_once("#leg=").unwrap_or((url, ""));
        let address = page
            .strip_prefix("http://")
            .and_then(|rest| rest.strip_suffix('/'));
        Self {
            address: address.unwrap().into(),
            leg: leg.into(),
            process,
            _page: file,
        }
    }

    /// As Ctrl-C.
    pub fn interrupt(&self) {
        let id = Pid::from_child(&self.process);
        kill_process(id, Signal::INT).unwrap();
    }

    /// Waits for its end; its exit code.
    pub fn wait(&mut self) -> Option<i32> {
        self.process.wait().unwrap().code()
    }

    /// Where its page comes from, as a browser says it.
    pub fn origin(&self) -> String {
        format!("http://{}", self.address)
    }

    /// The status line and the body of an answer.
    fn ask(&self, request: &str) -> (String, String) {
        let mut stream = TcpStream::connect(&self.address).unwrap();
        let rest = "HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n";
        write!(stream, "{request} {rest}").unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        let (head, body) = answer.split_once("\r\n\r\n").unwrap();
        let (status, headers) = head.split_once("\r\n").unwrap();
        assert!(headers.contains("Cache-Control: no-store"), "{headers}");
        (status.into(), body.into())
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

pub fn refused(arguments: &[&str]) -> String {
    let Output { status, stderr, .. } = leg(arguments).output().unwrap();
    assert_eq!(status.code(), Some(2));
    String::from_utf8(stderr).unwrap()
}

#[test]
fn one_page_is_served_and_nothing_else() {
    let mut served = Served::new(&[]);
    assert!(
        served.address.starts_with("127.0.0.1:"),
        "{}",
        served.address
    );
    // One that asks for nothing keeps no other waiting.
    let _silent = TcpStream::connect(&served.address).unwrap();
    for path in ["/", "/index.html", "/?from=elsewhere"] {
        let (status, body) = served.ask(&format!("GET {path}"));
        assert_eq!((status.as_str(), body.as_str()), ("HTTP/1.1 200 OK", PAGE));
    }
    assert_eq!(served.ask("HEAD /").1, "");
    for path in ["/../Cargo.toml", "/etc/passwd", "//"] {
        assert!(
            served.ask(&format!("GET {path}")).0.contains("404"),
            "{path}"
        );
    }
    assert!(served.ask("POST /").0.contains("405"));
    let port = served.address.rsplit(':').next().unwrap();
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml");
    let told = refused(&["ui", "--no-open", "--page", page, "--http-port", port]);
    assert!(
        told.contains(port) && told.contains("--http-port"),
        "{told}"
    );
    // Ctrl-C ends it as what was asked for.
    served.interrupt();
    assert_eq!(served.wait(), Some(0));
}

#[test]
fn a_page_that_is_not_there_is_refused_by_name() {
    let told = refused(&["ui", "--no-open", "--page", "no/such.html"]);
    assert!(
        told.contains("no/such.html") && told.contains("--export"),
        "{told}"
    );
}

/// A browser that writes down what it is to open stands for the system's.
#[test]
#[cfg(target_os = "linux")]
fn a_browser_opens_the_address_that_is_printed() {
    let directory = tempfile::tempdir().unwrap();
    let browser = directory.path().join("xdg-open");
    let opened = directory.path().join("opened");
    let script = format!(
        "#!/bin/sh\nprintf '%s\\n' \"$@\" >> '{}'\n",
        opened.display()
    );
    fs::write(&browser, script).unwrap();
    fs::set_permissions(&browser, Permissions::from_mode(0o755)).unwrap();
    let path = format!("{}:{}", directory.path().display(), path());
    for more in [&[][..], &["--on", "sim"]] {
        fs::write(&opened, "").unwrap();
        let served = Served::open(&[&["--json"], more].concat(), &path);
        let begun = Instant::now();
        while fs::read_to_string(&opened).unwrap().is_empty() {
            assert!(begun.elapsed() < PATIENCE, "nothing was opened");
            sleep(Duration::from_millis(20));
        }
        let leg = if served.leg.is_empty() {
            String::new()
        } else {
            format!("#leg={}", served.leg)
        };
        let address = format!("{}/{leg}\n", served.origin());
        assert_eq!(fs::read_to_string(&opened).unwrap(), address);
    }
}
