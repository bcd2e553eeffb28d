//! What a node and its bus say to each other.

/// The rates of the bus, bit/s, and where its other nodes sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CanBus {
    /// Of arbitration.
    pub nominal_hz: u32,
    /// Of the data of frames that switch their rate.
    pub data_hz: u32,
    /// Where in a bit, of either rate, thousandths of it.
    pub sample_permille: u32,
}

/// How a transmission ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransmitOutcome {
    /// Some node acknowledged it, and none objected.
    Acknowledged,
    /// Nobody heard it.
    Unacknowledged,
    /// A node objected, or the wires are wrong.
    Disturbed,
}

/// What a node says to a frame of another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reception {
    /// It does not take part in the bus.
    Absent,
    /// It listens, and says nothing.
    Silent,
    /// It acknowledges.
    Acknowledged,
    /// It objects.
    Error,
}
