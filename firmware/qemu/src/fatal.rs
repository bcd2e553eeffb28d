//! Ends the run at once when something went wrong, with the exit code for it.

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};
use cortex_m_rt::{ExceptionFrame, exception};
use leg_firmware_bench::exit::Exit;

/// Set by the first failure: a second one, say inside the log, must not log again.
static FAILING: AtomicBool = AtomicBool::new(false);

/// Ends QEMU with the exit's code.
pub fn end(exit: Exit) -> ! {
    semihosting::process::exit(exit.code())
}

/// Logs what went wrong and ends QEMU.
fn fail(exit: Exit, log: impl FnOnce()) -> ! {
    if !FAILING.swap(true, Ordering::Relaxed) {
        log();
    }
    end(exit)
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    fail(Exit::Panic, || {
        defmt::error!("{}", defmt::Display2Format(info));
    })
}

#[allow(
    unsafe_code,
    reason = "cortex-m-rt wants its exception handlers unsafe"
)]
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    fail(Exit::HardFault, || {
        defmt::error!("hard fault at {=u32:#010x}", frame.pc());
    })
}

#[allow(
    unsafe_code,
    reason = "cortex-m-rt wants its exception handlers unsafe"
)]
#[exception]
unsafe fn DefaultHandler(number: i16) -> ! {
    fail(Exit::UnexpectedInterrupt, || {
        defmt::error!("no handler for interrupt {=i16}", number);
    })
}
