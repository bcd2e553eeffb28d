//! Charts as files.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{Chart, ChartLine, PlotError, save_both};

fn chart(points: Vec<(f64, f64)>) -> Chart {
    Chart {
        title: "Title".into(),
        x_title: "tilt / °".into(),
        y_title: "deviation / mm".into(),
        lines: vec![ChartLine {
            label: "payload 2 kg".into(),
            marks: points.last().copied().into_iter().collect(),
            points,
        }],
        marks_label: "published".into(),
    }
}

#[test]
fn the_svg_names_everything() {
    let directory = tempfile::tempdir().unwrap();
    let chart = chart(vec![(-30.0, 8.0), (0.0, 0.0), (30.0, 8.0)]);
    let path = save_both(&chart, &directory.path().join("chart")).unwrap();
    let svg = std::fs::read_to_string(path).unwrap();
    for text in [
        "Title",
        "tilt / °",
        "deviation / mm",
        "payload 2 kg",
        "published",
        "-30",
    ] {
        assert!(svg.contains(text), "{text}");
    }
}

/// A bare machine has no font.
#[test]
fn the_png_shows_its_text_and_a_flat_line_has_room() {
    let directory = tempfile::tempdir().unwrap();
    let png = |title: &str| {
        let flat = Chart {
            title: title.into(),
            ..chart(vec![(0.0, 0.0), (1.0, 0.0)])
        };
        let svg = save_both(&flat, &directory.path().join("chart")).unwrap();
        std::fs::read(svg.with_extension("png")).unwrap()
    };
    let (empty, titled) = (png(""), png("A title"));
    assert!(empty.starts_with(b"\x89PNG"));
    assert_ne!(empty, titled);
}

#[test]
fn nothing_to_draw_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let stem = directory.path().join("never");
    for points in [vec![], vec![(1.0, 1.0)]] {
        assert!(matches!(
            save_both(&chart(points), &stem),
            Err(PlotError::Empty)
        ));
    }
    assert!(!stem.with_extension("svg").exists());
}
