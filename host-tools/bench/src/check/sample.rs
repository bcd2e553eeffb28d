//! The states that are checked: a grid and a random sample of the workspace.

use super::{CheckedState, Stretch};
use fastrand::Rng;
use leg_firmware_bench::kernels::KernelInput;
use leg_model::{JointStiffness, Query, RigParameters, SupportKind, evaluate};
use std::f32::consts::TAU;

/// Every kind of support, with a joint that resists and one that does not. (A universal joint whose torsion is elastic
/// always resists.)
const SUPPORTS: [ElasticSupport; 7] = [
    rigid(SupportKind::TorsionFree),
    rigid(SupportKind::Universal),
    rigid(SupportKind::Spherical),
    elastic(SupportKind::TorsionFree, 0.0),
    elastic(SupportKind::Universal, 0.0),
    elastic(SupportKind::Spherical, 1.5),
    elastic(SupportKind::ElasticUniversal, 10.0),
];

/// How a support guides the leg, and how its joint resists.
type ElasticSupport = (SupportKind, JointStiffness<f32>);

const STRETCHES: [Stretch; 3] = [Stretch::Constant, Stretch::Curve, Stretch::CurveAtTension];

const fn rigid(kind: SupportKind) -> ElasticSupport {
    let joint = JointStiffness {
        bending_nm_per_rad: 0.0,
        torsion_nm_per_rad: 0.0,
        axial_compliance_m_per_n: 0.0,
    };
    (kind, joint)
}

const fn elastic(kind: SupportKind, torsion_nm_per_rad: f32) -> ElasticSupport {
    let joint = JointStiffness {
        bending_nm_per_rad: 2.0,
        torsion_nm_per_rad,
        axial_compliance_m_per_n: 1e-7,
    };
    (kind, joint)
}

/// How far the leg leans at most, degrees.
const TILT_MAX_DEG: f32 = 30.0;

const PAYLOAD_MAX_KG: f32 = 2.0;

/// Softest and stiffest tendon, N/m.
const STIFFNESSES_N_PER_M: (f32, f32) = (2e4, 2e5);

/// How far off the pose forward kinematics starts, degrees.
const START_OFF_DEG: f32 = 2.0;

/// Greatest bending stiffness demanded: often more than can be reached.
const DEMAND_MAX_NM_PER_RAD: f32 = 200.0;

/// Largest error of a measured length, m.
const LENGTH_ERROR_M: f32 = 1e-5;

/// Azimuths every 15°, tilts every 5° to 30°, four payloads, every support; the pretension and the tendons of the
/// paper's Fig. 9.
#[must_use]
pub fn grid() -> Vec<CheckedState> {
    let mut states = Vec::new();
    for (support, joint) in SUPPORTS {
        for payload_kg in [0.0, 0.5, 1.0, PAYLOAD_MAX_KG] {
            for tilt_deg in (0..=30_u8).step_by(5) {
                for azimuth_deg in (0..360_u16).step_by(15) {
                    let (azimuth_deg, tilt_deg) = (azimuth_deg.into(), f32::from(tilt_deg));
                    states.push(CheckedState {
                        input: KernelInput {
                            payload_kg,
                            ..input(azimuth_deg, tilt_deg, 0.0)
                        },
                        support,
                        joint,
                        stretch: Stretch::Constant,
                        demanded: false,
                    });
                }
            }
        }
    }
    states
}

/// Random states whose tensions keep their bounds, equally many for each support and each way to stretch; equal for
/// equal seeds.
#[must_use]
pub fn random(count: usize, seed: u64) -> Vec<CheckedState> {
    let mut rng = Rng::with_seed(seed);
    let supports = SUPPORTS
        .into_iter()
        .cycle()
        .zip(STRETCHES.into_iter().cycle());
    supports
        .take(count)
        .map(|(support, stretch)| feasible(&mut rng, support, stretch))
        .collect()
}

/// Draws until a draw is feasible.
fn feasible(rng: &mut Rng, support: ElasticSupport, stretch: Stretch) -> CheckedState {
    loop {
        let drawn = draw(rng, support, stretch);
        if let Some(state) = draw_feasible_pretension(rng, drawn) {
            return state;
        }
    }
}

/// A random pose, load and stiffness.
fn draw(rng: &mut Rng, support: ElasticSupport, stretch: Stretch) -> CheckedState {
    let azimuth_deg = 360.0 * rng.f32();
    let (softest, stiffest) = STIFFNESSES_N_PER_M;
    let start_azimuth_rad = TAU * rng.f32();
    let input = KernelInput {
        payload_kg: PAYLOAD_MAX_KG * rng.f32(),
        stiffness_n_per_m: softest * (stiffest / softest).powf(rng.f32()),
        demand_nm_per_rad: DEMAND_MAX_NM_PER_RAD * rng.f32(),
        length_errors_m: [(); 3].map(|()| LENGTH_ERROR_M * (2.0 * rng.f32() - 1.0)),
        ..input(azimuth_deg, TILT_MAX_DEG * rng.f32(), start_azimuth_rad)
    };
    let (support, joint) = support;
    CheckedState {
        input,
        support,
        joint,
        stretch,
        demanded: true,
    }
}

/// The state at a random pretension that keeps the bounds on the tensions, if there is one.
fn draw_feasible_pretension(rng: &mut Rng, mut state: CheckedState) -> Option<CheckedState> {
    let without_torsion = Query {
        support: SupportKind::TorsionFree.into(),
        ..state.query().ok()?
    };
    let [lowest, highest] = evaluate(&state.rig(), &without_torsion)
        .ok()?
        .pretension_range_n;
    state.input.pretension_n = to_f32(lowest + rng.f64() * (highest - lowest));
    // The twist of the other supports shifts the range.
    let tensions = evaluate(&state.rig(), &state.query().ok()?)
        .ok()?
        .tensions_n;
    let bounds = f64::from(state.input.f_min_n)..=f64::from(state.input.f_max_n);
    let keeps_bounds = lowest <= highest && tensions.iter().all(|tension| bounds.contains(tension));
    keeps_bounds.then_some(state)
}

/// The paper's rig at a pose, unloaded; forward kinematics starts 2° off in the direction `start_azimuth_rad`.
fn input(azimuth_deg: f32, tilt_deg: f32, start_azimuth_rad: f32) -> KernelInput {
    let azimuth_rad = azimuth_deg.to_radians();
    let start_x = tilt_deg * azimuth_rad.cos() + START_OFF_DEG * start_azimuth_rad.cos();
    let start_y = tilt_deg * azimuth_rad.sin() + START_OFF_DEG * start_azimuth_rad.sin();
    KernelInput {
        rig: RigParameters::<f32, 3>::TABLE_1,
        azimuth_rad,
        tilt_rad: tilt_deg.to_radians(),
        start_azimuth_rad: start_y.atan2(start_x),
        start_tilt_rad: start_x.hypot(start_y).to_radians(),
        length_errors_m: [0.0; 3],
        payload_kg: 0.0,
        pretension_n: 70.0,
        f_min_n: 8.0,
        f_max_n: 150.0,
        stiffness_n_per_m: 99_450.0,
        demand_nm_per_rad: 100.0,
    }
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "rounding is what is asked for"
)]
fn to_f32(value: f64) -> f32 {
    value as f32
}
