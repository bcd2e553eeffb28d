//! A move that is drawn from the seed and its number.

use super::duration::longest_s;
use crate::draw::{PAYLOAD_KG, distance, drawn, feasible, homed, numbered, pose};
use fastrand::Rng;
use leg_base::angles;
use leg_rig::plant_settings::PlantSettings;
use leg_rig::rig_file::RigFile;
use nalgebra::Vector3;
use serde::Serialize;

/// Shortest move, as a distance of directions: 3°.
const SHORTEST: f64 = 0.052;

/// How often two poses are drawn until a pretension serves both: as good as always after ten.
const TRIES: u32 = 10_000;

/// A move.
#[derive(Clone, Debug, Serialize)]
pub struct DrawnMove {
    /// Counted from 0.
    pub number: u64,
    /// The rig's name.
    pub rig: String,
    /// Azimuth and tilt at its begin, degrees.
    pub begin_deg: [f64; 2],
    /// The same at its end.
    pub end_deg: [f64; 2],
    /// kg.
    pub payload_kg: f64,
    /// N.
    pub pretension_n: f64,
    #[serde(skip)]
    pub(super) seed: u64,
    #[serde(skip)]
    pub(super) file: RigFile,
    #[serde(skip)]
    pub(super) plant: PlantSettings,
}

impl DrawnMove {
    /// The move of a number, with a payload that is drawn where none is given; none for a rig that holds no pair of poses.
    pub(super) fn new(
        seed: u64,
        rigs: &[(String, RigFile)],
        payload_kg: Option<f64>,
        number: u64,
    ) -> Option<Self> {
        let (seed, (rig, file)) = numbered(seed, rigs, number);
        let mut rng = Rng::with_seed(seed);
        for _ in 0..TRIES {
            let (begin_deg, end_deg) = (pose(file, &mut rng), pose(file, &mut rng));
            let drawn_kg = drawn(&mut rng, PAYLOAD_KG);
            let payload_kg = payload_kg.unwrap_or(drawn_kg);
            let empty = [begin_deg, end_deg, [0.0; 2]].map(|at| feasible(file, at, 0.0));
            let loaded = [begin_deg, end_deg].map(|at| feasible(file, at, payload_kg));
            let (mut low, mut high) = (0.0_f64, f64::INFINITY);
            for [lowest, highest] in empty.into_iter().chain(loaded) {
                (low, high) = (low.max(lowest), high.min(highest));
            }
            let pretension_n = low + (high - low) * rng.f64();
            if low < high && distance(&begin_deg, &end_deg) > SHORTEST {
                return Some(Self {
                    number,
                    seed,
                    rig: rig.clone(),
                    begin_deg,
                    end_deg,
                    payload_kg,
                    pretension_n,
                    file: *file,
                    plant: homed(file),
                });
            }
        }
        None
    }

    /// The same with a leg whose swing is not braked.
    pub(super) fn undamped(&self) -> Self {
        let mut same = self.clone();
        same.file.gains.motion.damping_ratio = 0.0;
        same
    }

    /// The longest that it may take by the limits on its motion, s.
    #[must_use]
    pub fn longest_s(&self) -> f64 {
        longest_s(&self.file.gains.motion, self.begin_deg, self.end_deg)
    }

    pub(super) fn tip_length_m(&self) -> f64 {
        let parameters = &self.file.parameters;
        parameters.joint_length_m + parameters.leg_length_m
    }

    /// The commanded tip, m.
    pub(super) fn end_tip_m(&self) -> Vector3<f64> {
        let [x, y] = angles::direction(self.end_deg[0], self.end_deg[1]);
        Vector3::new(x, y, -(1.0 - x * x - y * y).max(0.0).sqrt()) * self.tip_length_m()
    }
}
