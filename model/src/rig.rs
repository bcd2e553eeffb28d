//! The mechanism's geometry and masses, and their validation.

use crate::range::{
    GRAVITY_MAX, LENGTH_MAX, MASS_MAX, check_magnitude, check_not_negative, check_positive,
};
use crate::{Error, Geometry, Quantity, Reason, Scalar};

/// The numbers that describe a mechanism with `N` tendons, not yet validated. SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(
        serialize = "T: serde::Serialize, [[T; 2]; N]: serde::Serialize",
        deserialize = "T: serde::Deserialize<'de>, [[T; 2]; N]: serde::Deserialize<'de>"
    ))
)]
#[cfg_attr(feature = "schema", derive(postcard_schema::Schema))]
pub struct RigParameters<T, const N: usize> {
    /// Where the tendons are fixed on the base plate (b_i): (x, y) in {A}'s axes, m.
    pub base_anchors_m: [[T; 2]; N],
    /// Where the tendons are fixed on the leg's plate (s_i): (x, y) in the leg's axes, m.
    pub leg_anchors_m: [[T; 2]; N],
    /// From the base plate down to the joint centre (L_upper), m. Zero is allowed.
    pub upper_length_m: T,
    /// From the joint centre down to the leg's plate (L_joint), m.
    pub joint_length_m: T,
    /// From the leg's plate down to the tip (L_leg), m.
    pub leg_length_m: T,
    /// Mass of the leg without its payload, kg. Zero is allowed.
    pub leg_mass_kg: T,
    /// From the joint centre down to the leg's centroid, which lies on its axis, m. Zero is allowed.
    pub leg_centroid_m: T,
    /// Gravity along −z, m/s². Zero is allowed.
    pub gravity_m_per_s2: T,
}

impl<T, const N: usize> RigParameters<T, N> {
    /// The same numbers in another type, each by `convert`.
    #[must_use]
    pub fn map<U>(self, mut convert: impl FnMut(T) -> U) -> RigParameters<U, N> {
        RigParameters {
            base_anchors_m: self.base_anchors_m.map(|point| point.map(&mut convert)),
            leg_anchors_m: self.leg_anchors_m.map(|point| point.map(&mut convert)),
            upper_length_m: convert(self.upper_length_m),
            joint_length_m: convert(self.joint_length_m),
            leg_length_m: convert(self.leg_length_m),
            leg_mass_kg: convert(self.leg_mass_kg),
            leg_centroid_m: convert(self.leg_centroid_m),
            gravity_m_per_s2: convert(self.gravity_m_per_s2),
        }
    }
}

macro_rules! table_1 {
    ($($t:ty),*) => {$(
        impl RigParameters<$t, 3> {
            /// The rig of the paper's Table 1, with the leg's mass from the note in Fig. 9.
            ///
            /// The anchors lie on rings of 24 mm at 0°, 120° and 240°; the printed 20.8 mm is 24·sin 60°.
            pub const TABLE_1: Self = {
                let ring = [
                    [0.024, 0.0],
                    [-0.012, 0.020_784_609_690_826_527],
                    [-0.012, -0.020_784_609_690_826_527],
                ];
                Self {
                    base_anchors_m: ring,
                    leg_anchors_m: ring,
                    upper_length_m: 0.006,
                    joint_length_m: 0.029,
                    leg_length_m: 0.190,
                    leg_mass_kg: 1.5,
                    leg_centroid_m: 0.091,
                    gravity_m_per_s2: 9.81,
                }
            };
        }
    )*};
}

table_1!(f32, f64);

/// A mechanism whose parameters have been validated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rig<T, const N: usize> {
    pub(crate) geometry: Geometry<T, N>,
    /// From the joint centre to the tip, L = L_joint + L_leg, m.
    pub(crate) tip: T,
    /// Weight of the leg times the distance of its centroid, N·m.
    pub(crate) leg_moment: T,
    pub(crate) gravity: T,
    /// N.
    pub(crate) leg_weight: T,
}

impl<T: Scalar, const N: usize> Rig<T, N> {
    /// Validates a mechanism.
    ///
    /// # Errors
    /// The first quantity that is not finite, not positive (or negative, where zero is allowed) or out of range
    /// (lengths to 100 m, 10⁶ kg, 10³ m/s²), and anchors that lie on one line or within 10 µm.
    pub fn new(parameters: &RigParameters<T, N>) -> Result<Self, Error> {
        const { assert!(N >= 3, "two free axes need at least three tendons") };
        let p = parameters;
        check_anchors(&p.base_anchors_m, Quantity::BaseAnchors)?;
        check_anchors(&p.leg_anchors_m, Quantity::LegAnchors)?;
        check_not_negative(p.upper_length_m, LENGTH_MAX, Quantity::UpperLength)?;
        check_positive(p.joint_length_m, LENGTH_MAX, Quantity::JointLength)?;
        check_positive(p.leg_length_m, LENGTH_MAX, Quantity::LegLength)?;
        check_not_negative(p.leg_mass_kg, MASS_MAX, Quantity::LegMass)?;
        check_not_negative(p.leg_centroid_m, LENGTH_MAX, Quantity::LegCentroid)?;
        check_not_negative(p.gravity_m_per_s2, GRAVITY_MAX, Quantity::Gravity)?;
        Ok(Self {
            geometry: Geometry::new(
                &p.base_anchors_m,
                &p.leg_anchors_m,
                p.upper_length_m,
                p.joint_length_m,
            ),
            tip: p.joint_length_m + p.leg_length_m,
            leg_weight: p.leg_mass_kg * p.gravity_m_per_s2,
            leg_moment: p.leg_mass_kg * p.gravity_m_per_s2 * p.leg_centroid_m,
            gravity: p.gravity_m_per_s2,
        })
    }

    /// Where the tendons pull.
    #[must_use]
    #[inline(always)]
    pub fn geometry(&self) -> &Geometry<T, N> {
        &self.geometry
    }

    /// From the joint centre to the tip, L = L_joint + L_leg, m.
    #[must_use]
    #[inline(always)]
    pub fn tip_m(&self) -> T {
        self.tip
    }
}

fn check_anchors<T: Scalar, const N: usize>(
    anchors: &[[T; 2]; N],
    quantity: Quantity,
) -> Result<(), Error> {
    for &[x, y] in anchors {
        check_magnitude(x, LENGTH_MAX, quantity)?;
        check_magnitude(y, LENGTH_MAX, quantity)?;
    }
    if collinear(anchors) {
        return Err(Error::refused(quantity, Reason::Collinear));
    }
    Ok(())
}

/// Whether the anchors lie on one line (or nearly in one point): the smaller principal moment of their spread
/// vanishes beside the larger.
fn collinear<T: Scalar, const N: usize>(anchors: &[[T; 2]; N]) -> bool {
    let (mut count, mut sum_x, mut sum_y) = (T::zero(), T::zero(), T::zero());
    for &[x, y] in anchors {
        (count, sum_x, sum_y) = (count + T::one(), sum_x + x, sum_y + y);
    }
    let (mut xx, mut xy, mut yy) = (T::zero(), T::zero(), T::zero());
    for &[x, y] in anchors {
        let (dx, dy) = (x - sum_x / count, y - sum_y / count);
        (xx, xy, yy) = (xx + dx * dx, xy + dx * dy, yy + dy * dy);
    }
    let trace = xx + yy;
    let determinant = xx * yy - xy * xy;
    let smallest = T::from(1e-5 * 1e-5);
    !(trace > smallest && determinant > T::COLLINEAR * trace * trace)
}
