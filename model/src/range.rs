//! The ranges in which the model holds: wide for any mechanism, narrow enough for f32 never to overflow.

use crate::{Error, Quantity, Reason, Scalar};

/// Longest length, m.
pub(crate) const LENGTH_MAX: f32 = 100.0;
/// Greatest mass, kg.
pub(crate) const MASS_MAX: f32 = 1e6;
/// Strongest gravity, m/s².
pub(crate) const GRAVITY_MAX: f32 = 1e3;
/// Greatest tension and pretension, N.
pub(crate) const TENSION_MAX: f32 = 1e7;
/// Softest and stiffest tendon, N/m.
pub(crate) const STIFFNESS: [f32; 2] = [1e-2, 1e10];
/// Stiffest joint, N·m/rad.
pub(crate) const JOINT_STIFFNESS_MAX: f32 = 1e6;
/// Most compliant joint along its axis, m/N.
pub(crate) const COMPLIANCE_MAX: f32 = 1.0;

/// Refuses a value that is not finite or whose magnitude is above `limit`.
pub(crate) fn check_magnitude<T: Scalar>(
    value: T,
    limit: f32,
    quantity: Quantity,
) -> Result<(), Error> {
    if !value.is_finite() {
        return Err(Error::refused(quantity, Reason::NotFinite));
    }
    if value.abs() > T::from(limit) {
        return Err(Error::refused(quantity, Reason::OutOfRange));
    }
    Ok(())
}

/// Refuses a value that is not above zero, not finite or above `limit`.
pub(crate) fn check_positive<T: Scalar>(
    value: T,
    limit: f32,
    quantity: Quantity,
) -> Result<(), Error> {
    check_magnitude(value, limit, quantity)?;
    if value > T::zero() {
        Ok(())
    } else {
        Err(Error::refused(quantity, Reason::NotPositive))
    }
}

/// Refuses a value that is below zero, not finite or above `limit`.
pub(crate) fn check_not_negative<T: Scalar>(
    value: T,
    limit: f32,
    quantity: Quantity,
) -> Result<(), Error> {
    check_magnitude(value, limit, quantity)?;
    if value >= T::zero() {
        Ok(())
    } else {
        Err(Error::refused(quantity, Reason::Negative))
    }
}
