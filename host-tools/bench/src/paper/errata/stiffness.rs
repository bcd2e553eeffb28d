//! Errata in the stiffness.

use super::{Erratum, PAYLOAD_KG, POSE_DEG, Shown};
use leg_model::{
    Error, FlexureMaterial, JointStiffness, Query, Rig, Rod, SupportKind, evaluate,
    joint_stiffness_leg_fixed, series_stiffness_printed, structural_stiffness,
    structural_stiffness_printed, support_stiffness_printed,
};
use leg_model_tools::plain_vectors::skew;
use nalgebra::Matrix3;

impl Shown<'_> {
    pub(super) fn equation_14(&self) -> Erratum {
        let norm = |i: usize| (skew(&self.tendons.ends[i]) * self.change_of_pull(i)).norm() * 1e3;
        Erratum {
            place: "Eqs. (12), (14)",
            wrong: "∂n/∂ψ is called zero",
            right: "the tendons turn as the leg does",
            number: "largest magnitude of e × ∂n/∂ψ",
            printed: 0.0,
            corrected: (0..3).map(norm).fold(0.0, f64::max),
            unit: "mm/rad",
        }
    }

    pub(super) fn equation_15(&self) -> Erratum {
        let mut numeric = Matrix3::zeros();
        for i in 0..3 {
            let (e, n) = (skew(&self.tendons.ends[i]), skew(&self.tendons.pulls[i]));
            // −∂(e × n)/∂ψ with ∂e/∂ψ = −[e×].
            numeric += (-n * e - e * self.change_of_pull(i)) * self.tensions[i];
        }
        let geometry = Rig::new(&self.rig.parameters);
        let error = |k2: Matrix3<f64>| (k2 - numeric).amax();
        let (printed, exact) = match &geometry {
            Ok(rig) => (
                structural_stiffness_printed(rig.geometry(), &self.direction, &self.tensions),
                structural_stiffness(rig.geometry(), &self.direction, &self.tensions),
            ),
            Err(_) => (Matrix3::repeat(f64::NAN), Matrix3::repeat(f64::NAN)),
        };
        Erratum {
            place: "Eq. (15)",
            wrong: "the sign for n from S to B, and the change of n",
            right: "K₂ = Σ f(−[n×][e×] + [e×](I − nnᵀ)[e×]ᵀ/l)",
            number: "largest difference from the derivative of the tendons' moment",
            printed: error(printed),
            corrected: error(exact),
            unit: "N·m/rad",
        }
    }

    pub(super) fn equation_18(&self) -> Erratum {
        let joint = elastic_joint();
        let right = joint_stiffness_leg_fixed(&joint, &self.direction);
        let along = |k: &Matrix3<f64>| self.direction.vector().dot(&(k * self.direction.vector()));
        let printed = support_stiffness_printed(&joint, &self.rotation);
        Erratum {
            place: "Eqs. (17)–(19)",
            wrong: "Rᵀ diag R turns the joint's axes the wrong way, and N/m stands beside N·m/rad",
            right: "R diag Rᵀ with N·m/rad in all three entries; the axial stiffness is a matter of its own",
            number: "stiffness about the leg of a joint of 2.4 N·m/rad (bending), 1.8 (torsion), 10⁷ N/m (axial)",
            printed: printed.map_or(f64::NAN, |k| along(&k)),
            corrected: along(&right),
            unit: "N·m/rad",
        }
    }

    pub(super) fn equation_20(&self) -> Result<Erratum, Error> {
        let query = Query {
            support: SupportKind::Spherical.into(),
            ..self.rig.query(POSE_DEG.0, POSE_DEG.1, PAYLOAD_KG)
        };
        let ball = evaluate(&self.rig.parameters, &query)?;
        let k = Matrix3::from_fn(|i, j| ball.stiffness_nm_per_rad[i][j]);
        let printed = series_stiffness_printed(&k, &Matrix3::zeros())?;
        Ok(Erratum {
            place: "Eq. (20)",
            wrong: "tendons and joint in series: a ball joint, which does not resist, leaves no stiffness",
            right: "parallel in rotation, in series along the shaft",
            number: "largest entry of the stiffness on a ball joint",
            printed: printed.amax(),
            corrected: k.amax(),
            unit: "N·m/rad",
        })
    }
}

fn elastic_joint() -> JointStiffness<f64> {
    JointStiffness {
        bending_nm_per_rad: 2.4,
        torsion_nm_per_rad: 1.8,
        axial_compliance_m_per_n: 1e-7,
    }
}

pub(super) fn equation_19() -> Erratum {
    let rod = Rod {
        length_m: 0.02,
        diameter_m: 0.002,
    };
    let material = FlexureMaterial {
        youngs_modulus_pa: 60e9,
        shear_modulus_pa: 23e9,
        strain_max: 0.06,
    };
    let bending = rod.pivot(&material, 30_f64.to_radians());
    let corrected = bending.map_or(f64::NAN, |joint| joint.bending_nm_per_rad);
    Erratum {
        place: "Eq. (19)",
        wrong: "a rod bends with EI/2L",
        right: "EI/L, when a moment bends it to a circle",
        number: "bending stiffness of a nickel-titanium rod of 2 mm × 20 mm",
        printed: corrected / 2.0,
        corrected,
        unit: "N·m/rad",
    }
}
