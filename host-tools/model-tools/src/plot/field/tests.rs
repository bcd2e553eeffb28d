#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::isolines::isolines;
use super::runs::{Shade, runs};
use super::{Layout, PlotField, PoseSample, save_both};
use crate::plot::PlotError;

/// Tilt itself as the quantity, with room for it up to 24° at azimuths from 180° to 330°; no result near 355°. What has
/// no room has some of the wider kind to 240°.
fn field() -> PlotField {
    let tilts_deg: Vec<f64> = (0..=6).map(|i| 5.0 * f64::from(i)).collect();
    let sample = |tilt: f64, column: u32| {
        let room = if (18..34).contains(&column) {
            24.0 - tilt
        } else {
            1.0
        };
        let wider_room = if column < 24 { 1.0 } else { room };
        (column != 35).then_some(PoseSample {
            value: Some(tilt),
            room,
            wider_room,
        })
    };
    let row = |tilt: f64| (0..36).map(move |column| sample(tilt, column));
    let samples = tilts_deg.iter().flat_map(|&tilt| row(tilt)).collect();
    PlotField {
        title: "Title".into(),
        quantity: "tilt".into(),
        unit: "°C".into(),
        border_label: "little room".into(),
        exterior_label: "no room".into(),
        azimuths: 36,
        samples,
        tilts_deg,
    }
}

#[test]
fn lines_of_equal_value_are_where_the_value_is_and_end_with_the_region() {
    let field = field();
    let bands = field.bands().unwrap();
    let points: Vec<_> = isolines(&field, &bands).concat();
    // Beside poses without a result nothing can be said.
    let known = points.iter().filter(|(azimuth, _)| *azimuth < 330.0);
    assert!(known.clone().count() > 100);
    for (azimuth, tilt) in known.clone() {
        let off = bands.inner().iter().map(|level| (level - tilt).abs());
        assert!(off.fold(f64::MAX, f64::min) < 1e-9, "{azimuth}° {tilt}°");
        let outside = (180.0..330.0).contains(azimuth) && *tilt > 24.0;
        assert!(!outside, "{azimuth}° {tilt}°");
    }
    assert!(known.clone().any(|(azimuth, _)| *azimuth == 0.0));
    assert!(known.clone().any(|(_, tilt)| *tilt > 24.0));
}

#[test]
fn every_place_is_in_one_run_of_its_shade() {
    let field = field();
    let runs = runs(&field, &field.bands().unwrap());
    let area = |wanted: fn(&Shade) -> bool| {
        let runs = runs.iter().filter(|run| wanted(&run.shade));
        let areas = runs.map(|run| {
            let ((first, last), (low, high)) = (run.azimuths_deg, run.tilts_deg);
            (last - first) * (high - low)
        });
        areas.sum::<f64>()
    };
    let no_result = area(|shade| *shade == Shade::NoResult);
    assert!((no_result - 20.0 * 30.0).abs() < 1e-6, "{no_result}");
    // The border is between the poses at 20° and 25°, to the height of a fine one.
    let outside = area(|shade| *shade == Shade::Exterior);
    assert!((outside - 95.0 * 6.0).abs() < 100.0, "{outside}");
    let between = area(|shade| *shade == Shade::Border);
    assert!((between - 60.0 * 6.0).abs() < 65.0, "{between}");
    let sum = area(|_| true);
    assert!((sum - 360.0 * 30.0).abs() < 1e-6, "{sum}");
}

#[test]
fn both_layouts_name_everything() {
    let directory = tempfile::tempdir().unwrap();
    for (layout, axis) in [(Layout::Flat, "azimuth (°)"), (Layout::Polar, "330°")] {
        let path = save_both(&field(), layout, &directory.path().join("map")).unwrap();
        let svg = std::fs::read_to_string(&path).unwrap();
        for text in [
            "Title",
            ">\ntilt\n<",
            "°C",
            "little room",
            "no room",
            "no result",
            axis,
        ] {
            assert!(svg.contains(text), "{layout:?}: {text}");
        }
        assert!(path.with_extension("png").exists());
    }
}

#[test]
fn a_field_with_nothing_to_show_is_refused() {
    let empty = PlotField {
        samples: vec![None; 36 * 7],
        ..field()
    };
    let short = PlotField {
        samples: field().samples[..5].to_vec(),
        ..field()
    };
    let directory = tempfile::tempdir().unwrap();
    let stem = directory.path().join("never");
    for field in [empty, short] {
        let refused = save_both(&field, Layout::Flat, &stem);
        assert!(matches!(refused, Err(PlotError::Empty)));
    }
    assert!(!stem.with_extension("svg").exists());
}

#[test]
fn a_field_without_a_value_shows_where_they_would_be() {
    let unknown = |sample: Option<PoseSample>| {
        let sample = sample?;
        Some(PoseSample {
            value: None,
            ..sample
        })
    };
    let field = PlotField {
        samples: field().samples.into_iter().map(unknown).collect(),
        ..field()
    };
    let directory = tempfile::tempdir().unwrap();
    let path = save_both(&field, Layout::Polar, &directory.path().join("map")).unwrap();
    let svg = std::fs::read_to_string(&path).unwrap();
    for text in ["little room", "no room", "no result"] {
        assert!(svg.contains(text), "{text}");
    }
}
