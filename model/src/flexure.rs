//! Flexures: the stiffness of elastic joints from geometry and material (rows c to i of Fig. 2).
//!
//! A pivot (row c) is one rod. A universal joint of flexures (rows d to i) has two pairs in series, one for each axis:
//! the two flexures of a pair stand side by side on their axis, `spacing_m` apart, along the leg. So a pair bends
//! easily about its axis, and resists torsion by bending its flexures sideways.
//!
//! The formulas are those of small strain and no load along the flexure. A load along it makes it softer, by about its
//! part of the critical load. That load is reported for a flexure whose ends cannot turn (the base holds one, the tendons
//! the other) but can move aside: π²EI/L², as if it were pinned at both ends.

mod leaf;
mod notch;
mod rod;

pub use leaf::Leaf;
pub use notch::Notch;
pub use rod::Rod;

use crate::range::{LENGTH_MAX, check_positive};
use crate::{Error, JointStiffness, Quantity, Reason, Scalar};

/// Stiffest material, Pa: above diamond.
const MODULUS_MAX: f32 = 2e12;

/// What a flexure is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlexureMaterial<T> {
    /// E, Pa.
    pub youngs_modulus_pa: T,
    /// G, Pa.
    pub shear_modulus_pa: T,
    /// The strain to which its stress is linear, as a part of one. Beyond it there is no E: superelastic
    /// nickel-titanium, say, springs back from 6 % but is linear to about 1 %.
    pub strain_max: T,
}

impl<T: Scalar> FlexureMaterial<T> {
    fn check(&self) -> Result<(), Error> {
        check_positive(self.youngs_modulus_pa, MODULUS_MAX, Quantity::YoungsModulus)?;
        check_positive(self.shear_modulus_pa, MODULUS_MAX, Quantity::ShearModulus)?;
        // E = 2G(1 + ν): ν would be at most -1/2, which no material of flexures has.
        if self.shear_modulus_pa >= self.youngs_modulus_pa {
            return Err(Error::refused(Quantity::ShearModulus, Reason::OutOfRange));
        }
        check_positive(self.strain_max, 1.0, Quantity::StrainLimit)
    }

    /// Refuses a strain to which the material is not linear.
    fn check_strain(&self, strain: T) -> Result<(), Error> {
        if strain <= self.strain_max {
            Ok(())
        } else {
            Err(Error::refused(Quantity::StrainLimit, Reason::Exceeded))
        }
    }
}

/// The stiffnesses of one flexure between its two ends.
struct Flexure<T> {
    /// Against bending about its axis, N·m/rad.
    bending: T,
    /// Against torsion, N·m/rad.
    torsion: T,
    /// Against a sideways shift of one end, which stays parallel to the other, N/m.
    lateral: T,
    /// Along it, N/m.
    axial: T,
}

impl<T: Scalar> Flexure<T> {
    /// Two pairs in series, the flexures of a pair `spacing` apart.
    fn universal(&self, spacing: T) -> Result<JointStiffness<T>, Error> {
        check_length(spacing, Quantity::FlexureSpacing)?;
        let arm = T::HALF * spacing;
        Ok(JointStiffness {
            bending_nm_per_rad: T::TWO * self.bending,
            torsion_nm_per_rad: self.torsion + self.lateral * arm * arm,
            axial_compliance_m_per_n: T::one() / self.axial,
        })
    }
}

/// π²EI/L², N.
fn critical<T: Scalar>(bending_nm_per_rad: T, length_m: T) -> T {
    T::PI * T::PI * bending_nm_per_rad / length_m
}

fn check_length<T: Scalar>(length: T, quantity: Quantity) -> Result<(), Error> {
    check_positive(length, LENGTH_MAX, quantity)
}

/// Refuses a quantity that is less than `ratio_min` times another: a formula for slender flexures would not hold.
fn check_ratio<T: Scalar>(
    value: T,
    other: T,
    ratio_min: f32,
    quantity: Quantity,
) -> Result<(), Error> {
    if value >= T::from(ratio_min) * other {
        Ok(())
    } else {
        Err(Error::refused(quantity, Reason::NotSlender))
    }
}
