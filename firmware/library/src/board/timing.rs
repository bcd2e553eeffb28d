//! The times of the STM32 board: what the timer, the converters and the tick take, in cycles of one clock.
//!
//! Timer, converters and processor run from the same clock, so the order within a tick is fixed:
//!
//! | from the update | what happens                                                                    |
//! |-----------------|---------------------------------------------------------------------------------|
//! | 0               | the timer takes over the pulse widths and starts the converters                 |
//! | 68 µs           | the last of 3 × 16 conversions is done: the control interrupt starts            |
//! | up to 103 µs    | it has to be done by then, [`TICK_BUDGET_CYCLES`] later                         |
//! | 125 µs          | the next update; the widths that the tick has set take effect                   |

use crate::sensors::TICK_HZ;

/// Clock of processor, timers and buses, Hz.
pub const CLOCK_HZ: u32 = 170_000_000;

/// Counts a second of the timer by which the tasks wait.
pub const TASK_TIMER_HZ: u32 = 1_000_000;

/// Cycles from a tick to the next.
pub const TICK_CYCLES: u32 = CLOCK_HZ / TICK_HZ as u32;

/// Periods of the pulse width modulation in a tick: 40 kHz, above what can be heard.
pub const PERIODS_PER_TICK: u32 = 5;

/// What the timer counts up to and down from in a period: the width that is always on.
pub const PWM_TOP: u16 = 2125;

/// The timer's repetition counter: an update comes after one more than this many half periods. It is odd, which puts
/// the update where the timer is at zero.
pub const REPETITIONS: u16 = 2 * PERIODS_PER_TICK as u16 - 1;

/// Clock of the converters by that of the processor.
pub const CONVERTER_DIVISOR: u32 = 4;

/// Conversions that are added up to one code.
pub const CONVERSIONS_PER_CODE: u32 = 16;

/// Codes that each converter takes in a tick, one after the other.
pub const CODES_PER_TICK: u32 = 3;

/// Half cycles of the converter's clock in one conversion: 47.5 of sampling and 12.5 of converting.
///
/// So 16 conversions span nine tenths of a period of the pulse width modulation, whose ripple they average out.
const CONVERSION_HALF_CYCLES: u32 = 95 + 25;

/// Cycles from an update to the end of the conversions.
pub const SENSING_CYCLES: u32 =
    CODES_PER_TICK * CONVERSIONS_PER_CODE * CONVERSION_HALF_CYCLES * CONVERTER_DIVISOR / 2;

/// Conversions that are added up to a code of supply, temperature and the chip's own voltage.
const SLOW_CONVERSIONS_PER_CODE: u32 = 8;

/// Half cycles of the converter's clock in a conversion of the chip's own voltage: 247.5 of sampling and 12.5 of converting.
const REFERENCE_HALF_CYCLES: u32 = 495 + 25;

/// Cycles from an update to the end of the conversions of supply, temperature and the chip's own voltage.
pub const SLOW_SENSING_CYCLES: u32 = SLOW_CONVERSIONS_PER_CODE
    * (2 * CONVERSION_HALF_CYCLES + REFERENCE_HALF_CYCLES)
    * CONVERTER_DIVISOR
    / 2;

/// The most that a tick may take in the control interrupt, cycles: 35 µs.
pub const TICK_BUDGET_CYCLES: u32 = 6_000;

/// The latest that the control interrupt may start, cycles after its time: 17 µs. What delays it is whoever switches
/// interrupts off.
pub const START_SLACK_CYCLES: u32 = 3_000;

const _: () = assert!(TICK_CYCLES == 2 * PWM_TOP as u32 * PERIODS_PER_TICK);
const _: () = assert!(CLOCK_HZ == TICK_CYCLES * TICK_HZ as u32);
const _: () = assert!(SLOW_SENSING_CYCLES < TICK_CYCLES);
const _: () = assert!(SENSING_CYCLES + START_SLACK_CYCLES + TICK_BUDGET_CYCLES < TICK_CYCLES);
