//! Characters on the wires, and what a receiver makes of them.

/// How far the rates of the two ends may be apart, percent.
///
/// RM0440, "Tolerance of the LPUART receiver to clock deviation": 1.82 % for BRR below 1024, to 4.42 % from 4096 on,
/// for 8 bits and one stop bit, and all errors of both ends and the line together. By memory of the manual.
const TOLERANCE_PERCENT: f64 = 2.0;

/// Start, eight bits of data, stop: what the host sends and receives.
pub const CHARACTER_BITS: u64 = 10;

/// Whether a receiver understands a sender, by the duration of their bits.
pub fn understood(sender_bit: f64, receiver_bit: f64) -> bool {
    ((sender_bit / receiver_bit - 1.0) * 100.0).abs() <= TOLERANCE_PERCENT
}

/// A byte as a receiver samples it in the middle of its own bits, and whether its stop bit is there.
pub fn sampled(byte: u8, sender_bit: f64, receiver_bit: f64) -> (u8, bool) {
    let level = |bit: u32| {
        let at = (f64::from(bit) + 0.5) * receiver_bit / sender_bit;
        match at as u64 {
            0 => false,
            place @ 1..=8 => byte >> (place - 1) & 1 == 1,
            _ => true,
        }
    };
    let value = (0..8).fold(0, |value, bit| value | u8::from(level(bit + 1)) << bit);
    (value, level(9))
}
