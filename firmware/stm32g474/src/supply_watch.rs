//! The chip's own supply: what ends the pulses before the chip can no longer be trusted.

use embassy_stm32::pac;

/// PWR_CR2.PLS: about 2.9 V, the highest level that there is.
const DETECTOR_LEVEL: u8 = 6;

/// Lets the chip watch its supply: below 2.9 V TIM1's system break ends the pulses ([`crate::power`] connects it).
///
/// The brown-out reset, which the option bytes set, has to come before the chip leaves its range.
pub fn start() {
    pac::PWR.cr2().modify(|w| {
        w.set_pls(DETECTOR_LEVEL);
        w.set_pvde(true);
    });
    if pac::FLASH.optr().read().bor_lev() == 0 {
        defmt::warn!(
            "brown-out level 0 lets the chip run below its range: set the option byte BOR_LEV to 4"
        );
    }
}
