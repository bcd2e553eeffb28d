//! A right-circular notch hinge.

use super::{Flexure, FlexureMaterial, check_length, check_ratio};
use crate::{Error, JointStiffness, Quantity, Reason, Scalar};

/// The range of radius by neck thickness over which the formula has been compared with finite elements, 1.25 to 20
/// (Y. K. Yong, T.-F. Lu, D. C. Handley, "Review of circular flexure hinge design equations and derivation of empirical
/// formulations", Precision Engineering 32, 2008).
const RADIUS_BY_THICKNESS: [f32; 2] = [1.25, 20.0];

/// Narrower necks, in thicknesses, twist unlike the formula, which is within 1.2 % from here on.
const WIDTH_BY_THICKNESS: f32 = 3.0;

/// A rectangle of thickness t and width b twists by 3/(Gbt³)(1 + 0.63 t/b + 0.6 t²/b²) for a unit moment and length: the
/// first of these is of Roark's series, the second makes up for the rest of it.
const TORSION_BY_RATIO: [f32; 2] = [0.63, 0.6];

/// Shear is not uniform over a rectangular section: its compliance is larger by this factor than if it were.
const SHEAR_FACTOR: f32 = 1.2;

/// A neck between two round cuts, its width along the axis about which it bends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Notch<T> {
    /// Radius r of the cuts, m. The neck is 2r long.
    pub radius_m: T,
    /// Thickness t where the neck is thinnest, m; 0.05 to 0.8 of the radius.
    pub thickness_m: T,
    /// Width b, m; at least three thicknesses.
    pub width_m: T,
}

impl<T: Scalar> Notch<T> {
    /// A universal joint of two pairs of notches, each pair `spacing_m` apart between the necks' middles, bent by up to
    /// `tilt` rad about either axis.
    ///
    /// # Errors
    /// A part that is refused, a neck outside the formula's range, a strain beyond the material's.
    pub fn universal(
        &self,
        spacing_m: T,
        material: &FlexureMaterial<T>,
        tilt: T,
    ) -> Result<JointStiffness<T>, Error> {
        self.flexure(material, tilt)?.universal(spacing_m)
    }

    /// A load along one notch under which it does not buckle, N; see the module for its ends.
    ///
    /// Buckled, its slope φ vanishes at both ends, so that φ² is nowhere more than the neck's compliance ∫dz/EI from
    /// there to the end times ∫EIφ'² dz over that half (Cauchy and Schwarz). Hence ∫EIφ'² dz/∫φ² dz, of which the
    /// critical load is the minimum, is at least 2/∫|z|/EI dz = Ebt²(1 + t/2r)/3r. A beam of one section has 8EI/L² so,
    /// where π²EI/L² is exact. The shear of the thinnest place is taken in series.
    #[must_use]
    pub fn critical_n(&self, material: &FlexureMaterial<T>) -> T {
        let &Self {
            radius_m: radius,
            thickness_m: thickness,
            width_m: width,
        } = self;
        let edge = T::one() + thickness / (T::TWO * radius);
        let bends_at = material.youngs_modulus_pa * width * thickness * thickness * edge
            / (T::from(3.0) * radius);
        let shears_at = material.shear_modulus_pa * width * thickness / T::from(SHEAR_FACTOR);
        bends_at * shears_at / (bends_at + shears_at)
    }

    /// A beam of varying thickness, t(u) = 2r(c − cos u) with c = 1 + t/2r, between the edges of the cuts: the
    /// integral that J. M. Paros and L. Weisbord solve ("How to design flexure hinges", Machine Design 37, 1965).
    fn flexure(&self, material: &FlexureMaterial<T>, tilt: T) -> Result<Flexure<T>, Error> {
        self.check(material)?;
        let (young, shear) = (material.youngs_modulus_pa, material.shear_modulus_pa);
        let &Self {
            radius_m: radius,
            thickness_m: thickness,
            width_m: width,
        } = self;
        let integrals = NeckIntegrals::new(T::one() + thickness / (T::TWO * radius));
        let bends_by = T::from(1.5) * integrals.bending / (young * width * radius * radius);
        let shifts_by = T::from(1.5) * integrals.lateral / (young * width)
            + T::HALF * T::from(SHEAR_FACTOR) * integrals.axial / (shear * width);
        let bending = T::one() / bends_by;
        let [first, second] = TORSION_BY_RATIO.map(T::from);
        // t/b = 2r/b · w.
        let ratio = T::TWO * radius / width;
        let twists_by = T::from(3.0 / 8.0) / (shear * width * radius * radius)
            * (integrals.bending
                + ratio * (first * integrals.torsion + second * ratio * integrals.axial));
        // The moment that bends it by the whole tilt strains the thinnest place most.
        material.check_strain(
            T::from(6.0) * bending * tilt / (young * width * thickness * thickness),
        )?;
        Ok(Flexure {
            bending,
            torsion: T::one() / twists_by,
            lateral: T::one() / shifts_by,
            axial: T::TWO * young * width / integrals.axial,
        })
    }

    fn check(&self, material: &FlexureMaterial<T>) -> Result<(), Error> {
        material.check()?;
        check_length(self.radius_m, Quantity::NotchRadius)?;
        check_length(self.thickness_m, Quantity::FlexureThickness)?;
        check_length(self.width_m, Quantity::FlexureWidth)?;
        let [min, max] = RADIUS_BY_THICKNESS.map(|ratio| T::from(ratio) * self.thickness_m);
        if !(min <= self.radius_m && self.radius_m <= max) {
            return Err(Error::refused(
                Quantity::FlexureThickness,
                Reason::OutsideFormula,
            ));
        }
        check_ratio(
            self.width_m,
            self.thickness_m,
            WIDTH_BY_THICKNESS,
            Quantity::FlexureWidth,
        )
    }
}

/// Integrals over a neck from u = −π/2 to π/2, with w = c − cos u.
struct NeckIntegrals<T> {
    /// ∫cos u/w³ du.
    bending: T,
    /// ∫cos u/w² du.
    torsion: T,
    /// ∫sin²u cos u/w³ du.
    lateral: T,
    /// ∫cos u/w du.
    axial: T,
}

impl<T: Scalar> NeckIntegrals<T> {
    /// From j_n = ∫du/wⁿ, which follow from each other by parts.
    fn new(c: T) -> Self {
        let (two, three) = (T::TWO, T::from(3.0));
        let gap = c * c - T::one();
        let root = gap.sqrt();
        let j1 = T::from(4.0) / root * (c + T::one()).atan2(root);
        let j2 = (two / c + c * j1) / gap;
        let j3 = (two / (c * c) + three * c * j2 - j1) / (two * gap);
        Self {
            bending: c * j3 - j2,
            torsion: c * j2 - j1,
            lateral: T::HALF
                * ((two * c * c - T::one()) * j2 - T::from(4.0) * c * j1 + two * T::PI),
            axial: c * j1 - T::PI,
        }
    }
}
