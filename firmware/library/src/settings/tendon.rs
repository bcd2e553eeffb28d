//! A tendon as settings and requests describe it.

use heapless::Vec;
use leg_model::{CURVE_POINTS_MAX, CurvePoint, Error, Scalar, Tendon};
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// The numbers that describe a tendon, not yet validated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Schema)]
#[allow(
    clippy::large_enum_variant,
    reason = "a curve is kept in place: there is no allocation on the board"
)]
pub enum TendonParameters {
    /// Of constant stiffness, N/m.
    Constant(f32),
    /// With a curve through points.
    Curve(Vec<CurvePoint<f32>, CURVE_POINTS_MAX>),
}

impl TendonParameters {
    /// The numbers of a tendon, each rounded by `round`.
    #[must_use]
    pub fn from_tendon<T: Scalar>(tendon: &Tendon<T>, round: fn(T) -> f32) -> Self {
        match tendon {
            Tendon::Constant(constant) => Self::Constant(round(constant.stiffness_n_per_m())),
            Tendon::Curve(curve) => {
                Self::Curve(curve.points().map(|point| point.map(round)).collect())
            }
        }
    }

    /// The tendon, validated.
    ///
    /// # Errors
    /// What [`Tendon`] refuses.
    pub fn validated<T: Scalar>(&self) -> Result<Tendon<T>, Error> {
        match self {
            Self::Constant(stiffness) => Tendon::constant((*stiffness).into()),
            Self::Curve(points) => {
                let mut converted = Vec::<CurvePoint<T>, CURVE_POINTS_MAX>::new();
                for point in points {
                    // Both have the same capacity; to collect would panic beyond it.
                    let _ = converted.push(point.map(T::from));
                }
                Tendon::curve(&converted)
            }
        }
    }

    /// Three tendons, validated.
    ///
    /// # Errors
    /// What [`Tendon`] refuses.
    pub fn validated_all<T: Scalar>(tendons: &[Self; 3]) -> Result<[Tendon<T>; 3], Error> {
        let [a, b, c] = tendons;
        Ok([a.validated()?, b.validated()?, c.validated()?])
    }
}
