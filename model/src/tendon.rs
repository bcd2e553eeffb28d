//! The elasticity of a tendon.

use crate::range::{STIFFNESS, check_positive};
use crate::{Error, Quantity, Reason, Scalar};

/// A tendon with constant stiffness. It pulls when it is stretched and cannot push.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tendon<T> {
    stiffness: T,
}

impl<T: Scalar> Tendon<T> {
    /// A tendon of a stiffness in N/m.
    ///
    /// # Errors
    /// A stiffness that is not finite, not positive or outside 10⁻² to 10¹⁰ N/m.
    pub fn new(stiffness_n_per_m: T) -> Result<Self, Error> {
        check_stiffness(stiffness_n_per_m)?;
        Ok(Self {
            stiffness: stiffness_n_per_m,
        })
    }

    /// Tangent stiffness, N/m.
    #[must_use]
    #[inline(always)]
    pub fn stiffness(&self) -> T {
        self.stiffness
    }

    /// δ(T): how much longer it is under a tension, m.
    #[must_use]
    #[inline(always)]
    pub fn elongation(&self, tension: T) -> T {
        tension / self.stiffness
    }

    /// Tension at an elongation; none when slack, N.
    #[must_use]
    #[inline(always)]
    pub fn tension(&self, elongation: T) -> T {
        let tension = self.stiffness * elongation;
        if tension > T::zero() {
            tension
        } else {
            T::zero()
        }
    }

    /// Length without tension of a tendon that measures `length` under `tension`, m.
    #[must_use]
    #[inline(always)]
    pub fn unstretched(&self, length: T, tension: T) -> T {
        length - self.elongation(tension)
    }
}

/// Refuses what is no stiffness of a tendon.
pub(crate) fn check_stiffness<T: Scalar>(stiffness: T) -> Result<(), Error> {
    let [softest, stiffest] = STIFFNESS;
    check_positive(stiffness, stiffest, Quantity::TendonStiffness)?;
    if stiffness < T::from(softest) {
        return Err(Error::refused(
            Quantity::TendonStiffness,
            Reason::OutOfRange,
        ));
    }
    Ok(())
}
