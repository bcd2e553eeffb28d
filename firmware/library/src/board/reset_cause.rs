//! Why the chip started, from the flags of its reset controller.

use super::CrashReport;
use crate::host_link::ResetCause;

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
/// leaves no report.
#[must_use]
pub fn reset_cause(flags: u32, kept: Option<&CrashReport>) -> ResetCause {
    let has = |bits: u32| flags & bits != 0;
    let reported = kept.is_some_and(|kept| !kept.text.is_empty());
    if has(WINDOW_WATCHDOG) {
        ResetCause::HungTick
    } else if has(INDEPENDENT_WATCHDOG) {
        ResetCause::Watchdog
    } else if has(BROWN_OUT) && kept.is_some() {
        ResetCause::BrownOut
    } else if has(BROWN_OUT) {
        ResetCause::Power
    } else if has(SOFTWARE) && reported {
        ResetCause::Software
    } else if has(OPTION_BYTES | LOW_POWER) {
        ResetCause::Other
    } else if has(PIN | SOFTWARE) {
        ResetCause::Pin
    } else {
        ResetCause::Other
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn silent() -> CrashReport {
        CrashReport {
            text: heapless::String::new(),
            failures: 0,
        }
    }

    #[test]
    fn each_flag_has_its_cause() {
        for (flags, cause) in [
            (PIN, ResetCause::Pin),
            (PIN | SOFTWARE, ResetCause::Pin),
            (PIN | INDEPENDENT_WATCHDOG, ResetCause::Watchdog),
            (PIN | WINDOW_WATCHDOG, ResetCause::HungTick),
            (PIN | OPTION_BYTES, ResetCause::Other),
            (PIN | LOW_POWER, ResetCause::Other),
            (0, ResetCause::Other),
        ] {
            assert_eq!(reset_cause(flags, Some(&silent())), cause, "{flags:#x}");
            assert_eq!(reset_cause(flags, None), cause, "{flags:#x}");
        }
    }

    #[test]
    fn the_firmware_stopped_by_itself_where_it_left_a_report() {
        let mut kept = silent();
        assert!(kept.text.push_str("start.rs:7").is_ok());
        assert_eq!(
            reset_cause(PIN | SOFTWARE, Some(&kept)),
            ResetCause::Software
        );
    }

    #[test]
    fn a_dip_of_the_supply_is_known_by_what_the_ram_kept() {
        assert_eq!(reset_cause(PIN | BROWN_OUT, None), ResetCause::Power);
        let kept = silent();
        assert_eq!(
            reset_cause(PIN | BROWN_OUT, Some(&kept)),
            ResetCause::BrownOut
        );
    }

    #[test]
    fn a_watchdog_goes_before_what_came_with_it() {
        let all = PIN | SOFTWARE | BROWN_OUT | INDEPENDENT_WATCHDOG;
        assert_eq!(reset_cause(all, Some(&silent())), ResetCause::Watchdog);
        let both = all | WINDOW_WATCHDOG;
        assert_eq!(reset_cause(both, Some(&silent())), ResetCause::HungTick);
    }
}
