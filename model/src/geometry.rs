//! Where the tendons pull: the part of a mechanism that the fast path works on.

use crate::length_polynomial::LengthPolynomial;
use crate::{Scalar, Twist};

/// Anchors and plates of a validated mechanism, for a leg without torsion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Geometry<T, const N: usize> {
    pub(crate) tendons: [AnchorPair<T>; N],
    /// L_upper, m.
    pub(crate) upper: T,
    /// L_joint, m.
    pub(crate) joint: T,
}

/// The two ends of a tendon on their plates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AnchorPair<T> {
    /// On the base plate: b, m.
    pub base: [T; 2],
    /// On the leg's plate: s, m.
    pub leg: [T; 2],
    /// |b − s|² + (L_upper − L_joint)², m²: the part of l² that does not depend on the leg's direction.
    pub square: T,
    /// Its length in half-tangent coordinates.
    pub polynomial: LengthPolynomial<T>,
}

impl<T: Scalar, const N: usize> Geometry<T, N> {
    /// From validated anchors and lengths, m.
    pub(crate) fn new(base: &[[T; 2]; N], leg: &[[T; 2]; N], upper: T, joint: T) -> Self {
        Self {
            tendons: core::array::from_fn(|i| AnchorPair::new(base[i], leg[i], upper, joint)),
            upper,
            joint,
        }
    }

    /// The same mechanism with its leg twisted about its own axis.
    ///
    /// A twist only turns the leg's anchors, so every function for a leg without torsion serves a twisted one.
    #[must_use]
    #[inline(always)]
    pub fn twisted(&self, twist: &Twist<T>) -> Self {
        let mut twisted = *self;
        for pair in &mut twisted.tendons {
            *pair = AnchorPair::new(pair.base, twist.apply(pair.leg), self.upper, self.joint);
        }
        twisted
    }
}

impl<T: Scalar> AnchorPair<T> {
    #[inline(always)]
    fn new(base: [T; 2], leg: [T; 2], upper: T, joint: T) -> Self {
        let (dx, dy, dz) = (base[0] - leg[0], base[1] - leg[1], upper - joint);
        let square = dx * dx + dy * dy + dz * dz;
        let polynomial = LengthPolynomial::new(base, leg, upper, joint, square);
        Self {
            base,
            leg,
            square,
            polynomial,
        }
    }
}
