//! An emulated leg at the other end, in lock-step with the host: its time goes on only while the host waits.

use super::Transport;
use crate::emulated_leg::EmulatedLeg;
use crate::plant::Plant;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::io;
use std::rc::Rc;
use std::time::Duration;

/// One host's end of the line to an emulated leg.
pub struct Emulated {
    shared: Rc<RefCell<Shared>>,
    /// Which of the hosts this is.
    place: usize,
    name: String,
}

/// The leg and what is on its way to it and to each host.
struct Shared {
    leg: EmulatedLeg,
    outgoing: VecDeque<u8>,
    incoming: Vec<VecDeque<u8>>,
}

impl Shared {
    fn tick(&mut self) -> io::Result<()> {
        let bytes = self.leg.tick(&mut self.outgoing);
        for byte in bytes.map_err(io::Error::other)? {
            for host in &mut self.incoming {
                host.push_back(byte);
            }
        }
        Ok(())
    }
}

impl Emulated {
    /// The first host of a leg.
    #[must_use]
    pub fn new(leg: EmulatedLeg, name: &str) -> Self {
        Self {
            shared: Rc::new(RefCell::new(Shared {
                leg,
                outgoing: VecDeque::new(),
                incoming: vec![VecDeque::new()],
            })),
            place: 0,
            name: name.into(),
        }
    }

    /// Another host on the same line: what the leg says reaches all of them.
    #[must_use]
    pub fn beside(&self) -> Self {
        let place = {
            let incoming = &mut self.shared.borrow_mut().incoming;
            incoming.push(VecDeque::new());
            incoming.len() - 1
        };
        Self {
            shared: Rc::clone(&self.shared),
            place,
            name: self.name.clone(),
        }
    }

    /// Does something to the leg from outside.
    pub fn touch<T>(&self, what: impl FnOnce(&mut Plant) -> T) -> T {
        what(self.shared.borrow_mut().leg.plant())
    }

    /// What of the leg's bytes has come.
    fn take(&self, bytes: &mut [u8]) -> usize {
        let mut shared = self.shared.borrow_mut();
        let Some(incoming) = shared.incoming.get_mut(self.place) else {
            return 0;
        };
        let count = incoming.len().min(bytes.len());
        for (place, byte) in bytes.iter_mut().zip(incoming.drain(..count)) {
            *place = byte;
        }
        count
    }
}

impl Transport for Emulated {
    fn name(&self) -> &str {
        &self.name
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.shared.borrow_mut().outgoing.extend(bytes);
        Ok(())
    }

    fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize> {
        let until = self.now() + timeout;
        loop {
            let count = self.take(bytes);
            if count > 0 || bytes.is_empty() {
                return Ok(count);
            }
            if self.now() >= until {
                return Err(io::ErrorKind::TimedOut.into());
            }
            self.shared.borrow_mut().tick()?;
        }
    }

    fn now(&self) -> Duration {
        self.shared.borrow().leg.time()
    }

    fn clock_is_emulated(&self) -> bool {
        true
    }
}
