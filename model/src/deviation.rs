//! How far the tip moves when the leg turns a little.

use crate::{Direction, Scalar};
use nalgebra::Vector3;

/// ψ × R(0, 0, −L), m: displacement of a tip `tip_m` below the joint under a small rotation ψ (rad).
#[must_use]
#[inline(always)]
pub fn tip_displacement<T: Scalar>(
    rotation: &Vector3<T>,
    direction: &Direction<T>,
    tip_m: T,
) -> Vector3<T> {
    let &Direction { x, y, z } = direction;
    let (x, y, z) = (tip_m * x, tip_m * y, tip_m * z);
    Vector3::new(
        rotation.y * z - rotation.z * y,
        rotation.z * x - rotation.x * z,
        rotation.x * y - rotation.y * x,
    )
}

/// Length of a displacement, m.
#[must_use]
#[inline(always)]
pub fn deviation<T: Scalar>(displacement: &Vector3<T>) -> T {
    let d = displacement;
    (d.x * d.x + d.y * d.y + d.z * d.z).sqrt()
}
