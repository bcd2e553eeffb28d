//! The load cells' errors.

use super::{HELD, PlantSettings, plant, ready};
use crate::plant::sensing::code;
use leg_firmware::sensors::CODE_MAX;

#[test]
fn codes_are_rounded_and_saturate() {
    let range = [-20.0, 230.0];
    assert_eq!(code(-20.0, range), 0);
    assert_eq!(code(230.0, range), CODE_MAX);
    assert_eq!(code(105.0, range), CODE_MAX / 2);
    assert_eq!([code(-1e9, range), code(1e9, range)], [0, CODE_MAX]);
    assert_eq!(code(-20.0 + 250.0 * 10.6 / f64::from(CODE_MAX), range), 11);
}

#[test]
fn a_cell_shows_its_gain_offset_and_noise() {
    let settings = PlantSettings {
        cell_gain_error: [0.01, 0.0, -0.02],
        ..PlantSettings::default()
    };
    let mut plant = plant(&ready("table1"), &settings, HELD);
    let tensions = plant.truth().tensions_n;
    let readings: Vec<_> = (0..20_000).map(|_| plant.sense().cell_codes).collect();
    for i in 0..3 {
        let newtons = |codes: &[u16; 3]| f64::from(codes[i]) * 250.0 / f64::from(CODE_MAX) - 20.0;
        let count = readings.len() as f64;
        let mean = readings.iter().map(newtons).sum::<f64>() / count;
        let square = |codes: &[u16; 3]| (newtons(codes) - mean).powi(2);
        let noise = (readings.iter().map(square).sum::<f64>() / count).sqrt();
        let shown = tensions[i] * (1.0 + settings.cell_gain_error[i]) + settings.cell_offset_n[i];
        assert!((mean - shown).abs() < 2e-3, "{mean} N, not {shown} N");
        assert!((noise - 0.05).abs() < 1e-3, "{noise} N");
    }
}
