//! What the rules start from: the data of motors, tendons and leg.

use crate::actuator::Actuator;
use crate::number::decimal;
use crate::rig_file::RigFile;
use leg_firmware::control::UNKNOWN_MOVED_KG;
use leg_model::Elasticity;

/// From what the rules derive: of one motor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Basis {
    pub actuator: Actuator,
    /// Highest tension allowed, N.
    pub f_max_n: f64,
    /// A count of the axis, m.
    pub m_per_count: f64,
    /// The smallest range of the three current sensors, A.
    pub least_current_range_a: f64,
    /// The fastest that a tendon moves while the leg turns, m by rad.
    pub lever_m: f64,
    /// The least stiffness of a tendon between the minimum tension and the pretension, N/m.
    pub least_stiffness_n_per_m: f64,
    /// The most that a tendon stretches at the highest tension, m.
    pub stretch_m: f64,
    /// The greatest stiffness of a tendon at the tensions of homing, N/m.
    pub homing_stiffness_n_per_m: f64,
    /// The most that a tendon comes in as it lifts the leg from straight down, m by N.
    pub lift_m_per_n: f64,
    /// The most that a tendon stretches where it is found taut, m.
    pub touch_stretch_m: f64,
    /// Inertia of the leg about its joint, kg·m².
    pub inertia_kg_m2: f64,
    /// The same with a payload that nothing has shown yet, kg·m².
    pub moved_inertia_kg_m2: f64,
    /// What turns the leg back straight down, without its tendons, N·m/rad.
    pub hanging_nm_per_rad: f64,
}

/// The tension at which a tendon counts as taut, N, where it is not given.
pub(crate) const TOUCH_N: f64 = 2.0;

/// The highest tension of homing, N, where it is not given.
pub(crate) const HOMING_MAX_N: f64 = 15.0;

impl Basis {
    /// Of each motor.
    pub fn new_all(file: &RigFile) -> [Self; 3] {
        let (lever_m, least_stiffness_n_per_m) = (lever_m(file), least_stiffness_n_per_m(file));
        let highest_m = stretch_m(file, file.f_max_n);
        let homing_n = file.f_max_n.min(HOMING_MAX_N);
        let all = file.tendons.iter();
        let homing_stiffnesses = all.filter_map(|tendon| tendon.stiffness(homing_n).ok());
        let homing_stiffness_n_per_m = homing_stiffnesses.fold(0.0, f64::max);
        let ranges_a = file
            .actuators
            .iter()
            .map(|actuator| actuator.current_range_a);
        let least_current_range_a = ranges_a.fold(f64::INFINITY, f64::min);
        let touch_stretch_m = stretch_m(file, TOUCH_N);
        let hanging_nm_per_rad = hanging_nm_per_rad(file);
        let lift_m_per_n = lift_m_per_n(file, hanging_nm_per_rad);
        let tip_m = file.parameters.joint_length_m + file.parameters.leg_length_m;
        let inertia_kg_m2 = file.plant.transverse_inertia_kg_m2(&file.parameters);
        std::array::from_fn(|motor| Self {
            actuator: file.actuators[motor],
            f_max_n: file.f_max_n,
            m_per_count: file.calibration.m_per_count[motor],
            least_current_range_a,
            lever_m,
            least_stiffness_n_per_m,
            stretch_m: highest_m,
            homing_stiffness_n_per_m,
            lift_m_per_n,
            touch_stretch_m,
            inertia_kg_m2,
            moved_inertia_kg_m2: inertia_kg_m2 + decimal(UNKNOWN_MOVED_KG) * tip_m * tip_m,
            hanging_nm_per_rad,
        })
    }
}

/// The longest lever of a tendon over the workspace, m: at its edge and straight down, without a payload. Poses that the model
/// cannot balance are left out.
fn lever_m(file: &RigFile) -> f64 {
    let edge = (0..12).map(|part| (30.0 * f64::from(part), file.tilt_deg));
    let mut longest = 0.0_f64;
    for (azimuth_deg, tilt_deg) in edge.chain([(0.0, 0.0)]) {
        let query = file.query(azimuth_deg, tilt_deg, 0.0);
        let Ok(pose) = leg_model::evaluate(&file.parameters, &query) else {
            continue;
        };
        let [x, y, _] = pose.moment_map_m;
        for tendon in 0..x.len() {
            longest = longest.max(libm::hypot(x[tendon], y[tendon]));
        }
    }
    longest
}

/// Parts of the way from the minimum tension to the pretension at which the stiffness is looked at.
const STIFFNESS_PARTS: u32 = 32;

/// Of the softest tendon; one whose curve does not reach the pretension is refused elsewhere.
fn least_stiffness_n_per_m(file: &RigFile) -> f64 {
    let (low_n, high_n) = (file.f_min_n, file.pretension_n);
    let tensions_n = (0..=STIFFNESS_PARTS).map(|step| {
        let part = f64::from(step) / f64::from(STIFFNESS_PARTS);
        low_n + part * (high_n - low_n)
    });
    let known = tensions_n.flat_map(|tension_n| {
        let all = file.tendons.iter();
        all.filter_map(move |tendon| tendon.stiffness(tension_n).ok())
    });
    known.fold(f64::INFINITY, f64::min)
}

/// Of the softest tendon at a tension; one whose curve does not reach it is refused elsewhere.
pub(in crate::rig_file) fn stretch_m(file: &RigFile, tension_n: f64) -> f64 {
    let all = file.tendons.iter();
    let known = all.filter_map(|tendon| tendon.elongation(tension_n).ok());
    known.fold(0.0, f64::max)
}

/// Of its weight and its joint.
fn hanging_nm_per_rad(file: &RigFile) -> f64 {
    let parameters = &file.parameters;
    let weight_n = parameters.leg_mass_kg * parameters.gravity_m_per_s2;
    let bending_nm_per_rad = file.support.joint().bending_nm_per_rad;
    (weight_n * parameters.leg_centroid_m + bending_nm_per_rad).max(1e-9)
}

/// A tendon that pulls alone turns the leg against its weight and its joint.
fn lift_m_per_n(file: &RigFile, hanging_nm_per_rad: f64) -> f64 {
    let parameters = &file.parameters;
    let Ok(hanging) = leg_model::evaluate(parameters, &file.query(0.0, 0.0, 0.0)) else {
        return 0.0;
    };
    let [x, y, _] = hanging.moment_map_m;
    let levers_m = x.iter().zip(y.iter()).map(|(x, y)| libm::hypot(*x, *y));
    let lever_m = levers_m.fold(0.0, f64::max);
    lever_m * lever_m / hanging_nm_per_rad
}
