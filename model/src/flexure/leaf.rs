//! A leaf spring.

use super::{Flexure, FlexureMaterial, check_length, check_ratio, critical};
use crate::{Error, JointStiffness, Quantity, Scalar};

/// Shorter leaves, in thicknesses, are no slender beams.
const LENGTH_BY_THICKNESS: f32 = 10.0;

/// Narrower leaves, in thicknesses, are no leaves: they bend about their other axis as well.
const WIDTH_BY_THICKNESS: f32 = 5.0;

/// A flat spring along the leg, its width along the axis about which it bends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leaf<T> {
    /// Its free length, m; at least ten thicknesses.
    pub length_m: T,
    /// m; at least five thicknesses.
    pub width_m: T,
    /// m.
    pub thickness_m: T,
}

impl<T: Scalar> Leaf<T> {
    /// A universal joint of two pairs of leaves, each pair `spacing_m` apart between the leaves' middles, bent by up to
    /// `tilt` rad about either axis.
    ///
    /// # Errors
    /// A part that is refused, a leaf that is not slender, a strain beyond the material's.
    pub fn universal(
        &self,
        spacing_m: T,
        material: &FlexureMaterial<T>,
        tilt: T,
    ) -> Result<JointStiffness<T>, Error> {
        self.flexure(material, tilt)?.universal(spacing_m)
    }

    /// The load along one leaf under which it buckles, N; see the module for its ends.
    #[must_use]
    pub fn critical_n(&self, material: &FlexureMaterial<T>) -> T {
        critical(self.bending(material), self.length_m)
    }

    /// EI/L, N·m/rad, with I = wt³/12.
    fn bending(&self, material: &FlexureMaterial<T>) -> T {
        let cubed = self.width_m * self.thickness_m * self.thickness_m * self.thickness_m;
        material.youngs_modulus_pa * cubed / (T::from(12.0) * self.length_m)
    }

    /// EI/L as of a beam that may curve across, and the torsion constant of a rectangle, wt³(1/3 − 0.21 t/w (1 − t⁴/12w⁴)) (W. C. Young,
    /// R. G. Budynas, "Roark's Formulas for Stress and Strain").
    ///
    /// A leaf much wider than √(Rt), where R = L/θ is the radius to which it is bent, and one whose clamps keep it flat
    /// across, is stiffer in bending: by at most 1/(1 − ν²), a tenth for steel. That is left out.
    fn flexure(&self, material: &FlexureMaterial<T>, tilt: T) -> Result<Flexure<T>, Error> {
        let &Self {
            length_m: length,
            width_m: width,
            thickness_m: thickness,
        } = self;
        material.check()?;
        check_length(length, Quantity::FlexureLength)?;
        check_length(width, Quantity::FlexureWidth)?;
        check_length(thickness, Quantity::FlexureThickness)?;
        check_ratio(
            length,
            thickness,
            LENGTH_BY_THICKNESS,
            Quantity::FlexureLength,
        )?;
        check_ratio(width, thickness, WIDTH_BY_THICKNESS, Quantity::FlexureWidth)?;
        material.check_strain(T::HALF * thickness * tilt / length)?;
        let cubed = width * thickness * thickness * thickness;
        let ratio = thickness / width;
        let fourth = ratio * ratio * ratio * ratio;
        let torsion_constant = cubed
            * (T::one() / T::from(3.0)
                - T::from(21.0) / T::from(100.0) * ratio * (T::one() - fourth / T::from(12.0)));
        let bending = self.bending(material);
        Ok(Flexure {
            bending,
            torsion: material.shear_modulus_pa * torsion_constant / length,
            lateral: T::from(12.0) * bending / (length * length),
            axial: material.youngs_modulus_pa * width * thickness / length,
        })
    }
}
