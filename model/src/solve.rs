//! Small linear systems: two by two for the free axes, three by three for a ball joint.

use crate::{Error, Scalar};
use nalgebra::{Matrix3, Vector3};

/// Normal equations of a weighted least-squares problem with two unknowns.
pub(crate) struct NormalEquations<T> {
    xx: T,
    xy: T,
    yy: T,
    right_x: T,
    right_y: T,
    /// Weighted sum of the squared errors before the step.
    errors: T,
}

/// What normal equations answer.
pub(crate) struct LeastSquares<T> {
    pub x: T,
    pub y: T,
    /// Weighted sum of the squared errors that the step leaves, to first order.
    pub remainder: T,
}

impl<T: Scalar> NormalEquations<T> {
    #[inline(always)]
    pub fn zero() -> Self {
        let zero = T::zero();
        Self {
            xx: zero,
            xy: zero,
            yy: zero,
            right_x: zero,
            right_y: zero,
            errors: zero,
        }
    }

    /// Adds one equation: gradient·(x, y) = error.
    #[inline(always)]
    pub fn add(&mut self, gradient: [T; 2], error: T, weight: T) {
        let [x, y] = gradient;
        let (weighted_x, weighted_y) = (weight * x, weight * y);
        self.xx += weighted_x * x;
        self.xy += weighted_x * y;
        self.yy += weighted_y * y;
        self.right_x += weighted_x * error;
        self.right_y += weighted_y * error;
        self.errors += weight * error * error;
    }

    #[inline(always)]
    pub fn solve(&self) -> Result<LeastSquares<T>, Error> {
        let determinant = self.xx * self.yy - self.xy * self.xy;
        // Also refuses NaN.
        if !(determinant > T::zero()) {
            return Err(Error::Singular);
        }
        let scale = T::one() / determinant;
        let x = (self.yy * self.right_x - self.xy * self.right_y) * scale;
        let y = (self.xx * self.right_y - self.xy * self.right_x) * scale;
        let remainder = self.errors - self.right_x * x - self.right_y * y;
        Ok(LeastSquares { x, y, remainder })
    }
}

/// A symmetric matrix of order three, kept as its six numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Symmetric3<T> {
    /// Row 1, column 1.
    pub xx: T,
    /// Row 1, column 2.
    pub xy: T,
    /// Row 1, column 3.
    pub xz: T,
    /// Row 2, column 2.
    pub yy: T,
    /// Row 2, column 3.
    pub yz: T,
    /// Row 3, column 3.
    pub zz: T,
}

impl<T: Scalar> Symmetric3<T> {
    /// The symmetric part of a matrix.
    #[must_use]
    pub fn symmetric_part(matrix: &Matrix3<T>) -> Self {
        Self {
            xx: matrix.m11,
            xy: T::HALF * (matrix.m12 + matrix.m21),
            xz: T::HALF * (matrix.m13 + matrix.m31),
            yy: matrix.m22,
            yz: T::HALF * (matrix.m23 + matrix.m32),
            zz: matrix.m33,
        }
    }

    /// The matrix in full.
    #[must_use]
    pub fn matrix(&self) -> Matrix3<T> {
        let &Self {
            xx,
            xy,
            xz,
            yy,
            yz,
            zz,
        } = self;
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }

    /// Solves K x = m by LDLᵀ.
    ///
    /// # Errors
    /// [`Error::Unstable`] unless the matrix is positive definite.
    #[inline(always)]
    pub fn solve(&self, m: &Vector3<T>) -> Result<Vector3<T>, Error> {
        let &Self {
            xx,
            xy,
            xz,
            yy,
            yz,
            zz,
        } = self;
        let inverse_1 = positive_inverse(xx)?;
        let (l21, l31) = (xy * inverse_1, xz * inverse_1);
        let inverse_2 = positive_inverse(yy - l21 * xy)?;
        let rest_yz = yz - l31 * xy;
        let l32 = rest_yz * inverse_2;
        let inverse_3 = positive_inverse(zz - l31 * xz - l32 * rest_yz)?;
        let y2 = m.y - l21 * m.x;
        let y3 = m.z - l31 * m.x - l32 * y2;
        let x3 = y3 * inverse_3;
        let x2 = y2 * inverse_2 - l32 * x3;
        let x1 = m.x * inverse_1 - l21 * x2 - l31 * x3;
        Ok(Vector3::new(x1, x2, x3))
    }
}

/// 1/pivot of a positive pivot; NaN is refused too.
#[inline(always)]
fn positive_inverse<T: Scalar>(pivot: T) -> Result<T, Error> {
    if pivot > T::zero() {
        Ok(T::one() / pivot)
    } else {
        Err(Error::Unstable)
    }
}

/// Solves K x = m for a matrix that need not be symmetric, by cofactors.
///
/// # Errors
/// [`Error::Unstable`] unless the symmetric part of K is positive definite.
pub fn solve3<T: Scalar>(k: &Matrix3<T>, m: &Vector3<T>) -> Result<Vector3<T>, Error> {
    Symmetric3::symmetric_part(k).solve(m)?;
    let row = |i| k.row(i).transpose();
    let (r1, r2, r3) = (row(0), row(1), row(2));
    let (c1, c2, c3) = (r2.cross(&r3), r3.cross(&r1), r1.cross(&r2));
    let sum = c1 * m.x + c2 * m.y + c3 * m.z;
    Ok(sum / r1.dot(&c1))
}

/// Solves a system of order two, given by rows, that need not be symmetric.
///
/// # Errors
/// [`Error::Unstable`] unless its symmetric part is positive definite.
#[inline(always)]
pub fn solve2<T: Scalar>(k: [[T; 2]; 2], m: [T; 2]) -> Result<[T; 2], Error> {
    let [[k11, k12], [k21, k22]] = k;
    let mean = T::HALF * (k12 + k21);
    if !(k11 > T::zero() && k11 * k22 - mean * mean > T::zero()) {
        return Err(Error::Unstable);
    }
    let scale = T::one() / (k11 * k22 - k12 * k21);
    Ok([
        (k22 * m[0] - k12 * m[1]) * scale,
        (k11 * m[1] - k21 * m[0]) * scale,
    ])
}
