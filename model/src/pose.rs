//! Poses: the direction of the leg and its twist.
//!
//! The literature's tilt-and-torsion angles (Bonev) name a pose: **azimuth** φ is where the leg leans to,
//! **tilt** θ how far, **torsion** τ its twist about itself, with R = Rod((sin φ, −cos φ, 0), θ)·Rz(τ). (The paper
//! calls the azimuth "tilt angle σ" and the tilt "torsion angle θ".) At θ = 0 the azimuth means nothing, so the
//! model works with the leg's direction, a unit vector, which is smooth everywhere and needs no trigonometry.

use crate::{Error, Quantity, Reason, Scalar};
use nalgebra::{Matrix3, Vector3};

/// Unit vector from the joint centre to the tip, in frame {A}; it points below the horizon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction<T> {
    pub(crate) x: T,
    pub(crate) y: T,
    pub(crate) z: T,
}

impl<T: Scalar> Direction<T> {
    /// Straight down.
    #[must_use]
    pub fn straight_down() -> Self {
        Self {
            x: T::zero(),
            y: T::zero(),
            z: -T::one(),
        }
    }

    /// The direction with the horizontal components `x` and `y`.
    ///
    /// # Errors
    /// [`Quantity::Direction`] out of range unless x² + y² < 1.
    #[inline(always)]
    pub fn from_xy(x: T, y: T) -> Result<Self, Error> {
        let z_squared = T::one() - x * x - y * y;
        if z_squared > T::zero() {
            let z = -z_squared.sqrt();
            Ok(Self { x, y, z })
        } else {
            Err(Error::refused(Quantity::Direction, Reason::OutOfRange))
        }
    }

    /// The direction at an azimuth and a tilt in rad. A negative tilt is the opposite azimuth.
    ///
    /// # Errors
    /// Angles that are not finite, a tilt beyond 60° and an azimuth beyond ten turns are refused.
    pub fn from_angles(azimuth: T, tilt: T) -> Result<Self, Error> {
        check_angle(azimuth, T::AZIMUTH_MAX_RAD, Quantity::Azimuth)?;
        check_angle(tilt, T::TILT_MAX_RAD, Quantity::Tilt)?;
        let ((sin_azimuth, cos_azimuth), (sin_tilt, cos_tilt)) =
            (azimuth.sin_cos(), tilt.sin_cos());
        Ok(Self {
            x: sin_tilt * cos_azimuth,
            y: sin_tilt * sin_azimuth,
            z: -cos_tilt,
        })
    }

    /// The unit vector.
    #[must_use]
    pub fn vector(&self) -> Vector3<T> {
        Vector3::new(self.x, self.y, self.z)
    }

    /// The same direction in half-tangent coordinates.
    #[must_use]
    #[inline(always)]
    pub fn half_tangent(&self) -> HalfTangent<T> {
        let scale = T::one() / self.gain();
        HalfTangent {
            x: self.x * scale,
            y: self.y * scale,
        }
    }

    /// γ = 1 + cos θ.
    #[inline(always)]
    pub(crate) fn gain(&self) -> T {
        T::one() - self.z
    }

    /// Rotation that takes (0, 0, −1) here without torsion: Eq. (1) at the axis (sin φ, −cos φ, 0), corrected.
    #[must_use]
    pub fn rotation(&self) -> Matrix3<T> {
        let &Self { x, y, z } = self;
        let HalfTangent { x: qx, y: qy } = self.half_tangent();
        let one = T::one();
        #[rustfmt::skip]
        let rotation = Matrix3::new(
            one - x * qx, -x * qy, -x,
            -x * qy, one - y * qy, -y,
            x, y, -z,
        );
        rotation
    }
}

fn check_angle<T: Scalar>(angle: T, limit: T, quantity: Quantity) -> Result<(), Error> {
    if !angle.is_finite() {
        return Err(Error::refused(quantity, Reason::NotFinite));
    }
    if angle.abs() > limit {
        return Err(Error::refused(quantity, Reason::OutOfRange));
    }
    Ok(())
}

