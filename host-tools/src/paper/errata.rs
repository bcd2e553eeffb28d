//! The errors of the print, each shown by its numbers.

use crate::numeric::by_rotation;
use crate::plain_vectors::{Tendons, load_moment, rotation, skew, turn};
use crate::rig_file::RigFile;
use leg_model::{
    Direction, Error, JointStiffness, Query, SupportKind, Tendon, evaluate,
    joint_stiffness_leg_fixed, series_stiffness_printed, structural_stiffness,
    structural_stiffness_printed, support_stiffness_printed,
};
use nalgebra::{Matrix3, Vector3};
use serde::Serialize;

/// An error of the print.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Erratum {
    /// Where it stands.
    pub place: &'static str,
    /// What is wrong there.
    pub wrong: &'static str,
    /// What is right.
    pub right: &'static str,
    /// What the two numbers are.
    pub number: &'static str,
    /// The number as printed.
    pub printed: f64,
    /// The number as corrected.
    pub corrected: f64,
    /// Their unit.
    pub unit: &'static str,
}

/// Azimuth and tilt at which the errors are shown, degrees.
const POSE_DEG: (f64, f64) = (30.0, 30.0);

/// The payload with which they are shown.
const PAYLOAD_KG: f64 = 2.0;

/// A leg at that pose, loaded.
struct Shown<'a> {
    rig: &'a RigFile,
    azimuth: f64,
    tilt: f64,
    direction: Direction<f64>,
    rotation: Matrix3<f64>,
    tensions: Vector3<f64>,
    tendons: Tendons<3>,
    load: Vector3<f64>,
}

/// Every erratum.
pub(super) fn all(rig: &RigFile) -> Result<Vec<Erratum>, Error> {
    let shown = Shown::new(rig)?;
    Ok(vec![
        shown.equation_1(),
        shown.equation_3(),
        shown.equations_5_6_23(),
        shown.equation_7(),
        shown.equation_14(),
        shown.equation_15(),
        shown.equation_18(),
        equation_19(),
        shown.equation_20()?,
        shown.equation_21(),
        shown.mass()?,
        shown.centroid(),
        figure_11(),
        section_4(rig)?,
    ])
}

impl<'a> Shown<'a> {
    fn new(rig: &'a RigFile) -> Result<Self, Error> {
        let (azimuth, tilt) = (POSE_DEG.0.to_radians(), POSE_DEG.1.to_radians());
        let query = rig.query(POSE_DEG.0, POSE_DEG.1, PAYLOAD_KG);
        let rotation = rotation(azimuth, tilt, 0.0);
        Ok(Self {
            rig,
            azimuth,
            tilt,
            direction: Direction::from_angles(azimuth, tilt)?,
            rotation,
            tensions: evaluate(&rig.parameters, &query)?.tensions_n.into(),
            tendons: Tendons::new(&rig.parameters, &rotation),
            load: load_moment(&rig.parameters, &rotation, PAYLOAD_KG),
        })
    }

    /// ∂n/∂ψ of a tendon, by differences.
    fn change_of_pull(&self, tendon: usize) -> Matrix3<f64> {
        let parameters = &self.rig.parameters;
        by_rotation(|psi| Tendons::new(parameters, &(turn(&psi) * self.rotation)).pulls[tendon])
    }

    fn equation_1(&self) -> Erratum {
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

    fn equation_3(&self) -> Erratum {
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

    fn equations_5_6_23(&self) -> Erratum {
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

    fn equation_7(&self) -> Erratum {
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

    fn equation_14(&self) -> Erratum {
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

    fn equation_15(&self) -> Erratum {
        let mut numeric = Matrix3::zeros();
        for i in 0..3 {
            let (e, n) = (skew(&self.tendons.ends[i]), skew(&self.tendons.pulls[i]));
            // −∂(e × n)/∂ψ with ∂e/∂ψ = −[e×].
            numeric += (-n * e - e * self.change_of_pull(i)) * self.tensions[i];
        }
        let geometry = leg_model::Rig::new(&self.rig.parameters);
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

    fn equation_18(&self) -> Erratum {
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

    fn equation_20(&self) -> Result<Erratum, Error> {
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

    fn equation_21(&self) -> Erratum {
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
                &leg_model::RigParameters {
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

    fn mass(&self) -> Result<Erratum, Error> {
        let sag = |leg_mass_kg: f64| {
            let parameters = leg_model::RigParameters {
                leg_mass_kg,
                ..self.rig.parameters
            };
            let query = self.rig.query(POSE_DEG.0, POSE_DEG.1, 0.0);
            evaluate(&parameters, &query).map(|evaluation| evaluation.deviation_m * 1e3)
        };
        Ok(Erratum {
            place: "Table 1",
            wrong: "the leg's mass is 1 kg",
            right: "1.5 kg, as the note in Fig. 9 says",
            number: "deviation of the unloaded leg, 2 mm in Fig. 9",
            printed: sag(1.0)?,
            corrected: sag(self.rig.parameters.leg_mass_kg)?,
            unit: "mm",
        })
    }

    fn centroid(&self) -> Erratum {
        let p = &self.rig.parameters;
        // (28, 91, 0) in {A}: 91 mm beside the vertical axis.
        let beside = 0.028_f64.hypot(0.091);
        Erratum {
            place: "Table 1",
            wrong: "the centroid (28, 91, 0) mm is not in the axes of {A}",
            right: "on the leg's axis, 91 mm below the joint",
            number: "moment of the leg's weight when it hangs straight down",
            printed: beside * p.leg_mass_kg * p.gravity_m_per_s2,
            corrected: load_moment(p, &Matrix3::identity(), 0.0).norm(),
            unit: "N·m",
        }
    }
}

fn elastic_joint() -> JointStiffness<f64> {
    JointStiffness {
        bending_nm_per_rad: 2.4,
        torsion_nm_per_rad: 1.8,
        axial_compliance_m_per_n: 1e-7,
    }
}

fn equation_19() -> Erratum {
    let rod = leg_model::Rod {
        length_m: 0.02,
        diameter_m: 0.002,
    };
    let material = leg_model::FlexureMaterial {
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

fn figure_11() -> Erratum {
    let configuration = &super::kinematics::CONFIGURATIONS[0];
    let moment = configuration
        .model()
        .map(|(_, map)| (map * configuration.tensions_n).y);
    Erratum {
        place: "Fig. 11",
        wrong: "a moment of 100 N·m",
        right: "100 N·mm",
        number: "what the printed tensions balance",
        printed: 100.0,
        corrected: moment.unwrap_or(f64::NAN),
        unit: "N·m",
    }
}

/// The test piece (0.6 mm × 120 mm) is not the rig's tendon (0.8 mm × 100 mm), whose geometric length is 35 mm.
fn section_4(rig: &RigFile) -> Result<Erratum, Error> {
    use leg_model::Elasticity;
    let [tendon, ..] = &rig.tendons;
    let Tendon::Curve(curve) = tendon else {
        return Err(Error::Singular);
    };
    let section = (0.8_f64 / 0.6).powi(2);
    let scaled: Vec<_> = curve
        .points()
        .map(|point| point.scaled(100.0 / 120.0, section))
        .collect();
    Ok(Erratum {
        place: "Sec. 4",
        wrong: "the stiffness of a rope of 0.6 mm × 120 mm is used for one of 0.8 mm × 100 mm",
        right: "by length and section the tendon is 32/15 as stiff",
        number: "lowest stiffness as tested, and scaled",
        printed: tendon.stiffness(8.0)?,
        corrected: Tendon::curve(&scaled)?.stiffness(8.0)?,
        unit: "N/m",
    })
}
