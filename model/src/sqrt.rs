//! The square root as one instruction, with the bits of IEEE 754 on every machine.

/// Square root of an f32.
#[inline(always)]
pub fn sqrt_f32(x: f32) -> f32 {
    #[cfg(target_arch = "arm")]
    return sqrtf(x);
    #[cfg(not(target_arch = "arm"))]
    return libm::sqrtf(x);
}

/// Square root of an f32 in integer arithmetic, under the name that the compiler knows from C.
///
/// The Cortex-M4F has `vsqrt.f32`, but `core` has no function for it. LLVM recognises a function of this name and puts
/// the instruction in the place of every call, because it sees here that the function has no side effects. Where it
/// does not (in a build without optimisation), this body gives the same bits. Inlined, it would not be recognised.
/// The kernel "square root" of `leg cost` shows whether the instruction is there, `leg check` compares the bits.
#[cfg(target_arch = "arm")]
#[allow(
    unsafe_code,
    reason = "the name has to be C's; nothing else in the image defines it"
)]
#[unsafe(no_mangle)]
#[inline(never)]
extern "C" fn sqrtf(x: f32) -> f32 {
    libm::sqrtf(x)
}
