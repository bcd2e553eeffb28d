//! How lengths and tensions of the tendons change with a tilt of the leg, and with the pretension.

use super::break_point::CellBreak;
use crate::stand::Stand;
use leg_model::{Direction, Elasticity, inverse_kinematics};
use leg_rig::rig_file::RigFile;
use nalgebra::Vector3;

/// A small tilt, rad, and a small tension, N.
const TILT_RAD: f64 = 1e-4;
const TENSION_N: f64 = 0.1;

/// The patterns at a state of the leg.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patterns {
    /// Lengths by a tilt, m/rad, which are the levers of the tensions: farther, and across.
    tilts: [Vector3<f64>; 2],
    stiffnesses_n_per_m: Vector3<f64>,
    n_per_code: [f64; 3],
}

impl Patterns {
    /// Of a leg at rest.
    ///
    /// # Errors
    /// What the model refuses.
    pub fn new(file: &RigFile, stand: &Stand) -> Result<Self, leg_model::Error> {
        let leg = stand.truth.direction.vector();
        let lean = Vector3::new(leg.x, leg.y, 0.0);
        let lean = lean.try_normalize(1e-6).unwrap_or_else(Vector3::x);
        let across = leg.cross(&lean).normalize();
        let farther = across.cross(&leg);
        let geometry = leg_model::Rig::new(&file.parameters)?;
        let lengths = |turned: Vector3<f64>| {
            let turned = turned.normalize();
            let direction = Direction::from_xy(turned.x, turned.y)?;
            Ok::<_, leg_model::Error>(inverse_kinematics(geometry.geometry(), &direction)?.lengths)
        };
        let pattern = |to: Vector3<f64>| {
            let change = lengths(leg + to * TILT_RAD)? - lengths(leg - to * TILT_RAD)?;
            Ok::<_, leg_model::Error>(change / (2.0 * TILT_RAD))
        };
        let mut stiffnesses_n_per_m = Vector3::zeros();
        for (i, tendon) in file.tendons.iter().enumerate() {
            let tension_n = stand.truth.tensions_n[i];
            let stretch_m = tendon.elongation(tension_n + TENSION_N)?
                - tendon.elongation(tension_n - TENSION_N)?;
            stiffnesses_n_per_m[i] = 2.0 * TENSION_N / stretch_m;
        }
        Ok(Self {
            tilts: [pattern(farther)?, pattern(across)?],
            stiffnesses_n_per_m,
            n_per_code: file.calibration.cell_n_per_code,
        })
    }

    /// The elongations that a tilt makes: what is added is an elongation by the tensions, as a length, m, and what comes back the
    /// lengths that motors and tensions make together.
    pub fn lengths(&self, axis: usize) -> CellBreak {
        let tilt = self.tilts[axis].normalize();
        CellBreak {
            per_added_n: tilt.component_mul(&self.stiffnesses_n_per_m).into(),
            weights: tilt.component_div(&self.stiffnesses_n_per_m).into(),
            length_weights: tilt.into(),
            n_per_code: self.n_per_code,
        }
    }

    /// The moment of the tensions about an axis, N·m: what is added has no part about the other one, and no pretension.
    pub fn moment(&self, axis: usize) -> CellBreak {
        let [lever, other] = [self.tilts[axis], self.tilts[1 - axis]];
        let alone = lever - other * (lever.dot(&other) / other.norm_squared());
        CellBreak {
            per_added_n: (alone / alone.dot(&lever)).into(),
            weights: lever.into(),
            length_weights: [0.0; 3],
            n_per_code: self.n_per_code,
        }
    }

    /// The tensions that load no free axis; what is added is the pretension, N.
    pub fn pretension(&self) -> CellBreak {
        let [farther, across] = self.tilts;
        let along = farther.cross(&across).normalize();
        let along = along * (along.sum().signum() * 3.0_f64.sqrt());
        CellBreak {
            per_added_n: along.into(),
            weights: (along / 3.0).into(),
            length_weights: [0.0; 3],
            n_per_code: self.n_per_code,
        }
    }
}

impl CellBreak {
    /// What has to be added so that no cell gets more than a tension, N.
    pub fn amplitude(&self, tension_n: f64) -> f64 {
        let most = self.per_added_n.iter().fold(0.0_f64, |a, n| a.max(n.abs()));
        tension_n / most
    }
}
