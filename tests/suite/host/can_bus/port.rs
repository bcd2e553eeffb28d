//! A node of the simulated bus as the host's port.

use super::bus::{NodeId, SimulatedBus};
use leg_firmware::can::CanFrame;
use leg_host::transport::can::CanPort;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::io;
use std::rc::Rc;
use std::time::Duration;

/// The host's place on a simulated bus. Time passes on the bus only while it waits for a frame.
#[derive(Clone)]
pub struct BusPort {
    bus: Rc<RefCell<SimulatedBus>>,
    node: NodeId,
    received: Rc<RefCell<VecDeque<CanFrame>>>,
}

impl BusPort {
    /// A new node on the bus; a clone is the same node, with the same received frames.
    pub fn attach(bus: &Rc<RefCell<SimulatedBus>>) -> Self {
        let received = Rc::new(RefCell::new(VecDeque::new()));
        let inbox = Rc::clone(&received);
        let node = bus.borrow_mut().attach(Box::new(move |frame| {
            inbox.borrow_mut().push_back(*frame);
            Vec::new()
        }));
        Self {
            bus: Rc::clone(bus),
            node,
            received,
        }
    }
}

impl CanPort for BusPort {
    fn name(&self) -> &str {
        "simulated bus"
    }

    fn send(&mut self, frame: &CanFrame) -> io::Result<()> {
        self.bus.borrow_mut().send(self.node, *frame);
        Ok(())
    }

    /// The timeout is the bus's time; it is over at once where nobody has anything to send.
    fn receive(&mut self, timeout: Duration) -> io::Result<CanFrame> {
        let deadline = self.bus.borrow().elapsed().saturating_add(timeout);
        loop {
            if let Some(frame) = self.received.borrow_mut().pop_front() {
                return Ok(frame);
            }
            let mut bus = self.bus.borrow_mut();
            if bus.elapsed() >= deadline || bus.step().is_none() {
                return Err(io::ErrorKind::TimedOut.into());
            }
        }
    }
}
