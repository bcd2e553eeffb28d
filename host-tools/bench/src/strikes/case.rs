//! A leg that is to be struck: drawn from the seed and its number.

use super::activity::Activity;
use crate::draw::{PAYLOAD_KG, distance, drawn, feasible, mixed, plant, pose};
use fastrand::Rng;
use leg_firmware::command::Compensation;
use leg_rig::plant_settings::PlantSettings;
use leg_rig::rig_file::RigFile;
use leg_sim::plant::Defect;
use std::fmt;

/// Strikes of a case; the last is by no fault.
pub(super) const SLOTS: u64 = 16;

/// Shortest way of a leg that is to be struck on it: 2°. On a shorter one there is nothing to see of a motor that does not turn.
const SHORTEST_WAY: f64 = 0.035;

/// How far a tared cell may be off, N, and one that homing has to tare.
pub(super) const TARED_N: f64 = 0.1;
const UNTARED_N: f64 = 2.0;

/// A leg and what it does.
#[derive(Clone, Debug)]
pub struct Case {
    /// Counted from 0.
    pub number: u64,
    /// The rig's name.
    pub rig: String,
    /// What the leg is doing.
    pub activity: Activity,
    /// Where it leans, degrees.
    pub azimuth_deg: f64,
    /// How far, degrees.
    pub tilt_deg: f64,
    /// kg.
    pub payload_kg: f64,
    /// N.
    pub pretension_n: f64,
    /// Which load it compensates.
    pub compensation: Compensation,
    /// Where it moves, if it does: azimuth and tilt, degrees.
    pub target_deg: [f64; 2],
    /// When it is struck, as a part of its way.
    pub part: f64,
    /// A push before: azimuth, degrees, and force, N; it is no harder than the pose can bear.
    pub push: Option<[f64; 2]>,
    /// A change of payload before, kg.
    pub step_kg: f64,
    /// Whether a leg at rest keeps station, without a host.
    pub keeps_station: bool,
    pub(super) file: RigFile,
    pub(super) plant: PlantSettings,
    pub(super) seed: u64,
}

/// The kind of fault of a slot; none is no fault.
pub(super) fn kind_of(case: u64, slot: u64) -> Option<usize> {
    let round = case / Activity::count();
    let kind = (round * (SLOTS - 1) + slot) % Defect::KINDS as u64;
    (slot + 1 < SLOTS).then_some(kind as usize)
}

/// The name of no fault.
pub(super) const UNSTRUCK: &str = "none";

/// Its name in scenarios.
pub(super) fn name_of(kind: Option<usize>) -> &'static str {
    let named = kind.and_then(|kind| Defect::descriptions().nth(kind));
    named.map_or(UNSTRUCK, |(name, _)| name)
}

impl Case {
    /// The case of a number, drawn from a seed.
    pub(super) fn new(seed: u64, rigs: &[(String, RigFile)], number: u64) -> Self {
        let seed = mixed(seed, number);
        let mut rng = Rng::with_seed(seed);
        let activity = Activity::nth(number);
        let round = number / Activity::count();
        let (rig, file) = &rigs[(round % rigs.len() as u64) as usize];
        let offset_n = if activity == Activity::Homing {
            UNTARED_N
        } else {
            TARED_N
        };
        let mut case = Self {
            number,
            rig: rig.clone(),
            activity,
            azimuth_deg: 0.0,
            tilt_deg: 0.0,
            payload_kg: 0.0,
            pretension_n: file.pretension_n,
            compensation: match rng.u32(0..10) {
                0 => Compensation::Off,
                1 => Compensation::Frozen,
                _ => Compensation::Estimated,
            },
            target_deg: [0.0; 2],
            part: rng.f64(),
            push: (rng.f64() < 0.3).then(|| [360.0 * rng.f64(), 10.0 * rng.f64()]),
            step_kg: 0.0,
            keeps_station: false,
            file: *file,
            plant: plant(file, offset_n, &mut rng),
            seed,
        };
        if activity != Activity::Homing {
            case.draw_pose(&mut rng);
        }
        // A leg keeps station by its estimate of the load alone.
        case.keeps_station = rng.bool()
            && activity == Activity::Following
            && case.compensation == Compensation::Estimated;
        case
    }

    /// A pose, a payload, a pretension and a target that the rig allows.
    fn draw_pose(&mut self, rng: &mut Rng) {
        for _ in 0..1000 {
            let [azimuth_deg, tilt_deg] = pose(&self.file, rng);
            let target_deg = pose(&self.file, rng);
            let payload_kg = drawn(rng, PAYLOAD_KG);
            let step_kg = if rng.f64() < 0.3 {
                rng.f64() - 0.5
            } else {
                0.0
            };
            let heavier_kg = payload_kg + step_kg;
            let ranges = [
                feasible(&self.file, [azimuth_deg, tilt_deg], payload_kg),
                feasible(&self.file, [azimuth_deg, tilt_deg], heavier_kg),
                feasible(&self.file, target_deg, payload_kg),
                feasible(&self.file, target_deg, heavier_kg),
                feasible(&self.file, [0.0, 0.0], 0.0),
            ];
            let low = ranges.iter().map(|range| range[0]).fold(0.0, f64::max);
            let high = ranges
                .iter()
                .map(|range| range[1])
                .fold(f64::INFINITY, f64::min);
            let moves = self.activity != Activity::Moving
                || distance(&[azimuth_deg, tilt_deg], &target_deg) > SHORTEST_WAY;
            if low < high && moves {
                self.azimuth_deg = azimuth_deg;
                self.tilt_deg = tilt_deg;
                self.target_deg = target_deg;
                self.payload_kg = payload_kg;
                self.step_kg = step_kg;
                self.pretension_n = low + (high - low) * rng.f64();
                return;
            }
        }
    }
}

impl fmt::Display for Case {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            formatter,
            "{} on {}: azimuth {:.1}°, tilt {:.1}°, {:.2} kg, pretension {:.1} N",
            self.activity.name(),
            self.rig,
            self.azimuth_deg,
            self.tilt_deg,
            self.payload_kg,
            self.pretension_n,
        )?;
        if self.activity == Activity::Moving {
            let [azimuth_deg, tilt_deg] = self.target_deg;
            write!(
                formatter,
                ", to azimuth {azimuth_deg:.1}°, tilt {tilt_deg:.1}°"
            )?;
        }
        write!(
            formatter,
            ", struck at {:.0} % of the way, compensation {:?}",
            100.0 * self.part,
            self.compensation
        )?;
        if self.keeps_station {
            formatter.write_str(", keeping station")?;
        }
        if self.step_kg != 0.0 {
            write!(
                formatter,
                ", payload changed by {:.2} kg before",
                self.step_kg
            )?;
        }
        if let Some([azimuth_deg, force_n]) = self.push {
            write!(
                formatter,
                ", pushed by up to {force_n:.1} N at {azimuth_deg:.0}° before"
            )?;
        }
        Ok(())
    }
}
