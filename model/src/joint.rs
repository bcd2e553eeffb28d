//! The elastic joint of a support: its energy, moment and stiffness at a pose.
//!
//! A joint bends by two angles and twists by one, and its energy is ½ Σ kα². A small rotation ψ of the leg changes
//! each angle by d·ψ, so the moment is −Σ kα d and the stiffness Σ k ddᵀ (the part that comes from the turning of the
//! vectors d while the joint is bent is left out: at 30° it is below a seventh of the bending stiffness).
//! For a universal joint the angles are those of R = Rx(α)Ry(β)Rz(γ). A pivot bends by the tilt in any azimuth and
//! twists by the torsion τ. At the vertical both give diag(K_bending, K_bending, K_torsion), the joint's own diagonal;
//! and as the torsion stiffness grows, a universal joint of flexures becomes a rigid one, which the diagonal turned
//! with the leg, R K_joint Rᵀ, does not.

use crate::{Direction, JointStiffness, Scalar, Support};
use nalgebra::{Matrix3, Vector3};

/// The angles of a universal joint at a direction, with what a rotation changes them by.
struct UniversalAngles<T> {
    alpha: T,
    beta: T,
    by_alpha: Vector3<T>,
    by_beta: Vector3<T>,
    by_torsion: Vector3<T>,
}

impl<T: Scalar> UniversalAngles<T> {
    fn at(direction: &Direction<T>) -> Self {
        let &Direction { x, y, z } = direction;
        let cos_beta = (y * y + z * z).sqrt();
        let (sin_alpha, cos_alpha) = (y / cos_beta, -z / cos_beta);
        let tan_beta = -x / cos_beta;
        let zero = T::zero();
        Self {
            alpha: y.atan2(-z),
            beta: (-x).atan2(cos_beta),
            by_alpha: Vector3::new(T::one(), tan_beta * sin_alpha, -tan_beta * cos_alpha),
            by_beta: Vector3::new(zero, cos_alpha, sin_alpha),
            by_torsion: Vector3::new(zero, -sin_alpha, cos_alpha) / cos_beta,
        }
    }
}

impl<T: Scalar> Support<T> {
    /// Moment of the bent and twisted joint on the leg, N·m. `torsion` (rad) is the elastic one, beyond that which the
    /// joint itself gives the leg.
    #[must_use]
    pub fn joint_moment(&self, direction: &Direction<T>, torsion: T) -> Vector3<T> {
        let JointStiffness {
            bending_nm_per_rad: bending,
            torsion_nm_per_rad: twisting,
            ..
        } = self.joint;
        if self.universal() {
            let angles = UniversalAngles::at(direction);
            let bent = angles.by_alpha * angles.alpha + angles.by_beta * angles.beta;
            bent * -bending - angles.by_torsion * (twisting * torsion)
        } else {
            let scale = bending * tilt_by_sine(direction);
            let bent = Vector3::new(-direction.y, direction.x, T::zero()) * scale;
            bent - torsion_change(direction) * (twisting * torsion)
        }
    }

    /// Stiffness of the joint at a pose, N·m/rad. It adds to that of the tendons: they are parallel.
    #[must_use]
    pub fn joint_stiffness(&self, direction: &Direction<T>) -> Matrix3<T> {
        let JointStiffness {
            bending_nm_per_rad: bending,
            torsion_nm_per_rad: twisting,
            ..
        } = self.joint;
        let square = |d: Vector3<T>| d * d.transpose();
        if self.universal() {
            let angles = UniversalAngles::at(direction);
            (square(angles.by_alpha) + square(angles.by_beta)) * bending
                + square(angles.by_torsion) * twisting
        } else {
            let twist = square(torsion_change(direction));
            let tilt = Matrix3::identity() - twist * (T::one() / twist.trace());
            tilt * bending + twist * twisting
        }
    }

    /// Elastic energy of the joint, J; `torsion` as in [`Self::joint_moment`].
    #[must_use]
    pub fn joint_energy(&self, direction: &Direction<T>, torsion: T) -> T {
        let JointStiffness {
            bending_nm_per_rad: bending,
            torsion_nm_per_rad: twisting,
            ..
        } = self.joint;
        let bent = if self.universal() {
            let angles = UniversalAngles::at(direction);
            angles.alpha * angles.alpha + angles.beta * angles.beta
        } else {
            let tilt = tilt_by_sine(direction) * sine(direction);
            tilt * tilt
        };
        T::HALF * (bending * bent + twisting * torsion * torsion)
    }

    /// What a small rotation of the leg changes its elastic torsion by: d in dτ = d·ψ.
    #[must_use]
    pub fn torsion_change(&self, direction: &Direction<T>) -> Vector3<T> {
        if self.universal() {
            UniversalAngles::at(direction).by_torsion
        } else {
            torsion_change(direction)
        }
    }
}

/// What a small rotation changes the torsion τ by: (z + Rz)/(1 + cos θ) = (−q_x, −q_y, 1).
fn torsion_change<T: Scalar>(direction: &Direction<T>) -> Vector3<T> {
    let q = direction.half_tangent();
    Vector3::new(-q.x, -q.y, T::one())
}

fn sine<T: Scalar>(direction: &Direction<T>) -> T {
    (direction.x * direction.x + direction.y * direction.y).sqrt()
}

/// θ/sin θ.
fn tilt_by_sine<T: Scalar>(direction: &Direction<T>) -> T {
    let sine = sine(direction);
    if sine > T::zero() {
        sine.atan2(-direction.z) / sine
    } else {
        T::one()
    }
}
