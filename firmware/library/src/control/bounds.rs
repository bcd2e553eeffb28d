//! Numbers held between bounds, by the caller's will and with the caller told.

use leg_model::Scalar;

/// The lower of two; the second if the first is not a number.
#[inline(always)]
pub fn least<T: Scalar>(a: T, b: T) -> T {
    if a < b { a } else { b }
}

/// The higher of two; the second if the first is not a number.
#[inline(always)]
pub fn most<T: Scalar>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

/// The number between −`bound` and `bound` that is nearest.
#[inline(always)]
pub fn within<T: Scalar>(value: T, bound: T) -> T {
    least(most(value, -bound), bound)
}
