#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{AxisCalibration, BoardCalibration, Field, OutOfRange, Settings, SettingsError};
use crate::leg::Leg;
use crate::sensors::{CODE_MAX, Sensors};

/// The section, the axis and the name under which a value is refused.
fn refused(settings: &Settings) -> Option<(u8, u8, &'static str)> {
    match settings.check() {
        Err(SettingsError::OutOfRange(error)) => {
            let (_, field) = error.field().unwrap();
            assert!(error.to_string().contains(field.name), "{error}");
            Some((error.section, error.axis, field.name))
        }
        _ => None,
    }
}

fn values_out_of_range(field: &Field) -> [f32; 5] {
    let [low, high] = field.range;
    let low = low - 0.1 * low.abs().max(1e-3);
    [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, low, 1.1 * high]
}

#[test]
fn a_calibration_outside_its_range_is_refused_by_name() {
    for (number, field) in AxisCalibration::FIELDS.iter().enumerate() {
        for axis in 0..3 {
            for value in values_out_of_range(field) {
                let mut settings = Settings::table_1().unwrap();
                *settings.axes[axis].values_mut()[number] = value;
                // A count may have either sign.
                let low_magnitude = field.signed && value.abs() > field.range[0];
                if low_magnitude && value.is_finite() && value.abs() < field.range[1] {
                    continue;
                }
                let found = refused(&settings);
                assert_eq!(found, Some((5, 1 + axis as u8, field.name)), "{value}");
            }
        }
    }
    for (number, field) in BoardCalibration::FIELDS.iter().enumerate() {
        for value in values_out_of_range(field) {
            let mut settings = Settings::table_1().unwrap();
            *settings.board.values_mut()[number] = value;
            assert_eq!(refused(&settings), Some((7, 0, field.name)), "{value}");
        }
    }
}

/// A greatest tilt that is none would bound no move.
#[test]
fn a_greatest_tilt_beyond_60_degrees_is_refused() {
    for sine in [f32::NAN, f32::INFINITY, -0.5, 0.0, 0.87, 1.5] {
        let mut settings = Settings::table_1().unwrap();
        settings.tilt_max_sine = sine;
        let error = settings.check().unwrap_err().to_string();
        assert_eq!(
            error, "Tilt is beyond the range in which the model holds",
            "{sine}"
        );
    }
    let mut settings = Settings::table_1().unwrap();
    settings.tilt_max_sine = 60.0_f32.to_radians().sin();
    assert_eq!(settings.check(), Ok(()));
}

#[test]
fn a_zero_beyond_every_length_is_refused() {
    for value in [f32::NAN, f32::INFINITY, -1e3, 1e3] {
        let mut settings = Settings::table_1().unwrap();
        settings.axes[1].unstretched_at_zero_m = Some(value);
        let expected = Some((6, 2, "unstretched_at_zero_m"));
        assert_eq!(refused(&settings), expected, "{value}");
    }
}

#[test]
fn a_code_that_stands_for_nothing_is_refused() {
    for value in [0.0, -0.0, 1e-38] {
        let mut settings = Settings::table_1().unwrap();
        settings.axes[1].cell_n_per_code = value;
        let error = settings.check().unwrap_err().to_string();
        let expected = "calibration.cell_n_per_code of axis 2 is outside 0.000001 to 10";
        assert_eq!(error, expected, "{value}");
    }
}

#[test]
fn a_number_that_no_section_has_is_named_in_general() {
    let error = OutOfRange {
        section: 9,
        field: 0,
        axis: 0,
    };
    assert_eq!(error.to_string(), "a setting is outside its range");
}

/// What is accepted gives numbers, with sensors at either end.
#[test]
fn the_greatest_calibration_gives_finite_numbers() {
    let mut settings = Settings::table_1().unwrap();
    for axis in &mut settings.axes {
        for (field, value) in AxisCalibration::FIELDS.iter().zip(axis.values_mut()) {
            *value = field.range[1];
        }
        axis.unstretched_at_zero_m = Some(100.0);
    }
    settings.check().unwrap();
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
