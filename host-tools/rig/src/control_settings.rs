//! The settings of the control law for a rig.

use crate::calibration::CompleteCalibration;
use crate::gains::Gains;
use crate::rig_file::RigFile;
use crate::rounding::{round_query, round_rig};
use leg_firmware::sensors::CODE_MAX;
use leg_firmware::settings::{AxisCalibration, BoardCalibration, Settings};

/// All settings: those of the rig file but for the gains, which a scenario may have changed. The zero of the tendons is
/// left open unless it is given.
#[must_use]
pub fn settings(rig: &RigFile, gains: &Gains, unstretched_at_zero_m: Option<[f64; 3]>) -> Settings {
    let query = round_query(&rig.query(0.0, 0.0, 0.0));
    let calibration = rig.calibration.complete(&rig.actuator);
    let axis = |i: usize| AxisCalibration {
        unstretched_at_zero_m: unstretched_at_zero_m.map(|zero| zero[i] as f32),
        ..axis(&calibration, i)
    };
    Settings {
        rig: round_rig(&rig.parameters).into(),
        support: query.support,
        tendons: query.tendons,
        f_min_n: query.f_min_n,
        f_max_n: query.f_max_n,
        pretension_n: query.pretension_n,
        tilt_max_sine: rig.tilt_deg.to_radians().sin() as f32,
        axes: [axis(0), axis(1), axis(2)],
        board: board(rig),
        motion: gains.motion,
        servo: gains.servo,
        estimation: gains.estimation,
        limits: gains.limits,
        homing: gains.homing,
    }
}

/// Without its zero.
fn axis(calibration: &CompleteCalibration, i: usize) -> AxisCalibration {
    AxisCalibration {
        m_per_count: (calibration.counts_sign[i] * calibration.m_per_count[i]) as f32,
        unstretched_at_zero_m: None,
        cell_n_per_code: calibration.cell_n_per_code[i] as f32,
        cell_zero_code: calibration.cell_zero_code[i] as f32,
        current_a_per_code: calibration.current_a_per_code[i] as f32,
    }
}

fn board(rig: &RigFile) -> BoardCalibration {
    let codes = f64::from(CODE_MAX);
    let [cold_c, hot_c] = rig.actuator.temperature_range_c;
    BoardCalibration {
        supply_v_per_code: (rig.actuator.supply_range_v / codes) as f32,
        temperature_c_per_code: ((hot_c - cold_c) / codes) as f32,
        temperature_at_zero_c: cold_c as f32,
    }
}
