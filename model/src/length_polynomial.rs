//! The length of a tendon as a polynomial in half-tangent coordinates.

use crate::{HalfTangent, Scalar};

/// F = (l² − L²)/γ of one tendon: a polynomial of second degree in q, without a division, a root or an angle.
///
/// F = (|b − s|² + (L_upper − L_joint)² − L²)(1 + q²)/2 + 2(L_joint − q·s)(L_upper − q·b), with γ = 2/(1 + q²).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LengthPolynomial<T> {
    /// Twice the constant term.
    constant: T,
    x: T,
    y: T,
    /// Second derivatives.
    xx: T,
    xy: T,
    yy: T,
}

/// F and its gradient at a q.
pub(crate) struct PolynomialValue<T> {
    /// 2F.
    pub twice: T,
    pub gradient: [T; 2],
}

impl<T: Scalar> LengthPolynomial<T> {
    /// At L = 0; `square` is |b − s|² + (L_upper − L_joint)².
    #[inline(always)]
    pub fn new(
        [base_x, base_y]: [T; 2],
        [leg_x, leg_y]: [T; 2],
        upper: T,
        joint: T,
        square: T,
    ) -> Self {
        let twice = |value: T| value + value;
        Self {
            constant: square + twice(twice(joint * upper)),
            x: -twice(upper * leg_x + joint * base_x),
            y: -twice(upper * leg_y + joint * base_y),
            xx: square + twice(twice(leg_x * base_x)),
            xy: twice(leg_x * base_y + leg_y * base_x),
            yy: square + twice(twice(leg_y * base_y)),
        }
    }

    /// The same for another L², of which only these three coefficients know.
    #[inline(always)]
    pub fn with_length_square(&self, square: T) -> Self {
        Self {
            constant: self.constant - square,
            xx: self.xx - square,
            yy: self.yy - square,
            ..*self
        }
    }

    /// F follows from its own gradient (Euler's theorem), which spares the products of second degree.
    #[inline(always)]
    pub fn evaluate(&self, q: &HalfTangent<T>) -> PolynomialValue<T> {
        let gradient_x = self.x + self.xx * q.x + self.xy * q.y;
        let gradient_y = self.y + self.xy * q.x + self.yy * q.y;
        let twice = q.x * (self.x + gradient_x) + q.y * (self.y + gradient_y);
        PolynomialValue {
            twice: self.constant + twice,
            gradient: [gradient_x, gradient_y],
        }
    }
}
