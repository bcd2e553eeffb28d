//! Why the chip started, from the flags of its reset controller.

use super::Kept;
use crate::host_link::Reset;

// Bits of the STM32G4's RCC_CSR. The pin's is set by every reset, for the chip pulls its own pin.
const OPTION_BYTES: u32 = 1 << 25;
const PIN: u32 = 1 << 26;
const BROWN_OUT: u32 = 1 << 27;
const SOFTWARE: u32 = 1 << 28;
const INDEPENDENT_WATCHDOG: u32 = 1 << 29;
const WINDOW_WATCHDOG: u32 = 1 << 30;
const LOW_POWER: u32 = 1 << 31;

/// Why the chip started: `flags` are RCC_CSR of an STM32G4, and `kept` is what its RAM still holds of what the firmware
/// left there.
///
/// The chip has one flag for the power that comes and for the power that was too low for a while; only in the second
/// case can the RAM have kept its contents, and it need not. A debugger resets the chip as the firmware itself does, but
/// leaves no words.
#[must_use]
pub fn reset_cause(flags: u32, kept: Option<&Kept>) -> Reset {
    let has = |bits: u32| flags & bits != 0;
    let spoke = kept.is_some_and(|kept| !kept.words.is_empty());
    if has(INDEPENDENT_WATCHDOG | WINDOW_WATCHDOG) {
        Reset::Watchdog
    } else if has(BROWN_OUT) && kept.is_some() {
        Reset::BrownOut
    } else if has(BROWN_OUT) {
        Reset::Power
    } else if has(SOFTWARE) && spoke {
        Reset::Software
    } else if has(OPTION_BYTES | LOW_POWER) {
        Reset::Other
    } else if has(PIN | SOFTWARE) {
        Reset::Pin
    } else {
        Reset::Other
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn silent() -> Kept {
        Kept {
            words: heapless::String::new(),
            failures: 0,
        }
    }

    #[test]
    fn each_flag_has_its_cause() {
        for (flags, cause) in [
            (PIN, Reset::Pin),
            (PIN | SOFTWARE, Reset::Pin),
            (PIN | INDEPENDENT_WATCHDOG, Reset::Watchdog),
            (PIN | WINDOW_WATCHDOG, Reset::Watchdog),
            (PIN | OPTION_BYTES, Reset::Other),
            (PIN | LOW_POWER, Reset::Other),
            (0, Reset::Other),
        ] {
            assert_eq!(reset_cause(flags, Some(&silent())), cause, "{flags:#x}");
            assert_eq!(reset_cause(flags, None), cause, "{flags:#x}");
        }
    }

    #[test]
    fn the_firmware_stopped_by_itself_where_it_left_words() {
        let mut kept = silent();
        assert!(kept.words.push_str("start.rs:7").is_ok());
        assert_eq!(reset_cause(PIN | SOFTWARE, Some(&kept)), Reset::Software);
    }

    #[test]
    fn a_dip_of_the_supply_is_told_by_what_the_ram_kept() {
        assert_eq!(reset_cause(PIN | BROWN_OUT, None), Reset::Power);
        let kept = silent();
        assert_eq!(reset_cause(PIN | BROWN_OUT, Some(&kept)), Reset::BrownOut);
    }

    #[test]
    fn a_watchdog_goes_before_what_came_with_it() {
        let all = PIN | SOFTWARE | BROWN_OUT | INDEPENDENT_WATCHDOG;
        assert_eq!(reset_cause(all, Some(&silent())), Reset::Watchdog);
    }
}
