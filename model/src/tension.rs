//! Tension distribution: the tensions that balance a load, and the pretension they may carry.

use crate::range::{TENSION_MAX, check_magnitude, check_not_negative};
use crate::{Error, FreePlane, Quantity, Reason, Scalar};
use nalgebra::{SMatrix, SVector, Vector3};

/// The tensions that are allowed, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TensionBounds<T> {
    /// (f_max + f_min)/2.
    centre: T,
    /// (f_max − f_min)/2.
    half_width: T,
}

impl<T: Scalar> TensionBounds<T> {
    /// Lowest and highest tension allowed, N.
    ///
    /// # Errors
    /// Bounds that are not finite or above 10⁷ N, a negative minimum, a minimum above the maximum.
    pub fn new(f_min_n: T, f_max_n: T) -> Result<Self, Error> {
        check_not_negative(f_min_n, TENSION_MAX, Quantity::TensionMin)?;
        check_magnitude(f_max_n, TENSION_MAX, Quantity::TensionMax)?;
        if f_min_n > f_max_n {
            return Err(Error::refused(Quantity::TensionMin, Reason::AboveMax));
        }
        Ok(Self {
            centre: T::HALF * f_max_n + T::HALF * f_min_n,
            half_width: T::HALF * f_max_n - T::HALF * f_min_n,
        })
    }
}

/// Which bound on the tensions ends the range of pretensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[cfg_attr(feature = "schema", derive(postcard_schema::Schema))]
pub enum Bound {
    /// The lowest tension allowed, f_min.
    #[cfg_attr(feature = "serde", serde(rename = "floor"))]
    Min,
    /// The highest tension allowed, f_max.
    #[cfg_attr(feature = "serde", serde(rename = "ceiling"))]
    Max,
}

/// The tendon and the bound that end the range of pretensions on one side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(postcard_schema::Schema))]
pub struct Limit {
    /// Tendon, counted from 1.
    pub tendon: u8,
    /// The bound that it meets.
    pub bound: Bound,
}

/// All tensions that balance a load: f = f_p + pretension·√N·h.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distribution<T, const N: usize> {
    /// f_p: the smallest tensions (in the sum of squares) that balance the load, N. They may be negative.
    pub particular: SVector<T, N>,
    /// √N·h: tensions per pretension. They load no free axis, and their squares add up to N, so that the
    /// pretension is the tension in each tendon at the vertical of a symmetric rig.
    pub per_pretension: SVector<T, N>,
    /// Lowest pretension that keeps every tension inside its bounds, N.
    pub pretension_min: T,
    /// Highest pretension that keeps every tension inside its bounds, N. Below the lowest when there is none.
    pub pretension_max: T,
}

impl<T: Scalar, const N: usize> Distribution<T, N> {
    /// Tensions at a pretension, N. They balance the load whether or not they keep the bounds.
    #[must_use]
    #[inline(always)]
    pub fn tensions(&self, pretension: T) -> SVector<T, N> {
        SVector::from_fn(|i, _| self.particular[i] + pretension * self.per_pretension[i])
    }

    /// Whether any pretension keeps every tension inside its bounds.
    #[must_use]
    #[inline(always)]
    pub fn feasible(&self) -> bool {
        self.pretension_min <= self.pretension_max
    }

    /// The tendons and bounds that end the range of pretensions below and above.
    #[must_use]
    pub fn limits(&self, bounds: &TensionBounds<T>) -> [Limit; 2] {
        let (mut lowest, mut highest) = (-T::MAX, T::MAX);
        let none = Limit {
            tendon: 0,
            bound: Bound::Min,
        };
        let mut limits = [none; 2];
        for (tendon, i) in (1..).zip(0..N) {
            let range = pretension_range(self.particular[i], self.per_pretension[i], bounds);
            let rising = self.per_pretension[i] > T::zero();
            if range.0 > lowest {
                lowest = range.0;
                limits[0] = Limit {
                    tendon,
                    bound: if rising { Bound::Min } else { Bound::Max },
                };
            }
            if range.1 < highest {
                highest = range.1;
                limits[1] = Limit {
                    tendon,
                    bound: if rising { Bound::Max } else { Bound::Min },
                };
            }
        }
        limits
    }
}

