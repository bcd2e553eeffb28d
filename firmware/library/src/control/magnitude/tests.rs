//! What is made of magnitudes.

use super::*;

/// The mean of ticks with these voltages, driving voltages and duties, of which each shows this much, A; and whether it is the current's.
fn mean(output: CurrentOutput, ticks: &[([f64; 3], f64)]) -> (f64, bool) {
    let mut magnitude = Magnitude::new(output);
    for &([voltage_v, driving_v, duty], shown_a) in ticks {
        let applied = Applied {
            voltage_v,
            driving_v,
        };
        magnitude.add(output, shown_a, &applied, duty);
    }
    let mean_a = ticks.iter().map(|(_, shown_a)| shown_a).sum::<f64>() / ticks.len() as f64;
    let found_a = magnitude.end(output, mean_a, 12.0);
    (found_a, magnitude.told())
}

const MAGNITUDE: CurrentOutput = CurrentOutput::Magnitude;
const WHEN_DRIVEN: CurrentOutput = CurrentOutput::MagnitudeWhenDriven;

fn assert_found(found: (f64, bool), expected: (f64, bool)) {
    // The parts of the period have 4096 steps.
    assert!((found.0 - expected.0).abs() < 4e-3, "{found:?}");
    assert_eq!(found.1, expected.1, "{found:?}");
}

#[test]
fn what_drives_a_current_gives_its_sign() {
    for sign in [1.0, -1.0] {
        let drives = [sign * 6.0, sign * 2.0, 0.25];
        assert_found(mean(MAGNITUDE, &[(drives, 1.5); 4]), (sign * 1.5, true));
        // At a quarter of the period, a quarter of the current.
        assert_found(mean(WHEN_DRIVEN, &[(drives, 0.375); 4]), (sign * 1.5, true));
        // The short-circuited motor brakes.
        let brakes = [0.0, -sign * 2.0, 0.0];
        assert_found(mean(MAGNITUDE, &[(brakes, 0.8); 4]), (-sign * 0.8, true));
    }
}

/// A pulse that is too short, a current against the voltage, a voltage that turns about.
#[test]
fn an_output_that_is_silent_tells_nothing() {
    let short = [2.0, 2.0, 0.0999];
    assert_found(mean(WHEN_DRIVEN, &[(short, 0.0); 4]), (0.0, false));
    let long = [2.5, 2.5, 0.104];
    assert_found(mean(WHEN_DRIVEN, &[(long, 0.104); 4]), (1.0, true));
    let one_short = [(long, 0.104), (short, 0.0), (long, 0.104), (long, 0.104)];
    assert_found(mean(WHEN_DRIVEN, &one_short), (1.0, false));
    let opposed = [6.0, -2.0, 0.25];
    assert_found(mean(WHEN_DRIVEN, &[(opposed, 0.0); 4]), (0.0, false));
    assert_found(mean(MAGNITUDE, &[(opposed, 0.6); 4]), (-0.6, false));
    let back = [-2.5, -2.5, 0.104];
    let (_, told) = mean(WHEN_DRIVEN, &[(long, 0.104), (back, 0.0), (back, 0.104)]);
    assert!(!told);
}

/// What an output reads that should be silent is what it reads, and no output reads more than its range.
#[test]
fn an_output_that_reads_all_the_same_is_not_silent() {
    let rests = [0.0; 3];
    assert_found(mean(WHEN_DRIVEN, &[(rests, 12.0); 4]), (12.0, false));
    let drives = [6.0, 6.0, 0.25];
    assert_found(mean(WHEN_DRIVEN, &[(drives, 12.0); 4]), (12.0, true));
    assert_found(mean(MAGNITUDE, &[(drives, -0.3); 4]), (0.0, true));
}

#[test]
fn each_mean_begins_anew() {
    let mut magnitude = Magnitude::new(WHEN_DRIVEN);
    let applied = |voltage_v: f64| Applied {
        voltage_v,
        driving_v: voltage_v,
    };
    magnitude.add(WHEN_DRIVEN, 0.0, &applied(1.0), 0.04);
    magnitude.end(WHEN_DRIVEN, 0.0, 12.0);
    assert!(!magnitude.told());
    magnitude.add(WHEN_DRIVEN, 0.5, &applied(12.0), 0.5);
    assert!((magnitude.end(WHEN_DRIVEN, 0.5, 12.0) - 1.0).abs() < 1e-3 && magnitude.told());
}
