//! A tendon of constant stiffness.

use super::{Elasticity, check_stiffness};
use crate::{Error, Quantity, Reason, Scalar};

/// A tendon whose stiffness is the same at every tension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantStiffness<T> {
    stiffness: T,
}

impl<T: Scalar> ConstantStiffness<T> {
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

    /// Tangent stiffness when it pulls, N/m.
    #[must_use]
    #[inline(always)]
    pub fn stiffness_n_per_m(&self) -> T {
        self.stiffness
    }

    /// See [`Tendon::scale`](super::Tendon::scale).
    pub(super) fn scale(&mut self, elongation_factor: T) {
        self.stiffness /= elongation_factor;
    }
}

/// Asked by tension it checks nothing: the fast path asks it for every tendon, with tensions that are already checked.
impl<T: Scalar> Elasticity<T> for ConstantStiffness<T> {
    #[inline(always)]
    fn elongation(&self, tension: T) -> Result<T, Error> {
        Ok(tension / self.stiffness)
    }

    #[inline(always)]
    fn stiffness(&self, _tension: T) -> Result<T, Error> {
        Ok(self.stiffness)
    }

    #[inline(always)]
    fn tension(&self, elongation: T) -> Result<T, Error> {
        Ok(taut(elongation)? * self.stiffness)
    }

    #[inline(always)]
    fn energy(&self, elongation: T) -> Result<T, Error> {
        let elongation = taut(elongation)?;
        Ok(T::HALF * self.stiffness * elongation * elongation)
    }
}

/// The elongation, or zero of a slack tendon.
#[inline(always)]
fn taut<T: Scalar>(elongation: T) -> Result<T, Error> {
    if elongation > T::zero() {
        Ok(elongation)
    } else if elongation <= T::zero() {
        Ok(T::zero())
    } else {
        Err(Error::refused(Quantity::Elongation, Reason::NotFinite))
    }
}
