//! Counts instructions by QEMU's clock.
//!
//! Under `-icount shift=10` each instruction takes 2¹⁰ ns of QEMU's time, which is 25.6 ticks of TIMER0: the number
//! of instructions follows exactly, by rounding, and is the same in every run.

use crate::timer::CmsdkTimer;
use core::arch::asm;
use core::hint::black_box;

const TICK_NS: u64 = 40;
const INSTRUCTION_NS: u64 = 1 << 10;

/// Instructions of [`hundred_nops`].
pub const NOPS: u32 = 100;

/// Instructions that one call of `kernel` takes, without the call and the return.
pub fn count<A, B>(kernel: fn(&A, &mut B), input: &A, output: &mut B) -> u32 {
    let full = ticks_of(black_box(kernel), input, output);
    let empty = ticks_of(black_box(nothing::<A, B>), input, output);
    instructions(full.wrapping_sub(empty))
}

/// What the counter reads for 100 `nop`s: 100, unless QEMU's clock runs at another rate.
pub fn count_nops() -> u32 {
    count(hundred_nops, &(), &mut ())
}

fn instructions(ticks: u32) -> u32 {
    let rounded = (u64::from(ticks) * TICK_NS + INSTRUCTION_NS / 2) / INSTRUCTION_NS;
    u32::try_from(rounded).unwrap_or(u32::MAX)
}

/// Not inlined, so that every kernel of one signature is called by the very same instructions.
#[inline(never)]
fn ticks_of<A, B>(kernel: fn(&A, &mut B), input: &A, output: &mut B) -> u32 {
    critical_section::with(|_| {
        let before = CmsdkTimer::FREE_RUNNING.value();
        kernel(input, output);
        before.wrapping_sub(CmsdkTimer::FREE_RUNNING.value())
    })
}

fn nothing<A, B>(_: &A, _: &mut B) {}

#[allow(unsafe_code, reason = "only assembly fixes the number of instructions")]
fn hundred_nops(_: &(), _: &mut ()) {
    // SAFETY: a nop touches nothing.
    unsafe { asm!(".rept {nops}", "nop", ".endr", nops = const NOPS, options(nomem, nostack)) }
}
