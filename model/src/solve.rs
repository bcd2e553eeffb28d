//! Small linear systems: two by two for the free axes, three by three for a ball joint.

use crate::{Error, Scalar};
use nalgebra::{Matrix3, SMatrix, Vector3};

/// Normal equations of a weighted least-squares problem with two unknowns, whose errors come doubled.
pub(crate) struct NormalEquations<T> {
    xx: T,
    xy: T,
    yy: T,
    twice_right_x: T,
    twice_right_y: T,
    /// Weighted sum of the squared doubled errors before the step.
    errors: T,
}

/// What normal equations answer.
pub(crate) struct LeastSquares<T> {
    pub x: T,
    pub y: T,
    /// Weighted sum of the squared doubled errors that the step leaves, to first order.
    pub remainder: T,
}

impl<T: Scalar> NormalEquations<T> {
    #[inline(always)]
    pub fn new() -> Self {
        let start = T::SUM_START;
        Self {
            xx: start,
            xy: start,
            yy: start,
            twice_right_x: start,
            twice_right_y: start,
            errors: start,
        }
    }

    /// Adds one equation: gradient·(x, y) = error.
    #[inline(always)]
    pub fn add(&mut self, gradient: [T; 2], twice_error: T, weight: T) {
        let [x, y] = gradient;
        let (weighted_x, weighted_y) = (weight * x, weight * y);
        self.xx += weighted_x * x;
        self.xy += weighted_x * y;
        self.yy += weighted_y * y;
        self.twice_right_x += weighted_x * twice_error;
        self.twice_right_y += weighted_y * twice_error;
        self.errors += weight * twice_error * twice_error;
    }

    #[inline(always)]
    pub fn solve(&self) -> Result<LeastSquares<T>, Error> {
        let determinant = self.xx * self.yy - self.xy * self.xy;
        // Also refuses NaN.
        if !(determinant > T::zero()) {
            return Err(Error::Singular);
        }
        let scale = T::HALF / determinant;
        let (right_x, right_y) = (self.twice_right_x, self.twice_right_y);
        let x = (self.yy * right_x - self.xy * right_y) * scale;
        let y = (self.xx * right_y - self.xy * right_x) * scale;
        let explained = right_x * x + right_y * y;
        let remainder = self.errors - (explained + explained);
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

    /// The sum of two.
    #[must_use]
    #[inline(always)]
    pub(crate) fn plus(&self, other: &Self) -> Self {
        self.plus_scaled(other, T::one())
    }

    /// The sum of this one and a multiple of another.
    #[must_use]
    #[inline(always)]
    pub(crate) fn plus_scaled(&self, other: &Self, scale: T) -> Self {
        Self {
            xx: self.xx + scale * other.xx,
            xy: self.xy + scale * other.xy,
            xz: self.xz + scale * other.xz,
            yy: self.yy + scale * other.yy,
            yz: self.yz + scale * other.yz,
            zz: self.zz + scale * other.zz,
        }
    }

    /// Adds k·aaᵀ with a column of a moment map.
    #[inline(always)]
    pub(crate) fn add_square<const N: usize>(
        &mut self,
        moment_map: &SMatrix<T, 3, N>,
        column: usize,
        k: T,
    ) {
        let a = [0, 1, 2].map(|row| moment_map[(row, column)]);
        let [kx, ky, kz] = a.map(|component| k * component);
        self.xx += kx * a[0];
        self.xy += kx * a[1];
        self.xz += kx * a[2];
        self.yy += ky * a[1];
        self.yz += ky * a[2];
        self.zz += kz * a[2];
    }

    /// The matrix times a vector.
    #[must_use]
    #[inline(always)]
    pub(crate) fn times(&self, v: &Vector3<T>) -> Vector3<T> {
        Vector3::new(
            self.xx * v.x + self.xy * v.y + self.xz * v.z,
            self.xy * v.x + self.yy * v.y + self.yz * v.z,
            self.xz * v.x + self.yz * v.y + self.zz * v.z,
        )
    }

    /// Solves K x = (m_x, m_y, 0), as the moment of weights has no part along z, by condensing z.
    ///
    /// # Errors
    /// [`Error::Unstable`] unless the matrix is positive definite.
    #[inline(always)]
    pub fn solve_horizontal(&self, m: [T; 2]) -> Result<Vector3<T>, Error> {
        if !(self.zz > T::zero()) {
            return Err(Error::Unstable);
        }
        let inverse = T::one() / self.zz;
        let (by_x, by_y) = (self.xz * inverse, self.yz * inverse);
        let xy = self.xy - by_x * self.yz;
        let [x, y] = solve2_symmetric(self.xx - by_x * self.xz, xy, self.yy - by_y * self.yz, m)?;
        Ok(Vector3::new(x, y, -(by_x * x + by_y * y)))
    }
}

/// Solves K x = m for a matrix that need not be symmetric, by cofactors.
///
/// # Errors
/// [`Error::Unstable`] unless the symmetric part of K is positive definite.
pub fn solve3<T: Scalar>(k: &Matrix3<T>, m: &Vector3<T>) -> Result<Vector3<T>, Error> {
    Symmetric3::symmetric_part(k).solve_horizontal([T::zero(); 2])?;
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

/// Solves a symmetric system of order two.
///
/// # Errors
/// [`Error::Unstable`] unless it is positive definite.
#[inline(always)]
pub(crate) fn solve2_symmetric<T: Scalar>(xx: T, xy: T, yy: T, m: [T; 2]) -> Result<[T; 2], Error> {
    let determinant = xx * yy - xy * xy;
    if !(xx > T::zero() && determinant > T::zero()) {
        return Err(Error::Unstable);
    }
    let scale = T::one() / determinant;
    Ok([
        (yy * m[0] - xy * m[1]) * scale,
        (xx * m[1] - xy * m[0]) * scale,
    ])
}
