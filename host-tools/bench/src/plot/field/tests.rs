#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::layers::{BORDER, EXTERIOR, Layer, NO_RESULT, layers};
use super::{Layout, PlotField, PoseSample, save};
use crate::plot::PlotError;
use plotters::style::RGBColor;

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

/// What the map shows at a place: the colour of the uppermost area there.
fn colour_at(layers: &[Layer], place: (f64, f64)) -> RGBColor {
    let mut areas = layers.iter().rev().filter_map(|layer| match layer {
        Layer::Area(outline, colour) => Some((outline, colour)),
        Layer::Line(_) => None,
    });
    *areas
        .find(|(outline, _)| encloses(outline, place))
        .unwrap()
        .1
}

/// Whether an outline goes around a place: a ray from there meets it an odd number of times.
fn encloses(outline: &[(f64, f64)], (x, y): (f64, f64)) -> bool {
    let ends = outline.iter().zip(outline.iter().cycle().skip(1));
    let meets = ends.filter(|((x0, y0), (x1, y1))| {
        (*y0 > y) != (*y1 > y) && x < x0 + (x1 - x0) * (y - y0) / (y1 - y0)
    });
    meets.count() % 2 == 1
}

#[test]
fn lines_of_equal_value_are_where_the_value_is() {
    let field = field();
    let bands = field.bands().unwrap();
    let lines = layers(&field, &bands)
        .into_iter()
        .filter_map(|layer| match layer {
            Layer::Line(points) => Some(points),
            Layer::Area(..) => None,
        });
    let points: Vec<_> = lines.flatten().collect();
    // Beside poses without a result nothing can be said: it is hidden.
    let known = points.iter().filter(|(azimuth, _)| *azimuth < 330.0);
    assert!(known.clone().count() > 100);
    for (azimuth, tilt) in known.clone() {
        let off = bands.inner().iter().map(|level| (level - tilt).abs());
        assert!(off.fold(f64::MAX, f64::min) < 1e-9, "{azimuth}° {tilt}°");
    }
    assert!(known.clone().any(|(azimuth, _)| *azimuth == 0.0));
    assert!(known.clone().any(|(_, tilt)| *tilt > 24.0));
}

/// Between the poses, too: the border is where the room ends, not at the nearest pose.
#[test]
fn every_place_has_the_colour_of_what_is_there() {
    let field = field();
    let bands = field.bands().unwrap();
    let layers = layers(&field, &bands);
    let band = |tilt: f64| bands.colour(bands.band(tilt));
    for tilt in (1..300).map(|i| 0.1 * f64::from(i)) {
        let is_level = |level: &f64| (level - tilt).abs() < 0.05;
        if bands.inner().iter().any(is_level) || (tilt - 24.0).abs() < 0.05 {
            continue;
        }
        let beyond = |shade| if tilt > 24.0 { shade } else { band(tilt) };
        for (azimuth, expected) in [
            (0.5, band(tilt)),
            (90.0, band(tilt)),
            (195.0, beyond(BORDER)),
            (271.5, beyond(EXTERIOR)),
            (345.0, NO_RESULT),
            (359.0, NO_RESULT),
        ] {
            assert_eq!(
                colour_at(&layers, (azimuth, tilt)),
                expected,
                "{azimuth}° {tilt}°"
            );
        }
    }
}

/// An island of low values in the midst of high ones, and one of high ones in that.
#[test]
fn a_hole_shows_what_is_in_it() {
    let far =
        |column: u32, row: u32| f64::from(column.abs_diff(18)).hypot(f64::from(row.abs_diff(18)));
    let value = |column, row| {
        let far = far(column, row);
        if far < 3.0 { 9.5 } else { far.min(9.5) }
    };
    let known = |value| PoseSample {
        value: Some(value),
        room: 1.0,
        wider_room: 1.0,
    };
    let row = |row| (0..36).map(move |column| Some(known(value(column, row))));
    let field = PlotField {
        samples: (0..37).flat_map(row).collect(),
        tilts_deg: (0..37).map(f64::from).collect(),
        ..field()
    };
    let bands = field.bands().unwrap();
    let layers = layers(&field, &bands);
    let colour = |columns: f64, rows: f64| colour_at(&layers, (10.0 * columns, rows));
    assert_eq!(colour(18.1, 18.1), bands.colour(bands.band(9.5)));
    assert_eq!(colour(18.1, 22.4), bands.colour(bands.band(4.4)));
    assert_eq!(colour(26.4, 18.1), bands.colour(bands.band(8.4)));
    assert_eq!(colour(3.1, 3.1), bands.colour(bands.band(9.5)));
}

#[test]
fn both_layouts_name_everything() {
    let directory = tempfile::tempdir().unwrap();
    for (layout, axis) in [(Layout::Flat, "azimuth (°)"), (Layout::Polar, "330°")] {
        let path = save(&field(), layout, &directory.path().join("map")).unwrap();
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
        let others =
            || ["png", "pdf"].map(|kind| std::fs::read(path.with_extension(kind)).unwrap());
        let first = others();
        save(&field(), layout, &directory.path().join("map")).unwrap();
        assert!(first == others(), "{layout:?}: alike to the byte");
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
        let refused = save(&field, Layout::Flat, &stem);
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
    let path = save(&field, Layout::Polar, &directory.path().join("map")).unwrap();
    let svg = std::fs::read_to_string(&path).unwrap();
    for text in ["little room", "no room", "no result"] {
        assert!(svg.contains(text), "{text}");
    }
}
