//! Errata in kinematics and statics.

use super::{Erratum, PAYLOAD_KG, Shown};
use leg_model::RigParameters;
use leg_model_tools::plain_vectors::load_moment;
use nalgebra::{Matrix3, Vector3};

impl Shown<'_> {
    pub(super) fn equation_1(&self) -> Erratum {
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
        Erratum {
            place: "Eq. (1)",
            wrong: "three signs: as printed it is no rotation",
            right: "(2,3) k_yk_z·v − k_x·s, (3,1) k_xk_z·v − k_y·s, (3,2) k_yk_z·v + k_x·s",
            number: "largest entry of RᵀR − I",
            printed: error(&printed),
            corrected: error(&self.rotation),
            unit: "",
        }
    }

    pub(super) fn equation_3(&self) -> Erratum {
        let p = &self.rig.parameters;
        let length = |upper: f64| (p.joint_length_m + upper) * 1e3;
        Erratum {
            place: "Eq. (3)",
            wrong: "d is not defined",
            right: "d = (0, 0, −L_upper)",
            number: "length of a tendon of the hanging leg, without and with d",
            printed: length(0.0),
            corrected: length(p.upper_length_m),
            unit: "mm",
        }
    }

    pub(super) fn equations_5_6_23(&self) -> Erratum {
        let pull = self.tendons.moment_map() * self.tensions;
        // Across the bisector of the two plates' normals, where the tendons have to balance the load.
        let bisector = (Vector3::z() - self.direction.vector()).normalize();
        let free = |moment: Vector3<f64>| (moment - bisector * bisector.dot(&moment)).norm();
        Erratum {
            place: "Eqs. (5), (6), (23)",
            wrong: "the signs of the wrench disagree",
            right: "A f + M = 0 on the free axes",
            number: "moment that is left with A f = M, and with A f = −M",
            printed: free(pull - self.load),
            corrected: free(pull + self.load),
            unit: "N·m",
        }
    }

    pub(super) fn equation_7(&self) -> Erratum {
        let p = &self.rig.parameters;
        let pulls = self.tendons.pulls.iter().zip(self.tensions.iter());
        let pull: Vector3<f64> = pulls.map(|(pull, tension)| pull * *tension).sum();
        let weight = Vector3::z() * (-p.gravity_m_per_s2 * (p.leg_mass_kg + PAYLOAD_KG));
        let support = -pull - weight;
        let leg = self.direction.vector();
        Erratum {
            place: "Eq. (7)",
            wrong: "one column n_s: the support could push along the leg only",
            right: "three components, as in Eq. (23)",
            number: "force of the support across the leg",
            printed: 0.0,
            corrected: support.cross(&leg).norm(),
            unit: "N",
        }
    }

    pub(super) fn equation_21(&self) -> Erratum {
        let p = &self.rig.parameters;
        let tip = p.joint_length_m + p.leg_length_m;
        let force = -PAYLOAD_KG * p.gravity_m_per_s2;
        Erratum {
            place: "Eq. (21)",
            wrong: "the lever of the payload: cos θ where sin θ belongs",
            right: "lever R(0, 0, −L)",
            number: "moment of the payload when the leg hangs straight down",
            printed: (tip * force).abs(),
            corrected: load_moment(
                &RigParameters {
                    leg_mass_kg: 0.0,
                    ..*p
                },
                &Matrix3::identity(),
                PAYLOAD_KG,
            )
            .norm(),
            unit: "N·m",
        }
    }
}
