//! The error counters, after the rules of ISO 11898-1.

/// From here on a node warns, is passive, and is off the bus.
const WARNING: u32 = 96;
const PASSIVE: u32 = 128;
const OFF: u32 = 256;

/// What went wrong last: RM0440, FDCAN_PSR, LEC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// More than five equal bits, as when the rates differ.
    Stuff = 1,
    /// Nobody acknowledged.
    Acknowledge = 3,
    /// A recessive bit was sent, a dominant one read.
    Bit1 = 4,
}

/// Counts of errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Errors {
    /// Of transmission.
    pub transmit: u32,
    /// Of reception.
    pub receive: u32,
    /// Since the last read of ECR.
    pub logged: u32,
    /// Off the bus.
    pub off: bool,
}

impl Errors {
    /// A frame was sent.
    pub fn sent(&mut self) {
        self.transmit = self.transmit.saturating_sub(1);
    }

    /// A frame was received.
    pub fn received(&mut self) {
        self.receive = if self.receive >= PASSIVE {
            PASSIVE - 1
        } else {
            self.receive.saturating_sub(1)
        };
    }

    /// A transmission failed. A passive node does not count that nobody acknowledges: so a node that is alone on its
    /// bus becomes passive, and never goes off.
    pub fn transmission_failed(&mut self, kind: Kind) {
        if kind == Kind::Acknowledge && self.is_passive() {
            return;
        }
        self.transmit += 8;
        self.log();
        self.off |= self.transmit >= OFF;
    }

    /// A reception failed.
    pub fn reception_failed(&mut self) {
        self.receive = (self.receive + 1).min(PASSIVE);
        self.log();
    }

    fn log(&mut self) {
        self.logged = (self.logged + 1).min(0xff);
    }

    /// Whether a counter has reached the limit of warning.
    #[must_use]
    pub fn is_warning(&self) -> bool {
        self.transmit.max(self.receive) >= WARNING
    }

    /// Whether the node is error passive.
    #[must_use]
    pub fn is_passive(&self) -> bool {
        self.transmit.max(self.receive) >= PASSIVE
    }

    /// Whether the counter of reception says so.
    #[must_use]
    pub fn receives_passive(&self) -> bool {
        self.receive >= PASSIVE
    }
}
