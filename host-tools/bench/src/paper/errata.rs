//! The errors of the print, each shown by its numbers.

mod rig;
mod statics;
mod stiffness;

use leg_base::numeric::derivative_by_rotation;
use leg_model::{Direction, Error, evaluate};
use leg_model_tools::plain_vectors::{Tendons, load_moment, rotation, turn};
use leg_rig::rig_file::RigFile;
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
struct LoadedPose<'a> {
    rig: &'a RigFile,
    azimuth: f64,
    tilt: f64,
    direction: Direction<f64>,
    rotation: Matrix3<f64>,
    tensions: Vector3<f64>,
    tendons: Tendons<3>,
    load: Vector3<f64>,
}

/// A number as printed, and as corrected.
type Numbers = (f64, f64);

/// What is wrong in the print, and the numbers that show it.
struct PrintedError {
    place: &'static str,
    wrong: &'static str,
    right: &'static str,
    number: &'static str,
    unit: &'static str,
    numbers: fn(&LoadedPose<'_>) -> Result<Numbers, Error>,
}

const ERRATA: [PrintedError; 15] = [
    PrintedError {
        place: "Eq. (1)",
        wrong: "three signs: as printed it is no rotation",
        right: "(2,3) k_yk_z·v − k_x·s, (3,1) k_xk_z·v − k_y·s, (3,2) k_yk_z·v + k_x·s",
        number: "largest entry of RᵀR − I",
        unit: "",
        numbers: |pose| pose.equation_1(),
    },
    PrintedError {
        place: "Eq. (3)",
        wrong: "d is not defined",
        right: "d = (0, 0, −L_upper)",
        number: "length of a tendon of the hanging leg, without and with d",
        unit: "mm",
        numbers: |pose| pose.equation_3(),
    },
    PrintedError {
        place: "Eqs. (5), (6), (23)",
        wrong: "the signs of the wrench disagree",
        right: "A f + M = 0 on the free axes",
        number: "moment that is left with A f = M, and with A f = −M",
        unit: "N·m",
        numbers: |pose| pose.equations_5_6_23(),
    },
    PrintedError {
        place: "Eq. (7)",
        wrong: "one column n_s: the support could push along the leg only",
        right: "three components, as in Eq. (23)",
        number: "force of the support across the leg",
        unit: "N",
        numbers: |pose| pose.equation_7(),
    },
    PrintedError {
        place: "Eqs. (12), (14)",
        wrong: "∂n/∂ψ is called zero",
        right: "the tendons turn as the leg does",
        number: "largest magnitude of e × ∂n/∂ψ",
        unit: "mm/rad",
        numbers: |pose| pose.equation_14(),
    },
    PrintedError {
        place: "Eq. (15)",
        wrong: "the sign for n from S to B, and the change of n",
        right: "K₂ = Σ f(−[n×][e×] + [e×](I − nnᵀ)[e×]ᵀ/l)",
        number: "largest difference from the derivative of the tendons' moment",
        unit: "N·m/rad",
        numbers: |pose| pose.equation_15(),
    },
    PrintedError {
        place: "Eqs. (17)–(19)",
        wrong: "Rᵀ diag R turns the joint's axes the wrong way, and N/m stands beside N·m/rad",
        right: "R diag Rᵀ with N·m/rad in all three entries; the axial stiffness is a matter of its own",
        number: "stiffness about the leg of a joint of 2.4 N·m/rad (bending), 1.8 (torsion), 10⁷ N/m (axial)",
        unit: "N·m/rad",
        numbers: |pose| pose.equation_18(),
    },
    PrintedError {
        place: "Eq. (19)",
        wrong: "a rod bends with EI/2L",
        right: "EI/L, when a moment bends it to a circle",
        number: "bending stiffness of a nickel-titanium rod of 2 mm × 20 mm",
        unit: "N·m/rad",
        numbers: |_| stiffness::equation_19(),
    },
    PrintedError {
        place: "Eq. (20)",
        wrong: "tendons and joint in series: a ball joint, which does not resist, leaves no stiffness",
        right: "parallel in rotation, in series along the shaft",
        number: "largest entry of the stiffness on a ball joint",
        unit: "N·m/rad",
        numbers: |pose| pose.equation_20(),
    },
    PrintedError {
        place: "Eq. (21)",
        wrong: "the lever of the payload: cos θ where sin θ belongs",
        right: "lever R(0, 0, −L)",
        number: "moment of the payload when the leg hangs straight down",
        unit: "N·m",
        numbers: |pose| pose.equation_21(),
    },
    PrintedError {
        place: "Table 1",
        wrong: "the leg's mass is 1 kg",
        right: "1.5 kg, as the note in Fig. 9 says",
        number: "deviation of the unloaded leg, 2 mm in Fig. 9",
        unit: "mm",
        numbers: |pose| pose.mass(),
    },
    PrintedError {
        place: "Table 1",
        wrong: "the centroid (28, 91, 0) mm is not in the axes of {A}",
        right: "on the leg's axis, 91 mm below the joint",
        number: "moment of the leg's weight when it hangs straight down",
        unit: "N·m",
        numbers: |pose| pose.centroid(),
    },
    PrintedError {
        place: "Fig. 11",
        wrong: "a moment of 100 N·m",
        right: "100 N·mm",
        number: "what the printed tensions balance",
        unit: "N·m",
        numbers: |_| rig::figure_11(),
    },
    PrintedError {
        place: "Sec. 4",
        wrong: "the stiffness of a rope of 0.6 mm × 120 mm is used for one of 0.8 mm × 100 mm",
        right: "by length and section the tendon is 32/15 as stiff",
        number: "lowest stiffness as tested, and scaled",
        unit: "N/m",
        numbers: |pose| rig::section_4(pose.rig),
    },
    PrintedError {
        place: "Sec. 4, Table 1",
        wrong: "the length between the plates is taken as what stretches",
        right: "the 100 mm to the slider, whatever the pose",
        number: "stiffness at the pretension, if only the length between the plates stretched",
        unit: "N/m",
        numbers: |pose| rig::elastic_length(pose.rig),
    },
];

/// Every erratum.
pub(super) fn all(rig: &RigFile) -> Result<Vec<Erratum>, Error> {
    let pose = LoadedPose::new(rig)?;
    let erratum = |error: &PrintedError| {
        let (printed, corrected) = (error.numbers)(&pose)?;
        Ok(Erratum {
            place: error.place,
            wrong: error.wrong,
            right: error.right,
            number: error.number,
            printed,
            corrected,
            unit: error.unit,
        })
    };
    ERRATA.iter().map(erratum).collect()
}

impl<'a> LoadedPose<'a> {
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
        derivative_by_rotation(|psi| {
            Tendons::new(parameters, &(turn(&psi) * self.rotation)).pulls[tendon]
        })
    }
}
