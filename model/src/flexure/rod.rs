//! A round rod.

use super::{Flexure, FlexureMaterial, check_length, check_ratio, critical};
use crate::{Error, JointStiffness, Quantity, Scalar};

/// Shorter rods, in diameters, shear as much as they bend: the formulas for slender beams do not hold.
const LENGTH_BY_DIAMETER: f32 = 5.0;

/// A round rod along the leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rod<T> {
    /// Its free length, m; at least five diameters.
    pub length_m: T,
    /// m.
    pub diameter_m: T,
}

impl<T: Scalar> Rod<T> {
    /// A compliant pivot: one rod, bent by up to `tilt` rad. EI/L, GJ/L, L/EA (Eq. 19 prints half of EI/L).
    ///
    /// ```
    /// use leg_model::{FlexureMaterial, Rod, Support, SupportKind};
    ///
    /// let nitinol = FlexureMaterial {
    ///     youngs_modulus_pa: 60e9,
    ///     shear_modulus_pa: 23e9,
    ///     strain_max: 0.01,
    /// };
    /// let rod = Rod {
    ///     length_m: 0.030,
    ///     diameter_m: 0.001,
    /// };
    /// let joint = rod.pivot(&nitinol, 0.5)?;
    /// let pivot = Support::new(SupportKind::Spherical, joint)?;
    /// assert!((pivot.joint().bending_nm_per_rad - 0.098_f64).abs() < 0.001);
    /// # Ok::<(), leg_model::Error>(())
    /// ```
    ///
    /// # Errors
    /// A part that is refused, a rod that is not slender, a strain beyond the material's.
    pub fn pivot(
        &self,
        material: &FlexureMaterial<T>,
        tilt: T,
    ) -> Result<JointStiffness<T>, Error> {
        let rod = self.flexure(material, tilt)?;
        Ok(JointStiffness {
            bending_nm_per_rad: rod.bending,
            torsion_nm_per_rad: rod.torsion,
            axial_compliance_m_per_n: T::one() / rod.axial,
        })
    }

    /// A universal joint of two pairs of rods, each pair `spacing_m` apart, bent by up to `tilt` rad about either axis.
    ///
    /// # Errors
    /// As [`Self::pivot`], and a spacing that is not positive.
    pub fn universal(
        &self,
        spacing_m: T,
        material: &FlexureMaterial<T>,
        tilt: T,
    ) -> Result<JointStiffness<T>, Error> {
        self.flexure(material, tilt)?.universal(spacing_m)
    }

    /// The load along one rod under which it buckles, N; see the module for its ends.
    #[must_use]
    pub fn critical_n(&self, material: &FlexureMaterial<T>) -> T {
        let bending = material.youngs_modulus_pa * self.second_moment() / self.length_m;
        critical(bending, self.length_m)
    }

    fn second_moment(&self) -> T {
        let square = self.diameter_m * self.diameter_m;
        T::PI * square * square / T::from(64.0)
    }

    /// I = πd⁴/64, J = 2I, A = πd²/4; the surface strain of a rod bent to a circle is dθ/2L.
    fn flexure(&self, material: &FlexureMaterial<T>, tilt: T) -> Result<Flexure<T>, Error> {
        let &Self {
            length_m: length,
            diameter_m: diameter,
        } = self;
        material.check()?;
        check_length(length, Quantity::FlexureLength)?;
        check_length(diameter, Quantity::FlexureThickness)?;
        check_ratio(
            length,
            diameter,
            LENGTH_BY_DIAMETER,
            Quantity::FlexureLength,
        )?;
        material.check_strain(T::HALF * diameter * tilt / length)?;
        let area = T::PI * diameter * diameter / T::from(4.0);
        let second_moment = self.second_moment();
        let bending = material.youngs_modulus_pa * second_moment / length;
        Ok(Flexure {
            bending,
            torsion: material.shear_modulus_pa * T::TWO * second_moment / length,
            lateral: T::from(12.0) * bending / (length * length),
            axial: material.youngs_modulus_pa * area / length,
        })
    }
}
