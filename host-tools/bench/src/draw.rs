//! What campaigns draw at random: poses, payloads and the errors of a calibrated leg.

use fastrand::Rng;
use leg_base::angles;
use leg_model::evaluate;
use leg_rig::plant_settings::PlantSettings;
use leg_rig::rig_file::RigFile;

/// Farthest that a leg leans, degrees, and its heaviest payload, kg.
const TILT_DEG: f64 = 30.0;
pub(crate) const PAYLOAD_KG: f64 = 2.0;

/// How far load cells may be off after their calibration, as a part, and tendons from their curve.
pub(crate) const CELL_GAIN: f64 = 0.002;
pub(crate) const CURVE: f64 = 0.01;

/// A simulated leg whose cells are off by no more than an offset, N, and by what a calibration leaves.
pub(crate) fn plant(file: &RigFile, offset_n: f64, rng: &mut Rng) -> PlantSettings {
    let mut even = |half: f64| half * (2.0 * rng.f64() - 1.0);
    PlantSettings {
        cell_gain_error: std::array::from_fn(|_| even(CELL_GAIN)),
        cell_offset_n: std::array::from_fn(|_| even(offset_n)),
        curve_error: even(CURVE),
        ..file.plant
    }
}

/// The simulated leg of a rig after homing, which has tared its cells.
pub(crate) fn homed(file: &RigFile) -> PlantSettings {
    PlantSettings {
        cell_offset_n: [0.0; 3],
        ..file.plant
    }
}

/// What the number of a campaign begins with: its own seed, and its rig, in turn.
pub(crate) fn numbered(
    seed: u64,
    rigs: &[(String, RigFile)],
    number: u64,
) -> (u64, &(String, RigFile)) {
    (
        mixed(seed, number),
        &rigs[(number % rigs.len() as u64) as usize],
    )
}

/// One in five at each end: that is where things break.
pub(crate) fn drawn(rng: &mut Rng, highest: f64) -> f64 {
    match rng.u32(0..10) {
        0 | 1 => highest,
        2 | 3 => 0.0,
        _ => highest * rng.f64(),
    }
}

/// Azimuth and tilt, degrees.
pub(crate) fn pose(file: &RigFile, rng: &mut Rng) -> [f64; 2] {
    let azimuth_deg = if rng.f64() < 0.3 {
        // Planes of symmetry.
        30.0 * f64::from(rng.u32(0..12))
    } else {
        360.0 * rng.f64()
    };
    // A number in f32 must not be beyond the end.
    [azimuth_deg, drawn(rng, TILT_DEG.min(file.tilt_deg) - 1e-3)]
}

/// The distance of two poses as directions' horizontal components.
pub(crate) fn distance(a: &[f64; 2], b: &[f64; 2]) -> f64 {
    let [[ax, ay], [bx, by]] = [a, b].map(|&[azimuth, tilt]| angles::direction(azimuth, tilt));
    (ax - bx).hypot(ay - by)
}

/// The lowest and highest pretension of a pose with a payload, N; of no width where there is none.
pub(crate) fn feasible(
    file: &RigFile,
    [azimuth_deg, tilt_deg]: [f64; 2],
    payload_kg: f64,
) -> [f64; 2] {
    if !(0.0..=PAYLOAD_KG).contains(&payload_kg) {
        return [f64::INFINITY, 0.0];
    }
    let query = file.query(azimuth_deg, tilt_deg, payload_kg);
    let found = evaluate(&file.parameters, &query);
    // What the estimate of the load is off by must not end a feasible pretension.
    found.map_or([f64::INFINITY, 0.0], |found| {
        let [low, high] = found.pretension_range_n;
        [low + 1.0, high - 1.0]
    })
}

/// Another number for every pair.
pub(crate) fn mixed(seed: u64, number: u64) -> u64 {
    let mut rng = Rng::with_seed(seed);
    rng.u64(..) ^ Rng::with_seed(number).u64(..)
}
