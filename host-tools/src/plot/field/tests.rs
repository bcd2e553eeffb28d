#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::isolines::isolines;
use super::runs::runs;
use super::{Field, Layout, save_png, save_svg};
use crate::plot::PlotError;

/// Tilt itself as the quantity; nothing on one side of the outer rows.
fn field() -> Field {
    let tilts_deg: Vec<f64> = (0..=6).map(|i| 5.0 * f64::from(i)).collect();
    let value = |tilt: f64, column: usize| (tilt < 20.0 || column < 18).then_some(tilt);
    let row = |tilt: f64| (0..36).map(move |column| value(tilt, column));
    let values = tilts_deg.iter().flat_map(|&tilt| row(tilt)).collect();
    Field {
        title: "Title".into(),
        quantity: "tilt (°)".into(),
        nothing: "no level".into(),
        azimuths: 36,
        values,
        tilts_deg,
    }
}

#[test]
fn lines_of_equal_value_are_where_the_value_is() {
    let field = field();
    let bands = field.bands().unwrap();
    let points: Vec<_> = isolines(&field, &bands).concat();
    // Beside poses without a value nothing can be said.
    let known = points.iter().filter(|(azimuth, _)| *azimuth < 160.0);
    assert!(known.clone().count() > 50);
    for (azimuth, tilt) in known {
        let off = bands.inner().iter().map(|level| (level - tilt).abs());
        assert!(off.fold(f64::MAX, f64::min) < 1e-9, "{azimuth}° {tilt}°");
    }
}

#[test]
fn every_cell_is_in_one_run() {
    let field = field();
    let runs = runs(&field, &field.bands().unwrap());
    let area = |(first, last): (f64, f64), (low, high): (f64, f64)| (last - first) * (high - low);
    let areas = runs.iter().map(|run| area(run.azimuths_deg, run.tilts_deg));
    let sum: f64 = areas.sum();
    assert!((sum - 360.0 * 30.0).abs() < 1e-6, "{sum}");
    assert!(runs.iter().any(|run| run.band.is_none()));
}

#[test]
fn both_layouts_name_everything() {
    let folder = tempfile::tempdir().unwrap();
    for (layout, axis) in [(Layout::Flat, "azimuth (°)"), (Layout::Polar, "330°")] {
        let path = folder.path().join("map.svg");
        save_svg(&field(), layout, &path).unwrap();
        let svg = std::fs::read_to_string(&path).unwrap();
        for text in ["Title", "tilt (°)", "no level", axis] {
            assert!(svg.contains(text), "{layout:?}: {text}");
        }
        save_png(&field(), layout, &folder.path().join("map.png")).unwrap();
    }
}

#[test]
fn a_field_without_values_is_refused() {
    let empty = Field {
        values: vec![None; 36 * 7],
        ..field()
    };
    let short = Field {
        values: vec![Some(1.0); 5],
        ..field()
    };
    let path = std::path::Path::new("never.svg");
    for field in [empty, short] {
        let refused = save_svg(&field, Layout::Flat, path);
        assert!(matches!(refused, Err(PlotError::Empty)));
    }
    assert!(!path.exists());
}
