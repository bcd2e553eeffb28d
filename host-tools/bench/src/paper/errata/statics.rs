//! Errata in kinematics and statics.

use super::{LoadedPose, Numbers, PAYLOAD_KG};
use leg_model::{Error, RigParameters};
use leg_model_tools::plain_vectors::load_moment;
use nalgebra::{Matrix3, Vector3};

impl LoadedPose<'_> {
    pub(super) fn equation_1(&self) -> Result<Numbers, Error> {
        let (s, c) = self.tilt.sin_cos();
        let v = 1.0 - c;
        let (x, y, z) = (self.azimuth.sin(), -self.azimuth.cos(), 0.0);
        #[rustfmt::skip]
        let printed = Matrix3::new(
            x * x * v + c, x * y * v - z * s, x * z * v + y * s,
            x * y * v + z * s, y * y * v + c, y * z * v + x * s,
            x * z * v + y * s, y * z * v - x * s, z * z * v + c,
        );
        let error = |r: &Matrix3<f64>| (r.transpose() * r - Matrix3::identity()).amax();
        Ok((error(&printed), error(&self.rotation)))
    }

    pub(super) fn equation_3(&self) -> Result<Numbers, Error> {
        let p = &self.rig.parameters;
        let length = |upper: f64| (p.joint_length_m + upper) * 1e3;
        Ok((length(0.0), length(p.upper_length_m)))
    }

    pub(super) fn equations_5_6_23(&self) -> Result<Numbers, Error> {
        let pull = self.tendons.moment_map() * self.tensions;
        // Across the bisector of the two plates' normals, where the tendons have to balance the load.
        let bisector = (Vector3::z() - self.direction.vector()).normalize();
        let free = |moment: Vector3<f64>| (moment - bisector * bisector.dot(&moment)).norm();
        Ok((free(pull - self.load), free(pull + self.load)))
    }

    pub(super) fn equation_7(&self) -> Result<Numbers, Error> {
        let p = &self.rig.parameters;
        let pulls = self.tendons.pulls.iter().zip(self.tensions.iter());
        let pull: Vector3<f64> = pulls.map(|(pull, tension)| pull * *tension).sum();
        let weight = Vector3::z() * (-p.gravity_m_per_s2 * (p.leg_mass_kg + PAYLOAD_KG));
        let support = -pull - weight;
        let leg = self.direction.vector();
        Ok((0.0, support.cross(&leg).norm()))
    }

    pub(super) fn equation_21(&self) -> Result<Numbers, Error> {
        let p = &self.rig.parameters;
        let tip = p.joint_length_m + p.leg_length_m;
        let force = -PAYLOAD_KG * p.gravity_m_per_s2;
        Ok((
            (tip * force).abs(),
            load_moment(
                &RigParameters {
                    leg_mass_kg: 0.0,
                    ..*p
                },
                &Matrix3::identity(),
                PAYLOAD_KG,
            )
            .norm(),
        ))
    }
}
