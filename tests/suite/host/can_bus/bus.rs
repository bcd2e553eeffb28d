//! A simulated CAN FD bus: arbitration by identifier, the time that frames take, and damage by chance.
//!
//! A real bus repeats what a receiver finds damaged; what this one does to a frame is what still gets through: a full
//! receive buffer, a repetition after all had accepted the frame, a flipped bit that no CRC of CAN noticed. So its
//! chances of it are for tests and far from a real bus's.

use fastrand::Rng;
use leg_firmware::can::{CanFrame, DATA_BIT_RATE, NOMINAL_BIT_RATE};
use std::time::Duration;

/// Bits of a frame at the nominal rate: from the start to the switch of the rate, and from the CRC's end to the next
/// frame.
const NOMINAL_BITS: u32 = 30;

/// Bits at the data rate beside the payload: length, stuff count and CRC.
const DATA_BITS: u32 = 37;

/// What happens to a frame, as a chance of 0 to 1 at each receiver.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Damage {
    /// It does not arrive.
    pub lost: f64,
    /// It arrives twice.
    pub doubled: f64,
    /// One of its bytes is another.
    pub corrupted: f64,
}

/// A node on the bus, by the order of [`SimulatedBus::attach`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeId(usize);

/// What a node does with a frame that it receives: the frames that it sends upon it.
pub type OnFrame = Box<dyn FnMut(&CanFrame) -> Vec<CanFrame>>;

struct BusNode {
    /// Handed to the controller and not sent yet.
    outgoing: Vec<CanFrame>,
    on_frame: OnFrame,
}

/// A bus and its nodes.
pub struct SimulatedBus {
    nodes: Vec<BusNode>,
    damage: Damage,
    chance: Rng,
    elapsed: Duration,
}

impl SimulatedBus {
    /// A bus without nodes; the same seed does the same damage.
    pub fn new(damage: Damage, seed: u64) -> Self {
        Self {
            nodes: Vec::new(),
            damage,
            chance: Rng::with_seed(seed),
            elapsed: Duration::ZERO,
        }
    }

    /// Adds a node.
    pub fn attach(&mut self, on_frame: OnFrame) -> NodeId {
        self.nodes.push(BusNode {
            outgoing: Vec::new(),
            on_frame,
        });
        NodeId(self.nodes.len() - 1)
    }

    /// Changes what happens to frames from now on.
    pub fn set_damage(&mut self, damage: Damage) {
        self.damage = damage;
    }

    /// Hands a frame to a node's controller, which sends the lowest identifier first, and in the order of this call
    /// within one.
    pub fn send(&mut self, from: NodeId, frame: CanFrame) {
        if let Some(node) = self.nodes.get_mut(from.0) {
            node.outgoing.push(frame);
        }
    }

    /// How long the bus has been busy.
    pub const fn elapsed(&self) -> Duration {
        self.elapsed
    }

    /// Carries the frame that wins the bus to all other nodes, and returns it; `None` if nobody has one.
    pub fn step(&mut self) -> Option<CanFrame> {
        let (from, frame) = self.arbitrate()?;
        self.elapsed += duration(&frame);
        for to in (0..self.nodes.len()).filter(|&to| to != from) {
            for arrived in self.damaged(frame) {
                self.deliver(to, &arrived);
            }
        }
        Some(frame)
    }

    /// Takes the lowest identifier's first frame from its node.
    fn arbitrate(&mut self) -> Option<(usize, CanFrame)> {
        let waiting = self.nodes.iter().enumerate().flat_map(|(from, node)| {
            let frames = node.outgoing.iter().enumerate();
            frames.map(move |(place, frame)| (frame.identifier().bits(), from, place))
        });
        let (_, from, place) = waiting.min()?;
        let frame = self.nodes.get_mut(from)?.outgoing.remove(place);
        Some((from, frame))
    }

    fn deliver(&mut self, to: usize, frame: &CanFrame) {
        if let Some(node) = self.nodes.get_mut(to) {
            let answer = (node.on_frame)(frame);
            node.outgoing.extend(answer);
        }
    }

    /// What of a frame arrives at one receiver.
    fn damaged(&mut self, frame: CanFrame) -> impl Iterator<Item = CanFrame> + use<> {
        let mut happens = |chance: f64| self.chance.f64() < chance;
        let (lost, doubled) = (happens(self.damage.lost), happens(self.damage.doubled));
        let corrupted = happens(self.damage.corrupted);
        let times = if lost { 0 } else { 1 + usize::from(doubled) };
        let arrived = if corrupted {
            self.corrupt(frame)
        } else {
            frame
        };
        std::iter::repeat_n(arrived, times)
    }

    fn corrupt(&mut self, frame: CanFrame) -> CanFrame {
        let mut payload = frame.payload().to_vec();
        if let Some(place) = self.chance.choice(payload.iter_mut()) {
            *place ^= self.chance.u8(1..);
        }
        CanFrame::new(frame.identifier(), &payload).unwrap_or(frame)
    }
}

/// How long a frame keeps the bus busy, without the stuff bits that its payload needs.
pub fn duration(frame: &CanFrame) -> Duration {
    let bytes = frame.payload().len() as f64;
    let data_bits = f64::from(DATA_BITS) + 8.0 * bytes;
    let seconds = f64::from(NOMINAL_BITS) / f64::from(NOMINAL_BIT_RATE)
        + data_bits / f64::from(DATA_BIT_RATE);
    Duration::from_secs_f64(seconds)
}
