//! Questions about the paper's leg, for whoever tries a link: leaning, with a payload, its tendons of constant stiffness.

use crate::kernels::KernelInput;
use crate::query::QueryMessage;
use leg_firmware::settings::TendonParameters;
use leg_model::{JointStiffness, RigParameters, StiffnessAt, SupportKind};

const AZIMUTH_RAD: f32 = 0.5;
const TILT_RAD: f32 = 0.3;
const PAYLOAD_KG: f32 = 1.0;
const PRETENSION_N: f32 = 70.0;
const F_MIN_N: f32 = 8.0;
const F_MAX_N: f32 = 150.0;
const STIFFNESS_N_PER_M: f32 = 1e5;

/// A query for the whole evaluation.
#[must_use]
pub fn query() -> QueryMessage {
    QueryMessage {
        azimuth_rad: AZIMUTH_RAD,
        tilt_rad: TILT_RAD,
        payload_kg: PAYLOAD_KG,
        pretension_n: PRETENSION_N,
        f_min_n: F_MIN_N,
        f_max_n: F_MAX_N,
        tendons: [const { TendonParameters::Constant(STIFFNESS_N_PER_M) }; 3],
        stiffness_at: StiffnessAt::Pretension,
        support: SupportKind::TorsionFree,
        joint: JointStiffness::none(),
        demand: None,
    }
}

/// Arguments for any kernel.
#[must_use]
pub fn kernel_input() -> KernelInput {
    KernelInput {
        rig: RigParameters::<f32, 3>::TABLE_1,
        azimuth_rad: AZIMUTH_RAD,
        tilt_rad: TILT_RAD,
        start_azimuth_rad: AZIMUTH_RAD,
        start_tilt_rad: 0.28,
        length_errors_m: [0.0; 3],
        payload_kg: PAYLOAD_KG,
        pretension_n: PRETENSION_N,
        f_min_n: F_MIN_N,
        f_max_n: F_MAX_N,
        stiffness_n_per_m: STIFFNESS_N_PER_M,
        demand_nm_per_rad: 100.0,
    }
}
