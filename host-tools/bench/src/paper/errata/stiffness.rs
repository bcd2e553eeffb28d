//! Errata in the stiffness.

use super::{LoadedPose, Numbers, PAYLOAD_KG, POSE_DEG};
use leg_model::{
    Error, FlexureMaterial, JointStiffness, Query, Rig, Rod, SupportKind, evaluate, printed,
    structural_stiffness,
};
use leg_model_tools::plain_vectors::skew;
use nalgebra::Matrix3;

impl LoadedPose<'_> {
    pub(super) fn equation_14(&self) -> Result<Numbers, Error> {
        let norm = |i: usize| (skew(&self.tendons.ends[i]) * self.change_of_pull(i)).norm() * 1e3;
        Ok((0.0, (0..3).map(norm).fold(0.0, f64::max)))
    }

    pub(super) fn equation_15(&self) -> Result<Numbers, Error> {
        let mut numeric = Matrix3::zeros();
        for i in 0..3 {
            let (e, n) = (skew(&self.tendons.ends[i]), skew(&self.tendons.pulls[i]));
            // −∂(e × n)/∂ψ with ∂e/∂ψ = −[e×].
            numeric += (-n * e - e * self.change_of_pull(i)) * self.tensions[i];
        }
        let rig = Rig::new(&self.rig.parameters)?;
        let (geometry, direction) = (rig.geometry(), &self.direction);
        let wrong = printed::structural_stiffness(geometry, direction, &self.tensions);
        let exact = structural_stiffness(geometry, direction, &self.tensions);
        let error = |k2: Matrix3<f64>| (k2 - numeric).amax();
        Ok((error(wrong), error(exact)))
    }

    pub(super) fn equation_18(&self) -> Result<Numbers, Error> {
        let joint = elastic_joint();
        let right = printed::joint_stiffness_leg_fixed(&joint, &self.direction);
        let axial = |k: &Matrix3<f64>| self.direction.vector().dot(&(k * self.direction.vector()));
        let printed = printed::support_stiffness(&joint, &self.rotation);
        Ok((printed.map_or(f64::NAN, |k| axial(&k)), axial(&right)))
    }

    pub(super) fn equation_20(&self) -> Result<Numbers, Error> {
        let query = Query {
            support: SupportKind::Spherical.into(),
            ..self.rig.query(POSE_DEG.0, POSE_DEG.1, PAYLOAD_KG)
        };
        let ball = evaluate(&self.rig.parameters, &query)?;
        let k = Matrix3::from_fn(|i, j| ball.stiffness_nm_per_rad[i][j]);
        let printed = printed::series_stiffness(&k, &Matrix3::zeros())?;
        Ok((printed.amax(), k.amax()))
    }
}

fn elastic_joint() -> JointStiffness<f64> {
    JointStiffness {
        bending_nm_per_rad: 2.4,
        torsion_nm_per_rad: 1.8,
        axial_compliance_m_per_n: 1e-7,
    }
}

pub(super) fn equation_19() -> Result<Numbers, Error> {
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
    Ok((corrected / 2.0, corrected))
}
