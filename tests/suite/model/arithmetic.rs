//! The model's own arithmetic in f32 against f64 and the platform's square root.

use leg_model::Scalar;
use proptest::prelude::{any, proptest};

/// sin and cos of `x`, and how far they are from those of f64.
fn sin_cos_error(x: f32) -> f64 {
    let (sin, cos) = Scalar::sin_cos(x);
    let (expected_sin, expected_cos) = f64::from(x).sin_cos();
    let (sin, cos) = (f64::from(sin) - expected_sin, f64::from(cos) - expected_cos);
    sin.abs().max(cos.abs())
}

#[test]
fn sine_and_cosine_are_within_1e_7_over_ten_turns() {
    // An odd number of steps over ±63 rad, which covers the azimuths that the model serves, meets every quadrant.
    let steps = 1_000_003_i32;
    let worst = (-steps..=steps)
        .map(|i| sin_cos_error(63.0 * (i as f32) / (steps as f32)))
        .fold(0.0, f64::max);
    assert!(worst <= 1e-7, "off by {worst:e}");
}

#[test]
fn sine_and_cosine_are_exact_at_zero_and_near_multiples_of_a_quarter_turn() {
    assert_eq!(Scalar::sin_cos(0.0_f32), (0.0, 1.0));
    for quarter in -40..=40 {
        let x = (f64::from(quarter) * std::f64::consts::FRAC_PI_2) as f32;
        for x in [x.next_down(), x, x.next_up()] {
            let error = sin_cos_error(x);
            assert!(error <= 1e-7, "sin_cos({x}) is off by {error:e}");
        }
    }
}

#[test]
fn sine_and_cosine_of_what_is_no_angle_are_no_numbers() {
    for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let (sin, cos) = Scalar::sin_cos(x);
        assert!(
            sin.is_nan() && cos.is_nan(),
            "sin_cos({x}) = ({sin}, {cos})"
        );
    }
}

proptest! {
    #[test]
    fn sine_is_odd_cosine_is_even_and_their_squares_add_up_to_one(x in -63.0_f32..63.0) {
        let (sin, cos) = Scalar::sin_cos(x);
        assert_eq!(Scalar::sin_cos(-x), (-sin, cos));
        // Each is off by 1e-7 at most, its square by 2e-7.
        let sum = f64::from(sin).powi(2) + f64::from(cos).powi(2);
        assert!((sum - 1.0).abs() <= 2.9e-7, "{sum}");
    }

    #[test]
    fn the_square_root_has_the_bits_of_ieee_754(bits in proptest::collection::vec(any::<u32>(), 1_000)) {
        for x in bits.into_iter().map(f32::from_bits) {
            let (root, expected) = (Scalar::sqrt(x), x.sqrt());
            assert!(root.to_bits() == expected.to_bits() || (root.is_nan() && expected.is_nan()), "sqrt({x:e})");
        }
    }
}

#[test]
fn the_square_root_of_the_special_values_is_that_of_ieee_754() {
    for x in [
        0.0,
        -0.0,
        f32::MIN_POSITIVE,
        f32::from_bits(1),
        f32::MAX,
        f32::INFINITY,
    ] {
        assert_eq!(Scalar::sqrt(x).to_bits(), x.sqrt().to_bits(), "sqrt({x:e})");
    }
    assert!(Scalar::sqrt(-1.0_f32).is_nan());
    assert!(Scalar::sqrt(f32::NAN).is_nan());
}
