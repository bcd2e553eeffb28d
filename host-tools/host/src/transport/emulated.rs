//! An emulated leg at the other end, in lock-step with its hosts: its time goes on only while one of them waits.

use super::Transport;
use leg_sim::emulated_leg::EmulatedLeg;
use leg_sim::plant::Plant;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::io;
use std::rc::{Rc, Weak};
use std::time::Duration;

/// An emulated leg and the line to it, which any number of hosts share, as do its clones.
#[derive(Clone)]
pub struct EmulatedLine {
    shared: Rc<RefCell<Shared>>,
    name: String,
}

/// One host's end of that line.
pub struct EmulatedTransport {
    line: EmulatedLine,
    incoming: Incoming,
}

/// What of the leg's bytes one host has not read yet.
type Incoming = Rc<RefCell<VecDeque<u8>>>;

/// The leg and what is on its way to it and to each host.
struct Shared {
    leg: EmulatedLeg,
    outgoing: VecDeque<u8>,
    /// None of a host that has gone.
    hosts: Vec<Weak<RefCell<VecDeque<u8>>>>,
}

impl Shared {
    fn tick(&mut self) -> io::Result<()> {
        let bytes = self.leg.tick(&mut self.outgoing);
        let bytes: Vec<u8> = bytes.map_err(io::Error::other)?.collect();
        self.hosts.retain(|host| {
            let Some(incoming) = host.upgrade() else {
                return false;
            };
            incoming.borrow_mut().extend(&bytes);
            true
        });
        Ok(())
    }
}

impl EmulatedLine {
    /// A leg without a host yet; `name` is for messages.
    pub fn new(leg: EmulatedLeg, name: &str) -> Self {
        Self {
            shared: Rc::new(RefCell::new(Shared {
                leg,
                outgoing: VecDeque::new(),
                hosts: Vec::new(),
            })),
            name: name.into(),
        }
    }

    /// Connects another host: what the leg sends reaches all of them.
    pub fn connect(&self) -> EmulatedTransport {
        let incoming = Incoming::default();
        let host = Rc::downgrade(&incoming);
        self.shared.borrow_mut().hosts.push(host);
        let line = self.clone();
        EmulatedTransport { line, incoming }
    }

    /// Reads or changes the mechanism itself, as a hand or a measuring instrument does.
    pub fn with_plant<T>(&self, work: impl FnOnce(&mut Plant) -> T) -> T {
        work(self.shared.borrow_mut().leg.plant_mut())
    }
}

impl Transport for EmulatedTransport {
    fn name(&self) -> &str {
        &self.line.name
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.line.shared.borrow_mut().outgoing.extend(bytes);
        Ok(())
    }

    fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize> {
        let until = self.now() + timeout;
        loop {
            let count = io::Read::read(&mut *self.incoming.borrow_mut(), bytes)?;
            if count > 0 || bytes.is_empty() {
                return Ok(count);
            }
            if self.now() >= until {
                return Err(io::ErrorKind::TimedOut.into());
            }
            self.line.shared.borrow_mut().tick()?;
        }
    }

    fn now(&self) -> Duration {
        self.line.shared.borrow().leg.time()
    }

    fn clock_is_emulated(&self) -> bool {
        true
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{EmulatedLine, Transport};
    use leg_rig::rig_file::RigFile;
    use leg_sim::emulated_leg::{EmulatedLeg, InitialState};
    use leg_sim::link::InProcess;
    use std::time::Duration;

    #[test]
    fn nothing_is_kept_for_a_host_that_has_gone() {
        let rig = RigFile::load(None).unwrap();
        let link = Box::new(InProcess::new());
        let leg = EmulatedLeg::new(&rig, InitialState::Homed, link).unwrap();
        let line = EmulatedLine::new(leg, "a leg");
        drop(line.connect());
        let mut host = line.connect();
        host.receive(&mut [0], Duration::from_millis(1))
            .unwrap_err();
        assert_eq!(line.shared.borrow().hosts.len(), 1);
    }
}
