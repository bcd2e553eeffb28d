//! The number type: f32 on the board, f64 for the proof on the host.

use core::fmt::Debug;
use core::ops::Neg;
use num_traits::NumAssign;

/// A floating-point number of the model.
///
/// The basic operations and `sqrt` are those of IEEE 754, and everything else is computed from them, so a type
/// gives the same bits on every machine. Nothing here calls the platform's mathematics or fuses operations.
pub trait Scalar:
    nalgebra::Scalar + NumAssign + Neg<Output = Self> + Copy + Debug + PartialOrd + From<f32>
{
    /// 1/2.
    const HALF: Self;
    /// 2.
    const TWO: Self;
    /// −0, from which sums start: unlike +0 it leaves every number as it is, so the first addition costs nothing.
    const SUM_START: Self;
    /// π.
    const PI: Self;
    /// 1/√3.
    const FRAC_1_SQRT_3: Self;
    /// The greatest finite number.
    const MAX: Self;
    /// The greatest tilt that the model serves: 60°, in rad.
    const TILT_MAX_RAD: Self;
    /// The greatest |azimuth| that the model serves: ten turns, in rad.
    const AZIMUTH_MAX_RAD: Self;
    /// Anchors lie on one line when the determinant of their spread is not above this part of its trace squared.
    const COLLINEAR: Self;
    /// Forward kinematics has converged when a step (in components of the leg's direction) is not longer than
    /// this: the next one, which convergence of second order makes about as long as the square, would be lost
    /// in rounding.
    const DIRECTION_STEP: Self;
    /// The first step of the search for the torsion on a ball joint, rad.
    const TORSION_START_RAD: Self;
    /// That search has converged when a step is not longer than this, rad: the next one, about the product of the last
    /// two, would be lost in rounding.
    const TORSION_STEP_RAD: Self;

    /// Square root, correctly rounded.
    fn sqrt(self) -> Self;
    /// Sine and cosine of an angle in rad.
    fn sin_cos(self) -> (Self, Self);
    /// Angle of the point (x, y) = (`x`, `self`), rad.
    fn atan2(self, x: Self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// Whether it is neither infinite nor NaN.
    fn is_finite(self) -> bool;
    /// The whole number towards zero, within those of `i32`; zero for what is no number.
    fn whole(self) -> i32;
    /// `N` as a number, at compile time.
    fn count<const N: usize>() -> Self;
}

macro_rules! scalar {
    ($t:ident, $sqrt:path, $sin_cos:path, $atan2:path, direction: $direction:literal, torsion: $torsion:literal) => {
        impl Scalar for $t {
            const HALF: Self = 0.5;
            const TWO: Self = 2.0;
            const SUM_START: Self = -0.0;
            const PI: Self = core::$t::consts::PI;
            const FRAC_1_SQRT_3: Self = 0.577_350_269_189_625_8;
            const MAX: Self = $t::MAX;
            const TILT_MAX_RAD: Self = core::$t::consts::FRAC_PI_3;
            const AZIMUTH_MAX_RAD: Self = 20.0 * core::$t::consts::PI;
            const COLLINEAR: Self = 1e-4;
            const DIRECTION_STEP: Self = $direction;
            const TORSION_START_RAD: Self = 1e-3;
            const TORSION_STEP_RAD: Self = $torsion;

            #[inline(always)]
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                $sin_cos(self)
            }
            #[inline(always)]
            fn atan2(self, x: Self) -> Self {
                $atan2(self, x)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                $t::abs(self)
            }
            #[inline(always)]
            fn is_finite(self) -> bool {
                $t::is_finite(self)
            }
            #[inline(always)]
            fn whole(self) -> i32 {
                self as i32
            }
            #[inline(always)]
            fn count<const N: usize>() -> Self {
                const { N as $t }
            }
        }
    };
}

scalar!(f32, crate::sqrt::sqrt_f32, crate::trigonometry::sin_cos_f32, libm::atan2f, direction: 5e-4, torsion: 1e-6);
scalar!(f64, libm::sqrt, libm::sincos, libm::atan2, direction: 1e-9, torsion: 1e-9);
