//! Sine and cosine of an f32 without a double-precision operation.
//!
//! `libm::sinf` and `cosf` compute in f64, which the Cortex-M4F does in software (2 000 instructions). Here the
//! argument is reduced by π/2 in three parts (after Cody and Waite) and the remainder goes into two polynomials,
//! minimax over [−π/4, π/4].

/// π/2 in three parts; the first two leave enough low bits empty for products with up to 11 bits to be exact.
const HALF_PI: [f32; 3] = [1.570_312_5, 4.837_513e-4, 7.549_79e-8];

/// (sin r − r)/r³ as a polynomial in r²: relative error of the sine 3.6e-9.
const SIN: [f32; 3] = [-0.166_666_55, 8.332_177e-3, -1.951_720_5e-4];

/// (cos r − 1 + r²/2)/r⁴ as a polynomial in r²: absolute error of the cosine 1e-10.
const COS: [f32; 3] = [4.166_664_6e-2, -1.388_736_7e-3, 2.443_835e-5];

/// Adding and subtracting 1.5·2²³ rounds an f32 of moderate size to the nearest integer.
const ROUND: f32 = 12_582_912.0;

/// Sine and cosine of `x`, in rad; within 1e-7 for |x| up to 3 000.
#[inline(always)]
pub fn sin_cos_f32(x: f32) -> (f32, f32) {
    let quadrant = (x * core::f32::consts::FRAC_2_PI + ROUND) - ROUND;
    let r = ((x - quadrant * HALF_PI[0]) - quadrant * HALF_PI[1]) - quadrant * HALF_PI[2];
    let z = r * r;
    let sin = r + r * z * (SIN[0] + z * (SIN[1] + z * SIN[2]));
    let cos = 1.0 - 0.5 * z + z * z * (COS[0] + z * (COS[1] + z * COS[2]));
    match quadrant as i32 & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}
