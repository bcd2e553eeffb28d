//! The square root as one instruction, with the bits of IEEE 754 on every machine.

#[cfg(target_arch = "arm")]
#[allow(unsafe_code, reason = "the only way to the FPU's square root")]
#[unsafe(no_mangle)]
#[inline(never)]
extern "C" fn sqrtf(x: f32) -> f32 {
    libm::sqrtf(x)
}

#[cfg(target_arch = "arm")]
#[inline(always)]
pub fn sqrt_f32(x: f32) -> f32 {
    sqrtf(x)
}

/// Square root of an f32: the host's own instruction, by way of `libm`.
#[cfg(not(target_arch = "arm"))]
#[inline(always)]
pub fn sqrt_f32(x: f32) -> f32 {
    libm::sqrtf(x)
}
