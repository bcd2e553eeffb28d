//! Zeros of the currents.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::*;
use crate::sensors::{CURRENT_ZERO_PART, MIDDLE_CODE};
use crate::settings::CurrentOutputs;

/// After as many readings of these codes as it takes, the drivers being on from one of them on.
fn sought<T: Scalar>(codes: [u16; 3], driven_from: u16) -> Measurement<T> {
    let settings = Settings::table_1().unwrap();
    let mut measurement = Measurement::new(&settings);
    let mut sensors = Sensors::resting(&settings);
    for reading in 0..2 * ZERO_READINGS {
        // Two codes of noise, which a mean leaves out.
        sensors.current_codes = codes.map(|code| code - 1 + 2 * (reading % 2));
        if measurement.seeks_current_zeros() {
            measurement.seek_current_zeros(&sensors, reading >= driven_from);
        }
    }
    measurement
}

/// The current that is shown at a code, A.
fn shown_a<T: Scalar>(measurement: &mut Measurement<T>, code: u16) -> T {
    let mut sensors = Sensors::resting(&Settings::table_1().unwrap());
    sensors.current_codes[0] = code;
    // Begins a cycle.
    measurement.end_current(0);
    for _ in 0..CYCLE_TICKS {
        measurement.convert(&sensors);
    }
    measurement.end_current(0);
    measurement.convert(&sensors).currents_a[0]
}

#[test]
fn the_mean_code_of_a_driver_that_is_off_is_no_current() {
    fn check<T: Scalar>() {
        let mut measurement = sought::<T>([33_579, 32_000, 32_760], u16::MAX);
        assert_eq!(
            measurement.current_zeros(),
            [33_579.0, 32_000.0, 32_760.0].map(CurrentZero::Found)
        );
        assert!(shown_a(&mut measurement, 33_579) == T::zero());
    }
    check::<f32>();
    check::<f64>();
}

#[test]
fn what_is_too_far_from_the_nominal_zero_is_none() {
    let most = (CURRENT_ZERO_PART * MIDDLE_CODE) as u16;
    let half = CODE_MAX / 2;
    for (code, taken) in [
        (half + most, true),
        (half - most, true),
        (half + most + 1, false),
        (half - most - 1, false),
        (CODE_MAX - 1, false),
        (1, false),
    ] {
        let mut measurement = sought::<f32>([code; 3], u16::MAX);
        let [zero, ..] = measurement.current_zeros();
        let expected = if taken {
            CurrentZero::Found(code.into())
        } else {
            CurrentZero::Refused(code.into())
        };
        assert_eq!(zero, expected);
        let none = if taken { code } else { half };
        assert!(shown_a(&mut measurement, none) == 0.0, "{code}");
    }
}

#[test]
fn a_leg_that_is_driven_too_soon_has_no_zero() {
    for driven_from in [0, ZERO_READINGS - 1] {
        let zeros = sought::<f32>([33_000; 3], driven_from).current_zeros();
        assert_eq!(zeros, [CurrentZero::NotFound; 3]);
    }
    let zeros = sought::<f32>([33_000; 3], ZERO_READINGS).current_zeros();
    assert_eq!(zeros, [CurrentZero::Found(33_000.0); 3]);
}

/// Codes beyond the highest, which no converter gives, show no more than that.
#[test]
fn no_code_shows_more_than_the_range() {
    let mut measurement = Measurement::<f32>::new(&Settings::table_1().unwrap());
    let most_a = shown_a(&mut measurement, CODE_MAX);
    assert_eq!(shown_a(&mut measurement, u16::MAX), most_a);
    assert_eq!(shown_a(&mut measurement, 0), -most_a);
}

/// An output that shows magnitudes has its zero at the low end, as far from there as any output.
#[test]
fn the_zero_of_a_magnitude_is_near_the_lowest_code() {
    let mut settings = Settings::table_1().unwrap();
    settings.current_outputs = CurrentOutputs::new([
        CurrentOutput::Magnitude,
        CurrentOutput::MagnitudeWhenDriven,
        CurrentOutput::Bidirectional,
    ]);
    let mut measurement = Measurement::<f64>::new(&settings);
    let mut sensors = Sensors::resting(&settings);
    let most = (CURRENT_ZERO_PART * MIDDLE_CODE) as u16;
    sensors.current_codes = [most, most + 1, CODE_MAX / 2 + most];
    while measurement.seeks_current_zeros() {
        measurement.seek_current_zeros(&sensors, false);
    }
    let [found, refused, middle] = measurement.current_zeros();
    assert_eq!(found, CurrentZero::Found(most.into()));
    assert_eq!(refused, CurrentZero::Refused((most + 1).into()));
    assert_eq!(middle, CurrentZero::Found((CODE_MAX / 2 + most).into()));
    let a_per_code = f64::from(settings.axes[0].current_a_per_code);
    let shown_a = measurement.convert(&sensors).currents_a;
    assert_eq!(shown_a[0], 0.0);
    assert!((shown_a[1] / a_per_code - f64::from(most + 1)).abs() < 1e-6);
}
