//! Bending stiffness: how the leg resists a tilt.

use crate::{Direction, Error, FreePlane, Scalar, Symmetric3};
use nalgebra::Vector3;

/// Which bending stiffness is meant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BendingAxis<T> {
    /// The softest tilt: the smallest eigenvalue.
    Softest,
    /// The tilt towards an azimuth, given as (cos, sin): the resistance to a push at the tip in that direction, as
    /// moment per angle.
    /// It is never below that of the softest tilt.
    Towards([T; 2]),
}

/// The stiffness of a leg against tilts, in a plane of rotations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bending<T> {
    direction: Direction<T>,
    plane: FreePlane<T>,
    /// PᵀKP in the basis (1, 0, ρ_x), (0, 1, ρ_y).
    stiffness: [T; 3],
    /// PᵀP.
    gram: [T; 3],
}

impl<T: Scalar> Bending<T> {
    /// On a support with two freedoms: PᵀKP.
    #[must_use]
    #[inline(always)]
    pub fn guided(k: &Symmetric3<T>, direction: &Direction<T>, plane: &FreePlane<T>) -> Self {
        let (right_x, right_y) = (k.xz + plane.rho_x * k.zz, k.yz + plane.rho_y * k.zz);
        Self {
            direction: *direction,
            plane: *plane,
            stiffness: [
                k.xx + plane.rho_x * (k.xz + right_x),
                k.xy + plane.rho_x * k.yz + plane.rho_y * right_x,
                k.yy + plane.rho_y * (k.yz + right_y),
            ],
            gram: [
                T::one() + plane.rho_x * plane.rho_x,
                plane.rho_x * plane.rho_y,
                T::one() + plane.rho_y * plane.rho_y,
            ],
        }
    }

    /// On a support with three freedoms: rotations across the leg, which move its tip, while the twist about the leg
    /// turns until it carries no moment. This is the resistance to a push at the tip.
    ///
    /// # Errors
    /// [`Error::Unstable`] if nothing holds that twist.
    #[inline(always)]
    pub fn twisting(k: &Symmetric3<T>, direction: &Direction<T>) -> Result<Self, Error> {
        let plane = &FreePlane::normal_to_leg(direction);
        let normal = plane.normal();
        let moment = k.times(&normal);
        let along = normal.dot(&moment);
        if !(along > T::zero()) {
            return Err(Error::Unstable);
        }
        let [x, y] = plane.project(&moment);
        let (by_x, by_y) = (x / along, y / along);
        let mut bending = Self::guided(k, direction, plane);
        let [xx, xy, yy] = &mut bending.stiffness;
        *xx -= by_x * x;
        *xy -= by_x * y;
        *yy -= by_y * y;
        Ok(bending)
    }

    /// The stiffness about an axis, N·m/rad.
    ///
    /// # Errors
    /// [`Error::Unstable`] if the leg does not resist every push.
    #[inline(always)]
    pub fn stiffness_about(&self, axis: &BendingAxis<T>) -> Result<T, Error> {
        match axis {
            BendingAxis::Softest => self.extremes().map(|[softest, _]| softest),
            BendingAxis::Towards(azimuth) => self.push_stiffness(*azimuth),
        }
    }

    /// The stiffness of the mean compliance, N·m/rad: of the root mean square of the compliances about the softest and the stiffest tilt. It
    /// is nearer to the softest, about which the leg swings slowest and farthest. Not positive where the leg does not resist every push.
    #[must_use]
    #[inline(always)]
    pub fn compliant_mean(&self) -> T {
        let ([xx, xy, yy], [gxx, gxy, gyy]) = (self.stiffness, self.gram);
        // Product and sum of the two stiffnesses, each times the determinant of the Gram matrix.
        let product = xx * yy - xy * xy;
        let sum = xx * gyy - T::TWO * xy * gxy + yy * gxx;
        let gram = gxx * gyy - gxy * gxy;
        product / (T::HALF * sum * sum - product * gram).sqrt()
    }

    /// The smallest and the largest stiffness over all tilts, N·m/rad.
    ///
    /// # Errors
    /// [`Error::Unstable`] if the smallest is not positive.
    #[inline(always)]
    pub fn extremes(&self) -> Result<[T; 2], Error> {
        let ([xx, xy, yy], [gxx, gxy, gyy]) = (self.stiffness, self.gram);
        // In the orthonormal basis that starts along the first axis, where the gap is a sum of squares: nothing cancels.
        let skew = gxy / gxx;
        let rest = gyy - skew * gxy;
        let side = xy - skew * xx;
        let first = xx / gxx;
        let second = (yy - skew * (xy + side)) / rest;
        let (mean, half) = (T::HALF * (first + second), T::HALF * (first - second));
        let half_gap = (half * half + side * side / (gxx * rest)).sqrt();
        let softest = mean - half_gap;
        if softest > T::zero() {
            Ok([softest, mean + half_gap])
        } else {
            Err(Error::Unstable)
        }
    }

    /// 1/(aᵀP K⁻¹ Pᵀa) with a = p × h/|p × h|, the axis about which a push towards the horizontal direction h turns the
    /// leg.
    #[inline(always)]
    fn push_stiffness(&self, [cos, sin]: [T; 2]) -> Result<T, Error> {
        let [xx, xy, yy] = self.stiffness;
        let determinant = xx * yy - xy * xy;
        if !(xx > T::zero() && determinant > T::zero()) {
            return Err(Error::Unstable);
        }
        let &Direction { x, y, z } = &self.direction;
        let axis = Vector3::new(-z * sin, z * cos, x * sin - y * cos);
        let [mx, my] = self.plane.project(&axis);
        let compliance = yy * mx * mx - T::TWO * xy * mx * my + xx * my * my;
        Ok(axis.dot(&axis) * determinant / compliance)
    }
}
