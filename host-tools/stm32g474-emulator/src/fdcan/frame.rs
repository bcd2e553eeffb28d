//! A frame on the bus, and how long it takes.

/// Numbers of bytes that a frame can carry, by its length code (DLC).
const LENGTHS: [usize; 16] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64];

/// Equal bits after which one is stuffed.
const EQUAL_BITS: u32 = 5;

/// Acknowledge, its delimiter, end of frame, and the pause before the next frame.
const TAIL_BITS: u64 = 1 + 1 + 7 + 3;

/// A data frame with a standard identifier.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DataFrame {
    /// 11 bits.
    pub identifier: u16,
    /// CAN FD; else classic.
    pub fd: bool,
    /// The data are sent at the rate for data.
    pub bit_rate_switch: bool,
    /// As many bytes as a length code can say.
    pub payload: Vec<u8>,
    /// Rate of arbitration, bit/s.
    pub nominal_hz: u32,
    /// Rate of the data, bit/s.
    pub data_hz: u32,
}

/// The number of bytes of a length code.
pub fn length(code: u32, fd: bool) -> usize {
    let length = LENGTHS.get(code as usize).copied().unwrap_or_default();
    if fd { length } else { length.min(8) }
}

/// Bits that are stuffed into a row of bits, counted in the order in which they are sent.
struct Row {
    last: bool,
    equal: u32,
    /// Bits up to now, in the nominal and in the data phase, with the stuffed ones.
    counts: [u64; 2],
    phase: usize,
    crc: u32,
}

impl Row {
    fn push(&mut self, bit: bool) {
        // The polynomial of classic CAN's CRC, ISO 11898-1.
        let carry = (self.crc >> 14 & 1 == 1) != bit;
        self.crc = self.crc << 1 & 0x7fff ^ if carry { 0x4599 } else { 0 };
        self.stuff(bit);
    }

    fn stuff(&mut self, bit: bool) {
        self.count(1);
        self.equal = if bit == self.last { self.equal + 1 } else { 1 };
        self.last = bit;
        if self.equal == EQUAL_BITS {
            self.count(1);
            self.last = !bit;
            self.equal = 1;
        }
    }

    fn count(&mut self, bits: u64) {
        if let Some(count) = self.counts.get_mut(self.phase) {
            *count += bits;
        }
    }

    fn field(&mut self, value: u32, bits: u32) {
        for bit in (0..bits).rev() {
            self.push(value >> bit & 1 == 1);
        }
    }
}

impl DataFrame {
    /// The length code: the smallest that holds the payload.
    #[must_use]
    pub fn length_code(&self) -> u32 {
        let fits = LENGTHS.iter().position(|l| *l >= self.payload.len());
        fits.map_or(15, |code| code as u32)
    }

    /// Its bits in the nominal and in the data phase, with those that are stuffed, and the pause after it.
    ///
    /// The lengths of its fields are those of ISO 11898-1.
    #[must_use]
    pub fn bits(&self) -> [u64; 2] {
        let mut row = Row {
            last: true,
            equal: 0,
            counts: [0; 2],
            phase: 0,
            crc: 0,
        };
        row.field(0, 1);
        row.field(u32::from(self.identifier), 11);
        if self.fd {
            // RRS, IDE, FDF, a reserved bit, BRS; then at the other rate ESI.
            let head = [false, false, true, false, self.bit_rate_switch];
            head.into_iter().for_each(|bit| row.push(bit));
            row.phase = usize::from(self.bit_rate_switch);
            row.push(false);
        } else {
            // RTR, IDE, a reserved bit.
            row.field(0, 3);
        }
        row.field(self.length_code(), 4);
        let padding = std::iter::repeat(&0);
        let length = length(self.length_code(), self.fd);
        for byte in self.payload.iter().chain(padding).take(length) {
            row.field(u32::from(*byte), 8);
        }
        if self.fd {
            // Count of stuffed bits, CRC, a fixed bit before them and after each four of theirs, and the delimiter.
            let check = if self.payload.len() <= 16 {
                4 + 17 + 6
            } else {
                4 + 21 + 7
            };
            row.count(check + 1);
        } else {
            let crc = row.crc;
            (0..15).rev().for_each(|bit| row.stuff(crc >> bit & 1 == 1));
            row.count(1);
        }
        row.phase = 0;
        row.count(TAIL_BITS);
        row.counts
    }

    /// How long it keeps the bus busy, ns, at its rates.
    #[must_use]
    pub fn duration_ns(&self) -> u64 {
        let [nominal, data] = self.bits();
        let time = |bits: u64, hz: u32| (bits * 1_000_000_000).checked_div(hz.into()).unwrap_or(0);
        time(nominal, self.nominal_hz) + time(data, self.data_hz)
    }
}
