//! The settings of the control law for a rig.

use crate::calibration::Calibration;
use crate::rig_file::RigFile;
use leg_firmware::sensors::CODE_MAX;
use leg_firmware::settings::{
    AxisCalibration, BoardCalibration, CurrentOutputs, Gains, Settings, TendonParameters,
};

/// All settings: those of the rig file but for the gains, which a scenario may have changed. The zero of the tendons is
/// left open unless it is given.
#[must_use]
pub fn settings(rig: &RigFile, gains: &Gains, unstretched_at_zero_m: Option<[f64; 3]>) -> Settings {
    let round = |value: f64| value as f32;
    let tendon = |tendon| TendonParameters::from_tendon(tendon, round);
    let axis = |i: usize| AxisCalibration {
        unstretched_at_zero_m: unstretched_at_zero_m.map(|zero| round(zero[i])),
        ..axis(&rig.calibration, i)
    };
    Settings {
        rig: rig.parameters.map(round),
        support: rig.support.kind(),
        joint: rig.support.joint().map(round),
        tendons: rig.tendons.each_ref().map(tendon),
        f_min_n: round(rig.f_min_n),
        f_max_n: round(rig.f_max_n),
        pretension_n: round(rig.pretension_n),
        tilt_max_sine: round(libm::sin(rig.tilt_deg.to_radians())),
        axes: [0, 1, 2].map(axis),
        current_outputs: CurrentOutputs::new(
            rig.actuators
                .each_ref()
                .map(|actuator| actuator.current_output),
        ),
        board: board(rig),
        motion: gains.motion,
        servos: gains.servos,
        estimation: gains.estimation,
        limits: gains.limits,
        homing: gains.homing,
        keeps_station: rig.keeps_station,
        recorded: rig.recorded,
    }
}

/// Without its zero.
fn axis(calibration: &Calibration, i: usize) -> AxisCalibration {
    AxisCalibration {
        m_per_count: (calibration.counts_sign[i] * calibration.m_per_count[i]) as f32,
        cell_n_per_code: calibration.cell_n_per_code[i] as f32,
        cell_zero_code: calibration.cell_zero_code[i] as f32,
        current_a_per_code: calibration.current_a_per_code[i] as f32,
        unstretched_at_zero_m: None,
    }
}

fn board(rig: &RigFile) -> BoardCalibration {
    let codes = f64::from(CODE_MAX);
    // The board has its supply and its temperature once, so every actuator says the same of them.
    let [actuator, ..] = &rig.actuators;
    let [cold_c, hot_c] = actuator.temperature_range_c;
    BoardCalibration {
        supply_v_per_code: (actuator.supply_range_v / codes) as f32,
        temperature_c_per_code: ((hot_c - cold_c) / codes) as f32,
        temperature_at_zero_c: cold_c as f32,
    }
}
