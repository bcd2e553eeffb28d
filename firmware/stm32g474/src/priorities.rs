//! Who may interrupt whom.

use embassy_stm32::interrupt::{self, InterruptExt, Priority};

/// The control interrupt's: nothing else has it.
pub const CONTROL: Priority = Priority::P0;

/// Puts the control interrupt above everything else; to be called before any is unmasked, as until then no critical section
/// holds the others off.
///
/// After a reset all have the highest priority. The tasks run below all interrupts.
pub fn set() {
    interrupt::ADC1_2.set_priority(CONTROL);
    // The clock of the tasks, which shares its vector with a break that is not used as an interrupt.
    interrupt::TIM1_BRK_TIM15.set_priority(Priority::P4);
    interrupt::LPUART1.set_priority(Priority::P5);
    interrupt::FDCAN2_IT0.set_priority(Priority::P5);
    interrupt::FDCAN2_IT1.set_priority(Priority::P5);
    interrupt::FLASH.set_priority(Priority::P6);
}