/// A direction as q = tan(θ/2)·(cos φ, sin φ): its stereographic projection.
///
/// In these coordinates the mechanism is rational. The rotation without torsion is R v = v* + (v·q*)γq* with
/// v* = (v_x, v_y, −v_z) and q* = (q_x, q_y, −1) and γ = 2/(1 + q²): two reflections.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfTangent<T> {
    pub(crate) x: T,
    pub(crate) y: T,
}

impl<T: Scalar> HalfTangent<T> {
    /// The point with these coordinates; their squares add up to less than one below the horizon.
    #[must_use]
    #[inline(always)]
    pub const fn new(x: T, y: T) -> Self {
        Self { x, y }
    }

    /// Both coordinates.
    #[must_use]
    #[inline(always)]
    pub const fn xy(&self) -> [T; 2] {
        [self.x, self.y]
    }

    /// The same direction as a unit vector.
    #[must_use]
    #[inline(always)]
    pub fn direction(&self) -> Direction<T> {
        let gain = T::one() / self.inverse_gain();
        Direction {
            x: gain * self.x,
            y: gain * self.y,
            z: T::one() - gain,
        }
    }

    /// 1/γ = (1 + q²)/2.
    #[inline(always)]
    pub(crate) fn inverse_gain(&self) -> T {
        T::HALF * (T::one() + self.x * self.x + self.y * self.y)
    }
}

/// Numerator and denominator of tan τ on a universal joint.
#[inline(always)]
fn universal_tangent<T: Scalar>(q: &HalfTangent<T>) -> (T, T) {
    (-T::TWO * q.x * q.y, T::one() + q.y * q.y - q.x * q.x)
}

/// Derivative of the torsion on a universal joint by q_x and q_y.
#[inline(always)]
pub(crate) fn universal_torsion_gradient<T: Scalar>(q: &HalfTangent<T>) -> [T; 2] {
    let (sin, cos) = universal_tangent(q);
    let scale = T::TWO / (sin * sin + cos * cos);
    [
        scale * (sin * q.x - cos * q.y),
        -scale * (cos * q.x + sin * q.y),
    ]
}

/// Rotation of the leg about its own axis, kept as sine and cosine of the torsion τ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist<T> {
    pub(crate) sin: T,
    pub(crate) cos: T,
}

impl<T: Scalar> Twist<T> {
    /// No torsion.
    #[must_use]
    pub fn none() -> Self {
        Self {
            sin: T::zero(),
            cos: T::one(),
        }
    }

    /// A torsion in rad.
    #[must_use]
    pub fn from_torsion(torsion: T) -> Self {
        let (sin, cos) = torsion.sin_cos();
        Self { sin, cos }
    }

    /// The twist that a universal joint gives a leg: with R = Rx(α)Ry(β), tan τ = sin α sin β/(cos α + cos β),
    /// which is −2q_x q_y/(1 + q_y² − q_x²).
    #[must_use]
    #[inline(always)]
    pub fn universal(q: &HalfTangent<T>) -> Self {
        let (sin, cos) = universal_tangent(q);
        let scale = T::one() / (sin * sin + cos * cos).sqrt();
        Self {
            sin: sin * scale,
            cos: cos * scale,
        }
    }

    /// Both twists, one after the other; the order does not matter.
    #[must_use]
    pub fn composed(&self, other: &Self) -> Self {
        let [cos, sin] = self.apply([other.cos, other.sin]);
        Self { sin, cos }
    }

    /// The torsion τ in rad, positive about the leg's plate normal (upwards).
    #[must_use]
    pub fn torsion(&self) -> T {
        self.sin.atan2(self.cos)
    }

    /// The point (x, y) of the leg's plate after the twist.
    #[inline(always)]
    pub(crate) fn apply(&self, [x, y]: [T; 2]) -> [T; 2] {
        [self.cos * x - self.sin * y, self.sin * x + self.cos * y]
    }
}
