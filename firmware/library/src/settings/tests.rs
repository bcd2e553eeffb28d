#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{OFFSET_MAX, SCALES, Settings, SettingsError};
use crate::leg::Leg;
use crate::sensors::{CODE_MAX, Sensors};

type Place = fn(&mut Settings) -> &mut f32;

fn shared() -> [(Place, u8); 3] {
    [
        (|s| &mut s.board.supply_v_per_code, 0),
        (|s| &mut s.board.temperature_c_per_code, 0),
        (|s| &mut s.board.temperature_at_zero_c, 0),
    ]
}

fn of_an_axis() -> [(Place, u8); 5] {
    [
        (|s| &mut s.axes[0].m_per_count, 1),
        (|s| &mut s.axes[1].cell_n_per_code, 2),
        (|s| &mut s.axes[2].current_a_per_code, 3),
        (|s| &mut s.axes[0].cell_zero_code, 1),
        (|s| s.axes[1].unstretched_at_zero_m.get_or_insert(0.0), 2),
    ]
}

#[test]
fn a_calibration_that_no_sensor_has_is_refused() {
    for value in [f32::NAN, f32::INFINITY, -1e38, 1e7] {
        for (place, axis) in shared().into_iter().chain(of_an_axis()) {
            let mut settings = Settings::for_table_1().unwrap();
            *place(&mut settings) = value;
            let refused = Err(SettingsError::Calibration { axis });
            assert_eq!(settings.check(), refused, "{value} at axis {axis}");
        }
    }
}

#[test]
fn a_code_that_stands_for_nothing_is_refused() {
    for value in [0.0, -0.0, 1e-38] {
        let mut settings = Settings::for_table_1().unwrap();
        settings.axes[1].cell_n_per_code = value;
        let refused = Err(SettingsError::Calibration { axis: 2 });
        assert_eq!(settings.check(), refused, "{value}");
    }
}

/// What is accepted gives numbers, with sensors at either end.
#[test]
fn the_greatest_calibration_gives_finite_numbers() {
    let mut settings = Settings::for_table_1().unwrap();
    for axis in &mut settings.axes {
        axis.m_per_count = *SCALES.end();
        axis.cell_n_per_code = *SCALES.end();
        axis.current_a_per_code = *SCALES.end();
        axis.cell_zero_code = -OFFSET_MAX;
        axis.unstretched_at_zero_m = Some(OFFSET_MAX);
    }
    let mut leg = Leg::<f32>::new(&settings).unwrap();
    for tick in 0..2_000_u16 {
        leg.tick(&Sensors {
            // The most that the counters turn in a tick.
            encoder_counts: [tick.wrapping_mul(32_767); 3],
            cell_codes: [CODE_MAX; 3],
            current_codes: [CODE_MAX; 3],
            ..Sensors::default()
        });
        leg.telemetry()
            .map(|number: f32| assert!(number.is_finite(), "tick {tick}: {number}"));
    }
}
