//! Minimum, maximum and clamp, with a defined result for NaN; `core` has none for the generic scalar.

use leg_model::Scalar;

/// The lower of two; the second if the first is not a number.
#[inline(always)]
pub fn min<T: Scalar>(a: T, b: T) -> T {
    if a < b { a } else { b }
}

/// The higher of two; the second if the first is not a number.
#[inline(always)]
pub fn max<T: Scalar>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

/// The number between −`bound` and `bound` that is nearest.
#[inline(always)]
pub fn clamp_symmetric<T: Scalar>(value: T, bound: T) -> T {
    min(max(value, -bound), bound)
}
