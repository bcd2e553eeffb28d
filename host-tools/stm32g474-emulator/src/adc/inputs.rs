//! What the board gives the inputs, and how long an input has to be sampled.

/// Resistance of a source at an input, ohms, where nobody says another: `firmware/BOARD.md` asks for amplifiers and
/// current outputs, and gives no resistance. 1 kΩ holds for each of them with a series resistor.
pub const SOURCE_OHMS: u32 = 1_000;

/// The shortest sampling time by the resistance of the source, for 12 bits: ohms, nanoseconds. From the datasheet's table
/// of `RAIN` at 60 MHz, slow channels: 6.5, 12.5, 24.5, 47.5, 92.5, 247.5 and 640.5 periods. By memory of the datasheet.
const SAMPLING: [(u32, u64); 7] = [
    (100, 108),
    (470, 208),
    (1_200, 408),
    (1_800, 792),
    (3_900, 1_542),
    (10_000, 4_125),
    (33_000, 10_675),
];

/// Conversions that the board's sum is made of.
const SIXTEEN: u32 = 16;

/// What so many conversions of an input add up to where sixteen of 12 bits add up to a sum, each without its lowest bits.
#[must_use]
pub fn sum_of(sum16: u16, conversions: u32, bits_dropped: u32) -> u32 {
    let conversion = |count| ((u32::from(sum16) + count % SIXTEEN) / SIXTEEN) >> bits_dropped;
    (0..conversions).map(conversion).sum()
}

/// What the board gives the inputs of the converters.
pub trait AnalogueInputs {
    /// The sum of 16 conversions of an input, 0 to 65 520; none where its pin is not in analogue mode or is not connected.
    fn sum16(&self, converter: &str, input: u8) -> Option<u16>;

    /// Whether an input is the chip's own voltage, which has to be switched on.
    fn is_reference(&self, _converter: &str, _input: u8) -> bool {
        false
    }

    /// The resistance of what drives an input, ohms.
    fn source_ohms(&self, _converter: &str, _input: u8) -> u32 {
        SOURCE_OHMS
    }
}

/// The shortest time for which a source of a resistance has to be sampled, nanoseconds; none where no time is enough.
#[must_use]
pub fn shortest_sampling(ohms: u32) -> Option<u64> {
    let mut known = SAMPLING.iter();
    let found = known.find(|(limit, _)| ohms <= *limit);
    found.map(|(_, nanoseconds)| *nanoseconds)
}