/// Distributes a load over the tendons: Pᵀ(A f + M) = 0 with every f between its bounds (Eq. 5 on the free axes).
///
/// The three rows of A are never solved for three tensions: they depend on each other at the vertical and in every
/// plane of symmetry.
///
/// `load_moment` may be anything up to 10¹² N·m, far above what a [`Load`](crate::Load) or measured tensions give.
///
/// ```
/// use leg_model::{Direction, FreePlane, Load, Rig, RigParameters, TensionBounds, distribute,
///     inverse_kinematics};
///
/// let rig = Rig::new(&RigParameters::<f64, 3>::TABLE_1)?;
/// let leaning = Direction::from_angles(0.0, 0.3)?;
/// let a = inverse_kinematics(rig.geometry(), &leaning)?.moment_map;
/// let plane = FreePlane::torsion_free(&leaning);
/// let moment = Load::new(&rig, 1.0)?.moment(&leaning);
/// let found = distribute(&a, &plane, &moment, &TensionBounds::new(8.0, 150.0)?)?;
/// assert!(found.feasible());
/// // Balanced about both free axes at any pretension.
/// let rest = plane.project(&(a * found.tensions(70.0) + moment));
/// assert!(rest.iter().all(|moment| moment.abs() < 1e-9));
/// # Ok::<(), leg_model::Error>(())
/// ```
///
/// # Errors
/// [`Error::Singular`] if the load moment is not finite, if the tendons cannot turn the leg about both free axes, or
/// if one of them takes no part in the pretension.
#[inline(always)]
pub fn distribute<T: Scalar, const N: usize>(
    moment_map: &SMatrix<T, 3, N>,
    plane: &FreePlane<T>,
    load_moment: &Vector3<T>,
    bounds: &TensionBounds<T>,
) -> Result<Distribution<T, N>, Error> {
    let rows = Rows::new(moment_map, plane);
    let (particular, internal) = rows.split(plane.project(load_moment));
    let (mut sum, mut squares, mut product) = (T::SUM_START, T::SUM_START, T::one());
    for &component in internal.iter() {
        sum += component;
        squares += component * component;
        product *= component;
    }
    // A missing rank makes the product zero or NaN. A moment that is not finite enters every tension, and zero times
    // that is NaN. One comparison refuses both.
    let nothing = particular[0] * T::zero();
    if !(product * product > nothing) {
        return Err(Error::Singular);
    }
    let length = (T::count::<N>() / squares).sqrt();
    let scale = if sum < T::zero() { -length } else { length };
    let per_pretension = SVector::from_fn(|i, _| internal[i] * scale);
    let (mut pretension_min, mut pretension_max) =
        pretension_range(particular[0], per_pretension[0], bounds);
    for i in 1..N {
        let (low, high) = pretension_range(particular[i], per_pretension[i], bounds);
        pretension_min = if low > pretension_min {
            low
        } else {
            pretension_min
        };
        pretension_max = if high < pretension_max {
            high
        } else {
            pretension_max
        };
    }
    Ok(Distribution {
        particular,
        per_pretension,
        pretension_min,
        pretension_max,
    })
}

/// Pretensions between which one tension keeps its bounds, whether it rises or falls with the pretension.
#[inline(always)]
fn pretension_range<T: Scalar>(
    particular: T,
    per_pretension: T,
    bounds: &TensionBounds<T>,
) -> (T, T) {
    let scale = T::one() / per_pretension;
    let centre = (bounds.centre - particular) * scale;
    let half_width = (bounds.half_width * scale).abs();
    (centre - half_width, centre + half_width)
}

/// The two rows of PᵀA.
struct Rows<T, const N: usize> {
    x: SVector<T, N>,
    y: SVector<T, N>,
}

impl<T: Scalar, const N: usize> Rows<T, N> {
    #[inline(always)]
    fn new(moment_map: &SMatrix<T, 3, N>, plane: &FreePlane<T>) -> Self {
        Self {
            x: SVector::from_fn(|i, _| moment_map[(0, i)] + plane.rho_x * moment_map[(2, i)]),
            y: SVector::from_fn(|i, _| moment_map[(1, i)] + plane.rho_y * moment_map[(2, i)]),
        }
    }

    /// The smallest f with PᵀA f = −w, and a vector of the null space of PᵀA.
    #[inline(always)]
    fn split(&self, w: [T; 2]) -> (SVector<T, N>, SVector<T, N>) {
        if N == 3 {
            self.split_three(w)
        } else {
            self.split_many(w)
        }
    }

    /// With three tendons the null space is the line h = x × y, |h|² is the determinant of the normal equations, and
    /// f_p = h × (w_x y − w_y x)/|h|².
    #[inline(always)]
    fn split_three(&self, w: [T; 2]) -> (SVector<T, N>, SVector<T, N>) {
        let three = |v: &SVector<T, N>| [v[0], v[1], v[2]];
        let (x, y) = (three(&self.x), three(&self.y));
        let h = cross(x, y);
        let scale = T::one() / (h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
        let turned = [0, 1, 2].map(|i| (w[0] * y[i] - w[1] * x[i]) * scale);
        let particular = cross(h, turned);
        (
            SVector::from_fn(|i, _| particular[i]),
            SVector::from_fn(|i, _| h[i]),
        )
    }

    /// With more tendons: the pseudo-inverse by its normal equations, and the part of (1, …, 1) in the null space.
    fn split_many(&self, w: [T; 2]) -> (SVector<T, N>, SVector<T, N>) {
        let (xx, xy, yy) = (
            self.x.dot(&self.x),
            self.x.dot(&self.y),
            self.y.dot(&self.y),
        );
        let scale = T::one() / (xx * yy - xy * xy);
        let in_row_space = |[a, b]: [T; 2]| {
            let (along_x, along_y) = ((yy * a - xy * b) * scale, (xx * b - xy * a) * scale);
            self.x * along_x + self.y * along_y
        };
        let ones = SVector::repeat(T::one());
        let internal = ones - in_row_space([self.x.sum(), self.y.sum()]);
        (-in_row_space(w), internal)
    }
}

#[inline(always)]
fn cross<T: Scalar>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
