//! The elastic joint of a support: its energy, moment and stiffness at a pose.
//!
//! A joint bends by two angles and twists by one, and its energy is ½ Σ kα². A small rotation ψ of the leg changes
//! each angle by d·ψ, so the moment is −Σ kα d and the stiffness Σ k(ddᵀ + α ∂d/∂ψ).
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
    tan_beta: T,
    /// 1/cos β.
    secant: T,
    /// Normal to both axes of the joint, (0, −sin α, cos α).
    normal: Vector3<T>,
    by_alpha: Vector3<T>,
    by_beta: Vector3<T>,
    by_torsion: Vector3<T>,
}

impl<T: Scalar> UniversalAngles<T> {
    fn new(direction: &Direction<T>) -> Self {
        let &Direction { x, y, z } = direction;
        let cos_beta = (y * y + z * z).sqrt();
        let secant = T::one() / cos_beta;
        let (sin_alpha, cos_alpha) = (y * secant, -z * secant);
        let tan_beta = -x * secant;
        let normal = Vector3::new(T::zero(), -sin_alpha, cos_alpha);
        Self {
            alpha: y.atan2(-z),
            beta: (-x).atan2(cos_beta),
            tan_beta,
            secant,
            normal,
            by_alpha: Vector3::x() - normal * tan_beta,
            by_beta: Vector3::new(T::zero(), cos_alpha, sin_alpha),
            by_torsion: normal * secant,
        }
    }

    /// Σ(ddᵀ + α ∂d/∂ψ) over the two bending angles.
    fn bending_stiffness(&self) -> Matrix3<T> {
        let (d1, d2) = (self.by_alpha.transpose(), self.by_beta.transpose());
        let turning = (self.by_beta * d1 * self.tan_beta
            - self.normal * d2 * (self.secant * self.secant))
            * self.alpha
            + self.normal * d1 * self.beta;
        self.by_alpha * d1 + self.by_beta * d2 + turning
    }

    /// The same of the elastic torsion.
    fn torsion_stiffness(&self, torsion: T) -> Matrix3<T> {
        let (d1, d2) = (self.by_alpha.transpose(), self.by_beta.transpose());
        let turning = self.normal * d2 * self.tan_beta - self.by_beta * d1;
        self.by_torsion * self.by_torsion.transpose() + turning * (self.secant * torsion)
    }
}

/// The joint's moment at a direction as a function of its elastic torsion alone.
pub(crate) struct JointMoment<T> {
    bent: Vector3<T>,
    by_torsion: Vector3<T>,
    twisting: T,
}

impl<T: Scalar> JointMoment<T> {
    /// Moment on the leg, N·m, at an elastic torsion in rad.
    pub fn moment(&self, torsion: T) -> Vector3<T> {
        self.bent - self.by_torsion * (self.twisting * torsion)
    }
}

impl<T: Scalar> Support<T> {
    /// Moment of the bent and twisted joint on the leg, N·m. `torsion` (rad) is the elastic one, beyond that which the
    /// joint itself gives the leg.
    #[must_use]
    pub fn joint_moment(&self, direction: &Direction<T>, torsion: T) -> Vector3<T> {
        if !self.elastic() {
            return Vector3::zeros();
        }
        self.joint_moment_by_torsion(direction).moment(torsion)
    }

    /// [`Self::joint_moment`] for many torsions at one direction.
    pub(crate) fn joint_moment_by_torsion(&self, direction: &Direction<T>) -> JointMoment<T> {
        let JointStiffness {
            bending_nm_per_rad: bending,
            torsion_nm_per_rad: twisting,
            ..
        } = self.joint;
        let (bent, by_torsion) = if self.universal() {
            let angles = UniversalAngles::new(direction);
            let bent = angles.by_alpha * angles.alpha + angles.by_beta * angles.beta;
            (bent * -bending, angles.by_torsion)
        } else {
            let scale = bending * tilt_by_sine(direction);
            let bent = Vector3::new(-direction.y, direction.x, T::zero()) * scale;
            (bent, torsion_change(direction))
        };
        JointMoment {
            bent,
            by_torsion,
            twisting,
        }
    }

    /// Stiffness of the joint at a pose: minus the derivative of its moment, N·m/rad. It adds to that of the tendons:
    /// they are parallel. Its antisymmetric part is half the joint's moment, as that of the tendons is half of theirs.
    #[must_use]
    pub fn joint_stiffness(&self, direction: &Direction<T>, torsion: T) -> Matrix3<T> {
        if !self.elastic() {
            return Matrix3::zeros();
        }
        let JointStiffness {
            bending_nm_per_rad: bending,
            torsion_nm_per_rad: twisting,
            ..
        } = self.joint;
        if bending == T::zero() && twisting == T::zero() {
            return Matrix3::zeros();
        }
        if self.universal() {
            let angles = UniversalAngles::new(direction);
            angles.bending_stiffness() * bending + angles.torsion_stiffness(torsion) * twisting
        } else {
            tilt_stiffness(direction) * bending + torsion_stiffness(direction, torsion) * twisting
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
            let angles = UniversalAngles::new(direction);
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
            UniversalAngles::new(direction).by_torsion
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

/// Stiffness of a pivot against tilt for a unit bending stiffness: the moment is that of a load of the lever
/// −θ/sin θ, which changes with the tilt.
fn tilt_stiffness<T: Scalar>(direction: &Direction<T>) -> Matrix3<T> {
    let &Direction { x, y, z } = direction;
    let (lever, sine, zero) = (tilt_by_sine(direction), sine(direction), T::zero());
    let turned = Matrix3::new(-z, zero, x, zero, -z, y, zero, zero, zero) * lever;
    if sine > zero {
        let axis = Vector3::new(y, -x, zero) / sine;
        turned + axis * axis.transpose() * (T::one() + lever * z)
    } else {
        turned
    }
}

/// Stiffness of a pivot against torsion for a unit torsion stiffness: ddᵀ + τ ∂d/∂ψ with d = (−q, 1).
fn torsion_stiffness<T: Scalar>(direction: &Direction<T>, torsion: T) -> Matrix3<T> {
    let &Direction { x, y, z } = direction;
    let q = direction.half_tangent();
    let (d, zero, scale) = (
        torsion_change(direction),
        T::zero(),
        -torsion / direction.gain(),
    );
    // How a rotation changes the direction: ψ × p, by rows.
    #[rustfmt::skip]
    let turning = Matrix3::new(
        q.x * y, z - q.x * x, -y,
        q.y * y - z, -q.y * x, x,
        zero, zero, zero,
    );
    d * d.transpose() + turning * scale
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
