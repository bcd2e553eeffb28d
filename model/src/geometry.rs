//! Where the tendons pull: the part of a mechanism that the fast path works on.

use crate::length_polynomial::LengthPolynomial;
use crate::{Direction, Kinematics, RigParameters, Scalar, Twist};
use nalgebra::{SVector, Vector3};

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
    pub(crate) fn new(parameters: &RigParameters<T, N>) -> Self {
        let p = parameters;
        let (upper, joint) = (p.upper_length_m, p.joint_length_m);
        let pair =
            |i: usize| AnchorPair::new(p.base_anchors_m[i], p.leg_anchors_m[i], upper, joint);
        Self {
            tendons: core::array::from_fn(pair),
            upper,
            joint,
        }
    }

    /// How much of a unit tension in each tendon pulls the leg up along its own axis: −n·p with n = (B − e)/l.
    #[must_use]
    pub fn along_leg(
        &self,
        direction: &Direction<T>,
        kinematics: &Kinematics<T, N>,
    ) -> SVector<T, N> {
        SVector::from_fn(|i, _| {
            let [x, y] = self.tendons[i].base;
            // e·p is the joint's distance from the leg's plate.
            let base = x * direction.x + y * direction.y + self.upper * direction.z;
            (self.joint - base) / kinematics.lengths[i]
        })
    }

    /// What a small rotation of the leg changes [`Self::along_leg`] by; `lengthening` is what it does to the tendons, m.
    pub(crate) fn along_leg_change(
        &self,
        direction: &Direction<T>,
        kinematics: &Kinematics<T, N>,
        rotation: &Vector3<T>,
        lengthening: &SVector<T, N>,
    ) -> SVector<T, N> {
        let along = self.along_leg(direction, kinematics);
        let turned = rotation.cross(&direction.vector());
        SVector::from_fn(|i, _| {
            let [x, y] = self.tendons[i].base;
            let base = x * turned.x + y * turned.y + self.upper * turned.z;
            -(base + along[i] * lengthening[i]) / kinematics.lengths[i]
        })
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
