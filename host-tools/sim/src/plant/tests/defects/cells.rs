//! The defects of load cells and their wires.

use super::{defective, held, sound};
use crate::plant::tests::{HELD, OFF, PlantSettings, driven, ready};
use crate::plant::{Defect, Plant};
use leg_firmware::sensors::CODE_MAX;

const N_PER_CODE: f64 = 250.0 / CODE_MAX as f64;

#[test]
fn cells() {
    let (first, sound) = (held().sense(), sound(400));
    for (defect, cell, code) in [
        (Defect::CellStuck(0), 0, first.cell_codes[0]),
        (Defect::CellStale(1), 1, first.cell_codes[1]),
        (Defect::CellSaturated(2), 2, CODE_MAX),
        (Defect::CellDead(1), 1, 0),
    ] {
        let (_, sensors) = defective(defect, 400);
        let mut expected = sound;
        expected.cell_codes[cell] = code;
        expected.cell_fresh[cell] = defect != Defect::CellStale(cell);
        assert_eq!(sensors.cell_codes, expected.cell_codes, "{defect:?}");
        assert_eq!(sensors.cell_fresh, expected.cell_fresh, "{defect:?}");
    }
    let (_, drifting) = defective(Defect::CellDrifting(2), 400);
    let drift = f64::from(drifting.cell_codes[2]) - f64::from(sound.cell_codes[2]);
    assert!((drift * N_PER_CODE - 0.25).abs() < 0.01, "{drift} codes");
    assert_eq!(drifting.cell_codes[..2], sound.cell_codes[..2]);
}

/// What cell 1 (0 here) of a leg at rest shows on average over 40 ms, N, so long after a defect began; and how far from that.
fn shown(defect: Option<Defect>, after_s: f64, seed: u64) -> (f64, f64) {
    let mut plant = Plant::new(&ready("table1"), &PlantSettings::default(), HELD, seed).unwrap();
    plant.sense();
    if let Some(defect) = defect {
        plant.set_defect(defect, true);
    }
    for _ in 0..(after_s * 8000.0) as u32 {
        plant.step(&OFF);
        plant.sense();
    }
    let readings: Vec<f64> = (0..320)
        .map(|_| {
            plant.step(&OFF);
            f64::from(plant.sense().cell_codes[0]) * N_PER_CODE - 20.0
        })
        .collect();
    let mean = readings.iter().sum::<f64>() / 320.0;
    let off = readings.iter().map(|n| (n - mean).abs());
    (mean, off.fold(0.0, f64::max))
}

#[test]
fn cells_that_lie() {
    let offset_n = PlantSettings::default().cell_offset_n;
    let tensions_n = held().truth().tensions_n;
    let [own, next] = [tensions_n[0], tensions_n[1]];
    let sound = own + offset_n[0];
    for (defect, after_s, expected) in [
        (None, 1.0, sound),
        (Some(Defect::CellExcitationLost(0)), 0.0, offset_n[0]),
        (Some(Defect::CellFades(0)), 0.23, sound - 0.5 * own),
        (Some(Defect::CellFades(0)), 1.0, offset_n[0]),
        (Some(Defect::CellFollows(0)), 0.0, next + offset_n[1]),
        (Some(Defect::CellHum(0)), 0.3, 105.0),
        (Some(Defect::CellGainStep(0)), 0.0, sound + 0.2 * own),
        (Some(Defect::CellGainStepDown(0)), 0.0, sound - 0.2 * own),
        (Some(Defect::CellGainDrift(0)), 4.98, sound + 0.1 * own),
        (Some(Defect::CellGainDrift(0)), 12.0, sound + 0.2 * own),
        (Some(Defect::CellGainDriftDown(0)), 12.0, sound - 0.2 * own),
        (Some(Defect::CellOffsetStep(0)), 0.0, sound + 10.0),
        (Some(Defect::CellOffsetStepDown(0)), 0.0, sound - 10.0),
        (Some(Defect::CellReversed(0)), 0.0, -20.0),
        (Some(Defect::CellCrosstalk(0)), 0.0, sound + 0.15 * next),
        (Some(Defect::CellSticks(0)), 0.0, sound),
        (Some(Defect::CellLate(0)), 0.03, sound),
        (Some(Defect::CellPwmNoise(0)), 0.0, sound),
        (Some(Defect::CellsSwapped), 0.0, next + offset_n[1]),
        (Some(Defect::ExcitationLost), 0.0, offset_n[0]),
        (Some(Defect::ExcitationSags), 0.0, sound - 0.2 * own),
        (Some(Defect::CellWanders(1)), 1.0, sound),
        (Some(Defect::CellExcitationLost(1)), 1.0, sound),
    ] {
        let (mean, off) = shown(defect, after_s, 1);
        let (swing, fading) = match defect {
            Some(Defect::CellHum(_)) => (10.0, 0.0),
            Some(Defect::CellFades(_)) if after_s < 0.5 => (0.0, 0.04 * own),
            _ => (0.0, 0.0),
        };
        assert!(
            (mean - expected).abs() < 0.1,
            "{defect:?}: {mean} N, not {expected} N"
        );
        let noise = off - swing - fading;
        assert!((-0.1..0.3).contains(&noise), "{defect:?}: {off} N");
    }
}

