//! Eqs. (24) and (25): directions and moments of the tendons in the two configurations of Fig. 11.

use super::row::{PaperRow, Topic, Verdict};
use leg_model::{Direction, Error, Rig, RigParameters, inverse_kinematics};
use leg_model_tools::plain_vectors::rotation;
use nalgebra::{Matrix3, Vector3};

/// A configuration of Fig. 11: a leg that leans by 30° at azimuth 0.
pub(super) struct PrintedPose {
    pub name: &'static str,
    upper_length_m: f64,
    /// Rows 1 to 3 of the printed matrix: n.
    pulls: Matrix3<f64>,
    /// Rows 4 to 6, mm: A.
    moment_map_mm: Matrix3<f64>,
    /// Table 3: tensions, N.
    pub tensions_n: Vector3<f64>,
    /// Table 3: force of the central support, N.
    pub support_force_n: Vector3<f64>,
}

/// Both configurations.
pub(super) const CONFIGURATIONS: [PrintedPose; 2] = [
    PrintedPose {
        name: "Eq. (24), L_upper = 6 mm",
        upper_length_m: 0.006,
        pulls: Matrix3::new(
            -0.5084, -0.3981, -0.3981, 0.0, 0.0, 0.0, 0.8611, 0.9173, 0.9173,
        ),
        moment_map_mm: Matrix3::new(
            0.0, 19.0664, -19.0664, -23.7175, 8.6193, 8.6193, 0.0, 8.2748, -8.2748,
        ),
        tensions_n: Vector3::new(-2.44, 2.44, 2.44),
        support_force_n: Vector3::new(-0.7, 0.0, 2.38),
    },
    PrintedPose {
        name: "Eq. (25), L_upper = 0",
        upper_length_m: 0.0,
        pulls: Matrix3::new(
            -0.6522, -0.4597, -0.4597, 0.0, 0.0, 0.0, 0.7580, 0.8881, 0.8881,
        ),
        moment_map_mm: Matrix3::new(
            0.0, 18.4579, -18.4579, -18.1924, 10.6567, 10.6567, 0.0, 9.5554, -9.5554,
        ),
        tensions_n: Vector3::new(-2.64, 2.44, 2.44),
        support_force_n: Vector3::new(-0.52, 0.0, 2.33),
    },
];

impl PrintedPose {
    /// n and A (m) of the model.
    pub(super) fn model(&self) -> Result<(Matrix3<f64>, Matrix3<f64>), Error> {
        let parameters = RigParameters {
            upper_length_m: self.upper_length_m,
            ..RigParameters::<f64, 3>::TABLE_1
        };
        let rig = Rig::new(&parameters)?;
        let tilt = 30_f64.to_radians();
        let kinematics = inverse_kinematics(rig.geometry(), &Direction::from_angles(0.0, tilt)?)?;
        let pull = |i: usize| {
            let ([bx, by], [sx, sy]) = (parameters.base_anchors_m[i], parameters.leg_anchors_m[i]);
            let end = rotation(0.0, tilt, 0.0) * Vector3::new(sx, sy, -parameters.joint_length_m);
            (Vector3::new(bx, by, self.upper_length_m) - end) / kinematics.lengths[i]
        };
        let pulls = Matrix3::from_columns(&[pull(0), pull(1), pull(2)]);
        Ok((pulls, kinematics.moment_map))
    }
}

/// How far an entry may be from the print, which has four decimals.
const ENTRY: f64 = 1e-4;

/// How many entries of each matrix agree with the print.
pub(super) fn rows() -> Result<Vec<PaperRow>, Error> {
    let mut rows = Vec::new();
    for configuration in &CONFIGURATIONS {
        for (matrix, entries) in ["n", "A"].into_iter().zip(configuration.entries()?) {
            let agree = |row: &&PaperRow| row.verdict() == Verdict::Agrees;
            let agreeing = entries.iter().filter(agree).count();
            rows.push(PaperRow::new(
                Topic::Kinematics,
                format!(
                    "{}: entries of {matrix} that agree, of those printed",
                    configuration.name
                ),
                (entries.len() as f64, agreeing as f64),
                ("", 0),
                "each to 1e-4; the report lists them",
            ));
        }
    }
    Ok(rows)
}

/// Every printed entry of both configurations.
pub(super) fn entries() -> Result<Vec<PaperRow>, Error> {
    let both: Result<Vec<_>, _> = CONFIGURATIONS.iter().map(PrintedPose::entries).collect();
    Ok(both?.concat().concat())
}

impl PrintedPose {
    /// The entries of n and those of A, mm.
    fn entries(&self) -> Result<[Vec<PaperRow>; 2], Error> {
        let (pulls, moment_map) = self.model()?;
        let entries = |matrix, unit, printed: &Matrix3<f64>, ours: &Matrix3<f64>| {
            let entry = |place: usize| {
                let (row, column) = (place / 3, place % 3);
                let what = format!("{}: {matrix}[{}][{}]", self.name, row + 1, column + 1);
                let numbers = (printed[(row, column)], ours[(row, column)]);
                let why = "printed to four decimals";
                PaperRow::new(Topic::Kinematics, what, numbers, (unit, 4), why).bounded(ENTRY)
            };
            (0..9).map(entry).collect()
        };
        Ok([
            entries("n", "", &self.pulls, &pulls),
            entries("A", "mm", &self.moment_map_mm, &(moment_map * 1e3)),
        ])
    }
}
