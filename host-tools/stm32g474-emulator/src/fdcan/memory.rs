//! The message RAM: 212 words that registers and processor share.
//!
//! What the bits of an element mean is taken from embassy-stm32's `can/fd/message_ram`; ST's own driver
//! (stm32g4xx_hal_fdcan.c) has the same masks.

use super::frame::{DataFrame, length};

/// Words in an element of a receive FIFO and of a transmit buffer: two of head, 16 of data.
pub const ELEMENT: usize = 18;

/// Words in an element of the FIFO of transmit events.
pub const EVENT: usize = 2;

const STANDARD_SHIFT: u32 = 18;
const REMOTE: u32 = 1 << 29;
const EXTENDED: u32 = 1 << 30;
const LENGTH_SHIFT: u32 = 16;
const SWITCH: u32 = 1 << 20;
const FD: u32 = 1 << 21;
const STORE_EVENT: u32 = 1 << 23;
const FILTER_SHIFT: u32 = 24;
const NO_FILTER: u32 = 1 << 31;

/// What a transmit buffer asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Buffer {
    /// 11 bits.
    pub identifier: u16,
    /// An extended identifier, or a frame without data that asks for some: neither is on this bus.
    pub unknown: bool,
    pub fd: bool,
    pub switch: bool,
    pub store_event: bool,
    pub payload: Vec<u8>,
    /// Its first two words.
    pub head: [u32; 2],
}

/// What a standard filter does with an identifier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FilterAction {
    /// 0 or 1; none where the frame is rejected.
    pub fifo: Option<usize>,
    /// A message of high priority.
    pub priority: bool,
}

/// A transmit buffer in the words from its first on.
pub fn buffer(words: &[u32]) -> Buffer {
    let word = |index: usize| words.get(index).copied().unwrap_or_default();
    let head = [word(0), word(1)];
    let fd = head[1] & FD != 0;
    let length = length(head[1] >> LENGTH_SHIFT & 0xf, fd);
    let data = (2..ELEMENT).flat_map(|index| word(index).to_le_bytes());
    Buffer {
        identifier: (head[0] >> STANDARD_SHIFT & 0x7ff) as u16,
        unknown: head[0] & (EXTENDED | REMOTE) != 0,
        fd,
        switch: head[1] & SWITCH != 0,
        store_event: head[1] & STORE_EVENT != 0,
        payload: data.take(length).collect(),
        head,
    }
}

/// The element of a receive FIFO for a frame; `filter` is the number of the filter that let it in.
pub fn received(frame: &DataFrame, stamp: u16, filter: Option<usize>) -> Vec<u32> {
    let flag = |is_set, bit| if is_set { bit } else { 0 };
    let by = filter.map_or(NO_FILTER, |number| (number as u32) << FILTER_SHIFT);
    let second = u32::from(stamp)
        | frame.length_code() << LENGTH_SHIFT
        | flag(frame.bit_rate_switch, SWITCH)
        | flag(frame.fd, FD)
        | by;
    let mut words = vec![u32::from(frame.identifier) << STANDARD_SHIFT, second];
    words.extend(frame.payload.chunks(4).map(|bytes| {
        let bytes = bytes.iter().rev();
        bytes.fold(0, |word, byte| word << 8 | u32::from(*byte))
    }));
    words
}

/// What a standard filter's word does with an identifier; none where it does not match.
pub fn filter(word: u32, identifier: u16) -> Option<FilterAction> {
    let identifier = u32::from(identifier);
    let first = word >> 16 & 0x7ff;
    let second = word & 0x7ff;
    let matches = match word >> 30 {
        0 => (first..=second).contains(&identifier),
        1 => identifier == first || identifier == second,
        2 => identifier & second == first & second,
        _ => false,
    };
    let kind = word >> 27 & 7;
    let fifo = match kind {
        1 | 5 => Some(0),
        2 | 6 => Some(1),
        _ => None,
    };
    let action = FilterAction {
        fifo,
        priority: (4..=6).contains(&kind),
    };
    (matches && (1..=6).contains(&kind)).then_some(action)
}
