//! The critical sections of the tasks and of their drivers: they hold every interrupt off but the control interrupt.
//!
//! How long the drivers' sections take is theirs: the timer queue's grows with the tasks that wait. So the control interrupt
//! shares nothing with them, and takes no such section itself. What it shares with the tasks is in `control`, whose sections
//! mask every interrupt.

use crate::fatal;
use crate::priorities::CONTROL;
use core::arch::asm;
use core::sync::atomic::{Ordering, compiler_fence};
use cortex_m::register::{basepri, basepri_max};
use critical_section::{Impl, RawRestoreState, set_impl};
use embassy_stm32::interrupt::{Interrupt, Priority};

/// The most urgent that is held off.
const BELOW_CONTROL: Priority = Priority::P1;
const _: () = assert!((BELOW_CONTROL as u8) > (CONTROL as u8));

/// The exception that the control interrupt is: interrupts are numbered from 16 on.
const CONTROL_EXCEPTION: u32 = 16 + Interrupt::ADC1_2 as u32;

struct TaskSection;
set_impl!(TaskSection);

// SAFETY: all that takes a section is a task or an interrupt of a lower priority than the control interrupt, from
// `priorities::set` on, before which no interrupt is unmasked; BASEPRI then holds all of them off. The control interrupt
// is refused. Sections nest, as each release puts back what it found.
#[allow(unsafe_code, reason = "the trait asks for it")]
unsafe impl Impl for TaskSection {
    unsafe fn acquire() -> RawRestoreState {
        let exception: u32;
        // SAFETY: it reads the number of the exception in progress, and changes nothing.
        unsafe {
            asm!("mrs {}, IPSR", out(reg) exception, options(nomem, nostack, preserves_flags));
        }
        // The last report of a program that has ended masks every interrupt by itself.
        if exception == CONTROL_EXCEPTION && !fatal::ending() {
            panic!("a section of the tasks in the control interrupt");
        }
        let before = basepri::read();
        basepri_max::write(BELOW_CONTROL as u8);
        compiler_fence(Ordering::SeqCst);
        before
    }

    unsafe fn release(before: RawRestoreState) {
        compiler_fence(Ordering::SeqCst);
        // SAFETY: it is what the section found.
        unsafe { basepri::write(before) };
    }
}
