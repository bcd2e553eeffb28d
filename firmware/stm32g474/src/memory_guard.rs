//! Memory that nothing may write: the code in the CCM, and a kibibyte below the stack.
//!
//! The MPU makes a hard fault of such an access, and of a stack that is about to run into the variables; the handlers of faults
//! run without the MPU, so that they can still say so. Behind it, SYSCFG refuses writes to the CCM up to the next reset.

use cortex_m::peripheral::MPU;
use embassy_stm32::pac;
use embassy_stm32::pac::syscfg::regs::Swpr;

#[allow(unsafe_code, reason = "the linker's symbols are declared by hand")]
unsafe extern "C" {
    /// The end of the variables.
    static __sheap: u32;
}

/// The bytes between variables and stack. A frame that is larger may step over them; `leg cost --image` bounds the whole stack.
const GUARD: u32 = 1_024;

/// The CCM, and where its second address is.
const CCM: [u32; 2] = [0x1000_0000, 0x2001_8000];
const CCM_SIZE: u32 = 0x8000;

/// Bits of MPU_RBAR, MPU_RASR and MPU_CTRL: ARMv7-M Architecture Reference Manual, B3.5.
const VALID: u32 = 1 << 4;
const NO_CODE: u32 = 1 << 28;
const READ_ONLY: u32 = 0b110 << 24;
/// As the map of addresses has RAM without the MPU: normal memory, write back, write and read allocate.
const NORMAL: u32 = 0b001 << 19 | 0b11 << 16;
const ENABLE: u32 = 1;
const MAP_ELSEWHERE: u32 = 1 << 2;

/// Guards it; to be called once the code is in its place.
#[allow(unsafe_code, reason = "cortex-m hands its peripherals out once only")]
pub fn set() {
    let variables_end = (&raw const __sheap).addr() as u32;
    let guard = variables_end.next_multiple_of(GUARD);
    let regions = [
        (guard, size(GUARD) | NO_CODE),
        (CCM[0], size(CCM_SIZE) | READ_ONLY),
        (CCM[1], size(CCM_SIZE) | NO_CODE),
    ];
    // SAFETY: nothing else uses the MPU; no reference goes into the guarded places.
    let mpu = unsafe { &*MPU::PTR };
    for (number, (base, attributes)) in (0..).zip(regions) {
        // SAFETY: the MPU is off. This program reads code from the CCM, writes nothing there from here on, and has no object in
        // the guard.
        unsafe {
            mpu.rbar.write(base | VALID | number);
            mpu.rasr.write(attributes | NORMAL | ENABLE);
        }
    }
    cortex_m::asm::dmb();
    // SAFETY: elsewhere everything is as without it.
    unsafe { mpu.ctrl.write(ENABLE | MAP_ELSEWHERE) };
    cortex_m::asm::dsb();
    cortex_m::asm::isb();
    pac::SYSCFG.swpr().write_value(Swpr(u32::MAX));
}

/// The field of a size that is a power of two.
const fn size(bytes: u32) -> u32 {
    (bytes.trailing_zeros() - 1) << 1
}
