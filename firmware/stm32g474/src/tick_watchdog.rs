//! The window watchdog, which resets the chip unless the control tick refreshes it; a reset lets every pin float, and the
//! pull-downs then take pulses and enable away.
//!
//! The control interrupt has the highest priority and masks the others: if it hangs, no program is left that could end
//! the pulses. The last duties stand for 1.6 ms at most. The window stays open: a late tick may be followed by one in time.
//! No early warning is used, for nothing would run that could hear it.

use embassy_stm32::pac;
use embassy_stm32::pac::wwdg::regs::Cr;
use leg_firmware::board::timing::{CLOCK_HZ, TICK_CYCLES};

/// Active, and the counter at its highest.
const REFRESH: u32 = 0x80 | 0x7f;

/// Cycles from a refresh to the reset at most: 64 steps, from 127 to below 64, of 4096 cycles of APB1. The divider runs on over
/// a refresh: it may be a step less.
pub const TIMEOUT_CYCLES: u32 = 64 * 4_096;
const _: () = assert!(TIMEOUT_CYCLES < CLOCK_HZ / 1_000 * 2);
const _: () = assert!(TIMEOUT_CYCLES > 8 * TICK_CYCLES);

/// Starts it; nothing but a reset stops it. Ticks have to follow.
pub fn start() {
    pac::RCC.apb1enr1().modify(|w| w.set_wwdgen(true));
    // A read lets the clock begin before the first access.
    let _ = pac::RCC.apb1enr1().read();
    refresh();
}

/// The duties of this tick are written.
#[inline(always)]
pub fn refresh() {
    pac::WWDG.cr().write_value(Cr(REFRESH));
}

/// For who has switched the outputs off and still has something to say.
pub fn refresh_if_started() {
    if pac::RCC.apb1enr1().read().wwdgen() {
        refresh();
    }
}

/// Whether it stands still while a debugger halts the processor: only while nothing is driven. A halt of a leg that is driven
/// ends in a reset, and so takes the drivers' enable line away, too. A debugger may set it at any time.
#[inline(always)]
pub fn set_rest_in_halt(rests: bool) {
    pac::DBGMCU.apb1lfzr().modify(|w| w.set_wwdg(rests));
}
