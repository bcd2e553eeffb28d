//! A state of the leg that is drawn from the seed and its number.

use super::feedback::TENSION_PARTS;
use crate::draw::{PAYLOAD_KG, drawn, feasible, homed, numbered, pose};
use fastrand::Rng;
use leg_rig::plant_settings::PlantSettings;
use leg_rig::rig_file::RigFile;
use serde::Serialize;

/// How often a pose and a payload are drawn until a pretension serves them.
const TRIES: u32 = 10_000;

/// Pose, payload and pretension.
#[derive(Clone, Debug, Serialize)]
pub struct DrawnState {
    /// Counted from 0.
    pub number: u64,
    /// The rig's name.
    pub rig: String,
    /// Azimuth and tilt, degrees.
    pub pose_deg: [f64; 2],
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

impl DrawnState {
    /// The state of a number, whose tensions stay within their bounds by what is added to them; none for a rig that has no such state.
    pub(super) fn new(seed: u64, rigs: &[(String, RigFile)], number: u64) -> Option<Self> {
        let (seed, (rig, file)) = numbered(seed, rigs, number);
        let mut rng = Rng::with_seed(seed);
        for _ in 0..TRIES {
            let pose_deg = pose(file, &mut rng);
            let payload_kg = drawn(&mut rng, PAYLOAD_KG);
            let room_n = TENSION_PARTS[0] * file.f_max_n;
            let [low, high] = feasible(file, pose_deg, payload_kg);
            let (low, high) = (low + room_n, high - room_n);
            let pretension_n = low + drawn(&mut rng, high - low);
            if low < high {
                return Some(Self {
                    number,
                    rig: rig.clone(),
                    pose_deg,
                    payload_kg,
                    pretension_n,
                    seed,
                    file: *file,
                    plant: homed(file),
                });
            }
        }
        None
    }
}
