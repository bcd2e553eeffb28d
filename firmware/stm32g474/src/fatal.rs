//! What happens when nothing can go on: first the outputs are switched off, then the cause is kept over a reset.

use crate::{clocks, flash, power, tick_watchdog};
use core::mem::MaybeUninit;
use core::panic::PanicInfo;
use core::ptr;
use core::sync::atomic::{AtomicBool, Ordering};
use cortex_m::peripheral::SCB;
use cortex_m_rt::{ExceptionFrame, exception};
use embassy_stm32::pac;
use embassy_stm32::pac::iwdg::vals::Key;
use leg_firmware::board::timing::CLOCK_HZ;
use leg_firmware::board::{CrashRecord, CrashReport, ShortText, file_name, reset_cause};
use leg_firmware::host_link::ResetCause;

/// Failures in a row from which on the next start is put off, so that a debugger has time to attach.
const HASTY_FAILURES: u32 = 3;

/// How long it is put off, in steps of 0.5 ms at least.
const REST_STEPS: u32 = 2_000;

/// Rounds of the loop of `delay` in a step. The core takes two to four cycles for one: 0.5 to 1 ms at the full clock, and about as long at that of a start.
const REST_STEP_ROUNDS: u32 = CLOCK_HZ / 4_000;
const REST_STEP_ROUNDS_AT_START: u32 = clocks::START_HZ / 4_000;
const _: () = assert!(4 * REST_STEP_ROUNDS < tick_watchdog::TIMEOUT_CYCLES * 63 / 64);

/// Set by the first failure: a second one, say while the first is reported, ends at once.
static FAILING: AtomicBool = AtomicBool::new(false);

/// Memory that the start-up code leaves alone.
#[allow(
    unsafe_code,
    reason = "only the section's name keeps it out of start-up"
)]
#[unsafe(link_section = ".uninit.crash_report")]
static mut RECORD: MaybeUninit<CrashRecord> = MaybeUninit::uninit();

#[allow(unsafe_code, reason = "the record outlives the program that writes it")]
fn record() -> CrashRecord {
    let record: *const CrashRecord = (&raw const RECORD).cast();
    // SAFETY: the place is aligned and always there; the read is volatile, so it gives whatever bits are there; every
    // pattern of bits is a `CrashRecord`; and no reference to it exists.
    unsafe { ptr::read_volatile(record) }
}

#[allow(unsafe_code, reason = "the record outlives the program that writes it")]
fn write(text: CrashRecord) {
    let record: *mut CrashRecord = (&raw mut RECORD).cast();
    // SAFETY: the place is aligned and always there, and no reference to it exists. A write that is interrupted by a
    // failure's own leaves the failure's, or a record whose checksum is wrong.
    unsafe { ptr::write_volatile(record, text) };
}

/// Why the chip started, and the crash report of the last run. It is asked once, before anything else can fail.
pub fn origin() -> (ResetCause, Option<CrashReport>) {
    let kept = record().read();
    let flags = pac::RCC.csr().read().0;
    pac::RCC.csr().modify(|w| w.set_rmvf(true));
    write(CrashRecord::empty(
        kept.as_ref().map_or(0, |kept| kept.failures),
    ));
    (reset_cause(flags, kept.as_ref()), kept)
}

/// Keeps a report for the next start, and counts a failure. Returns how many there were in a row.
pub fn keep(text: &ShortText) -> u32 {
    let before = record().read().map_or(0, |kept| kept.failures);
    let failures = before.saturating_add(1);
    write(CrashRecord::new(text, failures));
    failures
}

/// The firmware runs well: the failures before it are no row any more.
pub fn settle() {
    write(CrashRecord::empty(0));
}

/// Whether the program has ended: nothing but its report is left.
pub fn ending() -> bool {
    FAILING.load(Ordering::Relaxed)
}

/// Ends everything, safely.
pub fn end(text: &ShortText) -> ! {
    cortex_m::interrupt::disable();
    power::cut_outputs();
    tick_watchdog::refresh_if_started();
    if FAILING.swap(true, Ordering::Relaxed) {
        SCB::sys_reset();
    }
    let failures = keep(text);
    defmt::error!("{=str}", text.as_str());
    if failures >= HASTY_FAILURES {
        rest();
    }
    SCB::sys_reset()
}

/// Waits, and keeps the watchdogs quiet if they run already.
fn rest() {
    let rounds = if clocks::has_start_clock() {
        REST_STEP_ROUNDS_AT_START
    } else {
        REST_STEP_ROUNDS
    };
    for _ in 0..REST_STEPS {
        pac::IWDG.kr().write(|w| w.set_key(Key::RESET));
        tick_watchdog::refresh_if_started();
        cortex_m::asm::delay(rounds);
    }
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    let text = match info.location() {
        Some(place) => ShortText::new(file_name(place.file()))
            .text(":")
            .number(place.line())
            .text(": "),
        None => ShortText::default(),
    };
    // A message that has to be put together first is left out: the place is enough.
    end(&text.text(info.message().as_str().unwrap_or("panic")))
}

#[allow(
    unsafe_code,
    reason = "cortex-m-rt wants its exception handlers unsafe"
)]
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    // SAFETY: reading the register changes nothing, and it is always there.
    let cause = unsafe { (*SCB::PTR).cfsr.read() };
    let text = ShortText::new("hard fault at ").hex(frame.pc());
    let text = text.text(", called from ").hex(frame.lr());
    end(&text.text(", CFSR ").hex(cause))
}

#[allow(
    unsafe_code,
    reason = "cortex-m-rt wants its exception handlers unsafe"
)]
#[exception]
unsafe fn DefaultHandler(number: i16) -> ! {
    // Numbers count from the first interrupt; those of the core's own exceptions are negative.
    let exception = u32::from(number.wrapping_add(16).cast_unsigned());
    end(&ShortText::new("no handler for exception ").number(exception))
}

/// The crystal has stopped, or the flash has read a double word that does not agree with its ECC.
///
/// Where settings are kept that can happen after a loss of power; who reads there finds it out by checksums, and goes
/// on. Programs lie in the first bank: there it is the end, and so it is without the crystal.
#[allow(
    unsafe_code,
    reason = "cortex-m-rt wants its exception handlers unsafe"
)]
#[exception]
unsafe fn NonMaskableInt() {
    if clocks::lost() {
        end(&ShortText::new("the crystal has stopped"));
    }
    let ecc = pac::FLASH.eccr().read();
    let found = ecc.eccd() || ecc.eccd2();
    if !found || !ecc.bk_ecc() || ecc.sysf_ecc() {
        end(&ShortText::new("NMI, flash ECC ").hex(ecc.0));
    }
    flash::forget_ecc_errors();
}