/// Under a weight that is hung on in the place of the tendon.
#[test]
fn cells_that_follow_late_or_not_wholly() {
    let before = held().truth().tensions_n[0] + PlantSettings::default().cell_offset_n[0];
    let after = 120.0 + PlantSettings::default().cell_offset_n[0];
    for (defect, ticks, expected) in [
        (None, 0, after),
        (Some(Defect::CellLate(0)), 150, before),
        (Some(Defect::CellLate(0)), 170, after),
        (Some(Defect::CellSticks(0)), 100, after - 5.0),
    ] {
        let mut plant = held();
        for _ in 0..400 {
            plant.sense();
            plant.step(&OFF);
        }
        if let Some(defect) = defect {
            plant.set_defect(defect, true);
        }
        plant.hang_on_cell(0, Some(120.0));
        let mut shown = f64::NAN;
        for _ in 0..=ticks {
            shown = f64::from(plant.sense().cell_codes[0]) * N_PER_CODE - 20.0;
            plant.step(&OFF);
        }
        assert!((shown - expected).abs() < 0.3, "{defect:?}: {shown} N");
    }
}

#[test]
fn a_motors_wire_disturbs_the_cell_beside_it_while_it_is_driven() {
    let mut plant = held();
    plant.set_defect(Defect::CellPwmNoise(1), true);
    plant.hang_on_cell(1, Some(50.0));
    let shown: Vec<f64> = (0..400)
        .map(|_| {
            plant.step(&driven([0.0, 0.5, 0.0]));
            f64::from(plant.sense().cell_codes[1]) * N_PER_CODE - 20.0
        })
        .collect();
    let mean = shown.iter().sum::<f64>() / 400.0;
    let noise = (shown.iter().map(|n| (n - mean).powi(2)).sum::<f64>() / 400.0).sqrt();
    let expected = 50.0 + PlantSettings::default().cell_offset_n[1] + 10.0;
    assert!((mean - expected).abs() < 2.0, "{mean} N, not {expected} N");
    assert!((8.0..12.0).contains(&noise), "{noise} N");
}

/// As far as is said, on average over seeds, and another way for each; never beyond the range.
#[test]
fn a_torn_wire_wanders() {
    let wandering = Some(Defect::CellWanders(0));
    let start = shown(None, 0.0, 1).0;
    let found: Vec<f64> = (1..=60)
        .map(|seed| shown(wandering, 0.25, seed).0 - start)
        .collect();
    let mean_square = found.iter().map(|n| n * n).sum::<f64>() / 60.0;
    // 20 N/√s for about 0.27 s.
    assert!(
        (7.0..14.0).contains(&mean_square.sqrt()),
        "{mean_square} N²"
    );
    assert_eq!(shown(wandering, 0.25, 1), shown(wandering, 0.25, 1));
    assert!(found.iter().any(|n| *n > 3.0) && found.iter().any(|n| *n < -3.0));
    let (late, _) = shown(wandering, 60.0, 1);
    assert!((-20.1..230.1).contains(&late), "{late} N");
}
