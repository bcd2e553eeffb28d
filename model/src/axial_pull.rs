//! The pull of the tendons along the leg, which stretches joint and shaft.

use crate::{Direction, Geometry, Kinematics, Scalar};
use nalgebra::{SVector, Vector3};

impl<T: Scalar, const N: usize> Geometry<T, N> {
    /// How much of a unit tension in each tendon pulls the leg up along its own axis: −n·p with n = (B − e)/l.
    #[must_use]
    pub fn axial_pulls(
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

    /// What a small rotation of the leg changes [`Self::axial_pulls`] by; `lengthening` is what it does to the tendons, m.
    pub(crate) fn axial_pulls_change(
        &self,
        direction: &Direction<T>,
        kinematics: &Kinematics<T, N>,
        rotation: &Vector3<T>,
        lengthening: &SVector<T, N>,
    ) -> SVector<T, N> {
        let along = self.axial_pulls(direction, kinematics);
        let turned = rotation.cross(&direction.vector());
        SVector::from_fn(|i, _| {
            let [x, y] = self.tendons[i].base;
            let base = x * turned.x + y * turned.y + self.upper * turned.z;
            -(base + along[i] * lengthening[i]) / kinematics.lengths[i]
        })
    }
}
