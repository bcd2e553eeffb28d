//! Copies the code that runs from RAM to its place: see `stm32g474/hot.x`.

use core::ptr;

#[allow(unsafe_code, reason = "the linker's symbols are declared by hand")]
unsafe extern "C" {
    static mut __shot: u32;
    static mut __ehot: u32;
    static __sihot: u32;
}

/// Copies it. Until then nothing may call it: the first that `main` does.
#[allow(
    unsafe_code,
    reason = "the linker alone knows where the code is and where it goes"
)]
pub fn load() {
    let (start, end) = (&raw mut __shot, &raw mut __ehot);
    let source = &raw const __sihot;
    let words = (end.addr() - start.addr()) / size_of::<u32>();
    for i in 0..words {
        // SAFETY: the linker script aligns both places to words and gives them this length; the source is flash, the
        // place is RAM of its own, to which nothing else refers.
        unsafe { ptr::write_volatile(start.add(i), ptr::read_volatile(source.add(i))) };
    }
    // The code is in memory, and nothing of what was there before is on its way to the processor.
    cortex_m::asm::dsb();
    cortex_m::asm::isb();
}
