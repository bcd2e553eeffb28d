//! One piece of a tendon's curve.

use super::CurvePoint;
use crate::Scalar;

/// Steps after which the search for a tension ends: more than halving alone needs.
const NEWTON_STEPS_MAX: u8 = 80;

/// The curve between two points, with s = T − start: δ = c₀ + c₁s + c₂s² + c₃s³.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece<T> {
    /// N.
    pub start: T,
    /// N.
    end: T,
    /// c₀ to c₃.
    pub elongation: [T; 4],
    /// ∫δ dT from zero to the start, J.
    complement: T,
}

impl<T: Scalar> Piece<T> {
    /// A piece that no tension and no elongation reaches.
    pub fn unused() -> Self {
        Self {
            start: T::MAX,
            end: T::MAX,
            elongation: [T::MAX, T::zero(), T::zero(), T::zero()],
            complement: T::zero(),
        }
    }

    /// Hermite's cubic from one point to the next.
    pub fn new(before: &CurvePoint<T>, after: &CurvePoint<T>, complement: T) -> Self {
        let rise = after.tension_n - before.tension_n;
        let average = (after.elongation_m - before.elongation_m) / rise;
        let first = T::one() / before.stiffness_n_per_m;
        let last = T::one() / after.stiffness_n_per_m;
        let bend = first + last - T::TWO * average;
        let square = (average - first - bend) / rise;
        Self {
            start: before.tension_n,
            end: after.tension_n,
            elongation: [before.elongation_m, first, square, bend / (rise * rise)],
            complement,
        }
    }

    /// Everything but the tensions is proportional to the elongation. An unused piece stays beyond every elongation.
    #[inline(always)]
    pub fn scale(&mut self, elongation_factor: T) {
        for coefficient in &mut self.elongation {
            *coefficient *= elongation_factor;
        }
        self.complement *= elongation_factor;
    }

    pub fn point_at(&self, tension: T) -> CurvePoint<T> {
        CurvePoint {
            tension_n: tension,
            elongation_m: self.elongation_at(tension),
            stiffness_n_per_m: T::one() / self.slope_at(tension),
        }
    }

    #[inline(always)]
    pub fn elongation_at(&self, tension: T) -> T {
        let s = tension - self.start;
        let [c0, c1, c2, c3] = self.elongation;
        c0 + s * (c1 + s * (c2 + s * c3))
    }

    #[inline(always)]
    pub fn slope_at(&self, tension: T) -> T {
        let s = tension - self.start;
        let [_, c1, c2, c3] = self.elongation;
        c1 + s * (c2 + c2 + T::from(3.0) * c3 * s)
    }

    /// ∫δ dT from zero to a tension, J.
    pub fn complement_at(&self, tension: T) -> T {
        let s = tension - self.start;
        let [c0, c1, c2, c3] = self.elongation;
        let [c1, c2, c3] = [c1 / T::from(2.0), c2 / T::from(3.0), c3 / T::from(4.0)];
        self.complement + s * (c0 + s * (c1 + s * (c2 + s * c3)))
    }

    /// The tension at an elongation of this piece, by Newton's steps between bounds that close in.
    pub fn tension_at(&self, elongation: T) -> T {
        let (mut low, mut high) = (self.start, self.end);
        let mut tension = self.start + (elongation - self.elongation[0]) / self.elongation[1];
        for _ in 0..NEWTON_STEPS_MAX {
            if !(tension > low && tension < high) {
                tension = T::HALF * (low + high);
                // Two neighbours, between which rounding would have it go to and fro.
                if !(tension > low && tension < high) {
                    break;
                }
            }
            let error = self.elongation_at(tension) - elongation;
            if error > T::zero() {
                high = tension;
            } else {
                low = tension;
            }
            let next = tension - error / self.slope_at(tension);
            if next == tension {
                break;
            }
            tension = next;
        }
        tension
    }
}
