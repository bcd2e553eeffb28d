//! The settings of the control law for a rig and its actuators.

use crate::actuator::Actuator;
use crate::rig_file::RigFile;
use crate::rounding::{round_query, round_rig};
use leg_firmware::sensors::CODE_MAX;
use leg_firmware::settings::{
    AxisCalibration, BoardCalibration, Estimation, Homing, Limits, Motion, Servo, Settings,
};

/// Gains and limits, each section at its defaults unless given.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Gains {
    /// How the leg moves.
    pub motion: Motion,
    /// How a motor follows.
    pub servo: Servo,
    /// How pose and load are estimated.
    pub estimation: Estimation,
    /// What is taken as a fault.
    pub limits: Limits,
    /// How the zero is found.
    pub homing: Homing,
}

/// All settings. The zero of the tendons is left open unless it is given.
#[must_use]
pub fn settings(
    rig: &RigFile,
    actuator: &Actuator,
    gains: &Gains,
    unstretched_at_zero_m: Option<[f64; 3]>,
) -> Settings {
    let query = round_query(&rig.query(0.0, 0.0, 0.0));
    let codes = f64::from(CODE_MAX);
    let [cell_low_n, cell_high_n] = actuator.cell_range_n;
    let cell_n_per_code = (cell_high_n - cell_low_n) / codes;
    let [cold_c, hot_c] = actuator.temperature_range_c;
    let axis = |i: usize| AxisCalibration {
        m_per_count: actuator.m_per_count() as f32,
        unstretched_at_zero_m: unstretched_at_zero_m.map(|zero| zero[i] as f32),
        cell_n_per_code: cell_n_per_code as f32,
        cell_zero_code: (-cell_low_n / cell_n_per_code) as f32,
        current_a_per_code: (2.0 * actuator.current_range_a / codes) as f32,
    };
    Settings {
        rig: round_rig(&rig.parameters).into(),
        support: query.support,
        tendons: query.tendons,
        tension_floor_n: query.tension_floor_n,
        tension_ceiling_n: query.tension_ceiling_n,
        level_n: query.level_n,
        tilt_max_sine: rig.tilt_deg.to_radians().sin() as f32,
        axes: [axis(0), axis(1), axis(2)],
        board: BoardCalibration {
            supply_v_per_code: (actuator.supply_range_v / codes) as f32,
            temperature_c_per_code: ((hot_c - cold_c) / codes) as f32,
            temperature_at_zero_c: cold_c as f32,
        },
        motion: gains.motion,
        servo: Servo {
            back_emf_v_s_per_m: (actuator.torque_constant_nm_per_a / actuator.m_per_rad()) as f32,
            resistance_ohm: actuator.resistance_ohm as f32,
            ..gains.servo
        },
        estimation: gains.estimation,
        limits: gains.limits,
        homing: gains.homing,
    }
}
