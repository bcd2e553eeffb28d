//! The interrupts of the mps2-an386 that the firmware uses.
#![allow(
    unsafe_code,
    reason = "a vector table is raw function pointers at a fixed place"
)]

use cortex_m::interrupt::InterruptNumber;

/// Priority of the clock: above everything that waits for it.
const CLOCK_PRIORITY: u8 = 0x20;

/// Priority of the task that answers the host: the lowest.
const LINK_PRIORITY: u8 = 0xe0;

/// An interrupt by its number at the NVIC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u16)]
pub enum Interrupt {
    /// The free-running timer wrapped.
    Timer0 = 8,
    /// The alarm is due.
    Timer1 = 9,
    /// No device raises it: the link's executor pends it by software.
    Link = 31,
}

// SAFETY: each number is the interrupt's own and has an entry in the vector table below.
unsafe impl InterruptNumber for Interrupt {
    fn number(self) -> u16 {
        self as u16
    }
}

/// Gives each interrupt its priority; to be called before any of them is unmasked.
pub fn set_priorities() {
    // SAFETY: nothing else uses the NVIC yet, and no critical section relies on priorities.
    unsafe {
        let mut nvic = cortex_m::Peripherals::steal().NVIC;
        nvic.set_priority(Interrupt::Timer0, CLOCK_PRIORITY);
        nvic.set_priority(Interrupt::Timer1, CLOCK_PRIORITY);
        nvic.set_priority(Interrupt::Link, LINK_PRIORITY);
    }
}

unsafe extern "C" {
    fn DefaultHandler();
    fn TIMER0();
    fn TIMER1();
    fn LINK();
}

/// The table's part for interrupts; cortex-m-rt puts it behind its own.
#[unsafe(no_mangle)]
#[unsafe(link_section = ".vector_table.interrupts")]
static __INTERRUPTS: [unsafe extern "C" fn(); 32] = {
    let mut table: [unsafe extern "C" fn(); 32] = [DefaultHandler; 32];
    table[Interrupt::Timer0 as usize] = TIMER0;
    table[Interrupt::Timer1 as usize] = TIMER1;
    table[Interrupt::Link as usize] = LINK;
    table
};
