//! One number for all that the firmware decided in a run: equal numbers are equal bits.

use super::Tick;

/// FNV-1a over what each tick asks of the motors, and where it takes the leg to be and to be led.
#[derive(Clone, Copy, Debug)]
pub struct TickHash(u64);

impl Default for TickHash {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl TickHash {
    /// Takes a tick.
    pub fn take(&mut self, tick: &Tick<'_>) {
        self.add(u32::from(tick.drive.enabled));
        let told = tick.telemetry;
        let numbers = tick.drive.duty.iter().chain(&told.reference_m);
        for number in numbers.chain(&told.pose).chain(&told.unstretched_at_zero_m) {
            self.add(number.to_bits());
        }
    }

    /// The number.
    #[must_use]
    pub const fn value(self) -> u64 {
        self.0
    }

    fn add(&mut self, bits: u32) {
        for byte in bits.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}
